"""The list of surfaces, contacts that stand on them, and results beside them."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.constraints.surface_status import KEPT_OUT, write_surface_status
from hangtime.bridge.repairs.analysis_key import analysis_key
from hangtime.bridge.repairs.placed_armature import repair
from hangtime.bridge.results.made import AskedSettings
from hangtime.operators.drag.drag_state import Landing
from hangtime.operators.drag.rays import Ray
from hangtime.operators.drag.snapping import Snapping
from hangtime.operators.solve.adapt import ask_for
from hangtime.operators.solve.scene import note_surfaces, stale_surfaces
from hangtime.operators.solve.session import Asked, session
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.constraints import ConstraintReport
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.scene import SceneRole, SupportBox
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.scene.checks import check_scene
from hangtime.solver.scene.triangle_mesh import placed_mesh
from hangtime.solver.unseen.offered import OfferedSupport
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.rows import make_stances
from hangtime.tests.blender.helpers.skins import make_skin
from hangtime.tests.blender.helpers.solids import add_row, make_box, read
from mathutils.bvhtree import BVHTree

FIRST, LAST = 1.0, 24.0

ARM = ("RightArm", "RightForeArm", "RightHand", "LeftArm", "LeftForeArm", "LeftHand")
BESIDE = 0.8  # m, of two who jump side by side
HARD = 0.03  # m, of an arm's radius at least

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def rig() -> bpy.types.Object:
    """Animated, with a heel's contact on the ground before and after a flight."""
    return make_stances((1.0, 0.0, 0.0))


def select(*solids: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for each in solids:
        each.select_set(True)


def apart(performer: bpy.types.Object, skin: bpy.types.Object) -> float:
    """m, from the middles of the performer's arms to a partner's skin, at its least."""
    least = np.inf
    for frame in range(150, 240, 2):
        bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        tree = BVHTree.FromObject(skin, graph)
        posed = performer.evaluated_get(graph)
        for name in ARM:
            bone = posed.pose.bones[name]
            for share in np.linspace(0.0, 1.0, 5):
                place = posed.matrix_world @ bone.head.lerp(bone.tail, share)
                least = min(least, tree.find_nearest(skin.matrix_world.inverted() @ place)[3])
    return least


def pins(armature: bpy.types.Object) -> dict[str, str | None]:
    """On what each pin stands."""
    problem = problem_of(armature.hangtime, read_recorded(armature, FIRST, LAST))
    return {pin.name: pin.on for pin in problem.pins}


# ---------------------------------------------------------------- the list


def test_what_is_selected_becomes_a_row_each_and_never_two(rig: bpy.types.Object) -> None:
    crate, wall = make_box("Crate"), make_box("Wall")
    select(crate, wall, rig)
    assert bpy.ops.hangtime.add_surfaces(role="OBSTACLE") == {"FINISHED"}
    select(crate)
    assert bpy.ops.hangtime.add_surfaces(role="GROUND") == {"FINISHED"}
    rows = {row.called: row.role for row in rig.hangtime.surfaces}
    assert rows == {"Crate": "GROUND", "Wall": "OBSTACLE"}
    assert rig.hangtime.surfaces[rig.hangtime.active_surface].object == crate


def test_nothing_solid_that_is_selected_is_said(rig: bpy.types.Object) -> None:
    select(rig)
    with pytest.raises(RuntimeError, match="Select objects with faces first"):
        bpy.ops.hangtime.add_surfaces(role="GROUND")
    assert not rig.hangtime.surfaces


def test_the_active_collection_is_one_row(rig: bpy.types.Object) -> None:
    add = bpy.ops.hangtime.add_surfaces
    with pytest.raises(RuntimeError, match="not the scene's own"):
        add(role="GROUND", collection=True)
    stage = bpy.data.collections.new("Stage")
    bpy.context.scene.collection.children.link(stage)
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Stage"]
    make_box("Crate")
    assert add(role="GROUND", collection=True) == {"FINISHED"}
    (row,) = rig.hangtime.surfaces
    assert (row.collection, row.called) == (stage, "Stage")
    assert [each.name for each in read(rig).objects] == ["Crate"]


def test_a_row_s_object_is_selected(rig: bpy.types.Object) -> None:
    crate = make_box("Crate")
    add_row(rig, crate)
    select(rig)
    assert bpy.ops.hangtime.select_surface() == {"FINISHED"}
    assert bpy.context.selected_objects == [crate]
    assert bpy.context.scene.hangtime.armature == rig


def test_adding_and_removing_can_be_undone(rig: bpy.types.Object) -> None:
    name = rig.name
    select(make_box("Crate"))
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.hangtime.add_surfaces("EXEC_DEFAULT", True, role="GROUND")
    bpy.ops.hangtime.remove_surface("EXEC_DEFAULT", True)
    assert len(bpy.data.objects[name].hangtime.surfaces) == 0
    bpy.ops.ed.undo()
    assert [row.called for row in bpy.data.objects[name].hangtime.surfaces] == ["Crate"]
    bpy.ops.ed.undo()
    assert len(bpy.data.objects[name].hangtime.surfaces) == 0


# ---------------------------------------------------------------- contacts on them


def test_a_dragged_contact_stands_where_it_was_put(rig: bpy.types.Object) -> None:
    crate = make_box("Crate")
    add_row(rig, crate)
    assert pins(rig) == {}
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.5, 0.0, 0.5), ground="Crate")
    assert rig.hangtime.contacts[1].on == crate
    assert pins(rig) == {"Heel 2": "Crate"}
    crate.name = "Box"
    assert pins(rig) == {"Heel 2": "Box"}


def test_whoever_states_a_height_stands_on_nothing(rig: bpy.types.Object) -> None:
    add_row(rig, make_box("Crate"))
    settings = rig.hangtime
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.5, 0.0, 0.5), ground="Crate")
    settings.stances["ground 2"].forward += 0.1
    assert pins(rig) == {"Heel 2": "Crate"}
    settings.stances["ground 2"].up += 0.1
    assert pins(rig) == {"Heel 2": None}
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.0, 0.0, 0.1), ground="Crate")
    settings.contacts[1].place[2] += 0.2
    assert pins(rig) == {"Heel 2": None}


def test_a_contact_leaves_a_surface_that_is_removed(rig: bpy.types.Object) -> None:
    row = add_row(rig, make_box("Crate"))
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.5, 0.0, 0.5), ground="Crate")
    row.role = "OBSTACLE"
    assert pins(rig) == {"Heel 2": None}
    row.role = "GROUND"
    assert bpy.ops.hangtime.remove_surface() == {"FINISHED"}
    assert rig.hangtime.contacts[1].on is None
    assert pins(rig) == {"Heel 2": None}
    assert rig.hangtime.contacts[1].at[2] == pytest.approx(0.5)


def test_a_contact_put_back_stands_on_the_floor(rig: bpy.types.Object) -> None:
    add_row(rig, make_box("Crate"))
    rig.hangtime.active_contact = 1
    bpy.ops.hangtime.drag_pin(shift=(0.5, 0.0, 0.5), ground="Crate")
    assert bpy.ops.hangtime.put_back() == {"FINISHED"}
    assert pins(rig) == {}


# ---------------------------------------------------------------- snapping


def test_a_contact_lands_on_the_crate_in_metres(rig: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.01
    add_row(rig, make_box("Crate", at=(200.0, 0.0, 30.0), size=60.0))
    snapping = Snapping.of(rig, rig.hangtime.contacts[1], bpy.context.scene)
    assert snapping.lands(2.1, 0.1) == Landing(pytest.approx(0.6), "Crate")
    assert snapping.lands(3.0, 0.1) is None
    assert snapping.seen(Ray.of((100.0, 0.0, 160.0), (1.0, 0.0, -1.0))) == pytest.approx((200.0, 0))
    assert snapping.seen(Ray.of((100.0, 0.0, 30.0), (1.0, 0.0, 0.0))) is None
    assert snapping.floor is None


def test_a_contact_that_stands_on_something_knows_its_floor(rig: bpy.types.Object) -> None:
    add_row(rig, make_box("Crate"))
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.5, 0.0, 0.5), ground="Crate")
    assert Snapping.of(rig, rig.hangtime.contacts[1], bpy.context.scene).floor == 0.0


@pytest.mark.parametrize("why", ["no ground", "switched off", "unused", "deleted"])
def test_nothing_snaps(rig: bpy.types.Object, why: str) -> None:
    crate = make_box("Crate")
    row = add_row(rig, crate, "OBSTACLE" if why == "no ground" else "GROUND")
    bpy.context.scene.hangtime.snap = why != "switched off"
    row.used = why != "unused"
    if why == "deleted":
        bpy.context.scene.collection.objects.unlink(crate)
    assert Snapping.of(rig, rig.hangtime.contacts[1], bpy.context.scene) is None


# ---------------------------------------------------------------- solving


@pytest.fixture
def asked(rig: bpy.types.Object) -> Asked:
    """As after the worker was asked, a crate beside the rig."""
    add_row(rig, make_box("Crate"))
    recording = read_recorded(rig, FIRST, LAST)
    settings, scene = AskedSettings.of(rig.hangtime), read(rig, recording.frames)
    return Asked(rig.name, rig.session_uid, recording, MotionProblem(), settings, scene=scene)


def test_the_surfaces_are_part_of_the_problem(rig: bpy.types.Object) -> None:
    add_row(rig, make_box("Crate"))
    settings = rig.hangtime
    settings.use_range, settings.first_frame, settings.last_frame = True, int(FIRST), int(LAST)
    settings.analysed = analysis_key(settings, read_recorded(rig, FIRST, LAST))
    asked = complete(ask_for(bpy.context))
    assert [each.name for each in asked.problem.scene] == ["Crate"]
    assert asked.scene.objects == asked.problem.scene


def test_a_surface_that_is_edited_meanwhile_is_told_and_nothing_is_lost(
    rig: bpy.types.Object, asked: Asked
) -> None:
    assert complete(stale_surfaces(asked, rig)) == ()
    bpy.data.objects["Crate"].location.z += 0.1
    stale = complete(stale_surfaces(asked, rig))
    assert stale == ("Crate",)
    (line,) = note_surfaces(rig, asked, SimpleNamespace(overlaps=()), stale)
    assert line == "Crate changed while this was solved; press Adapt again"
    assert rig.hangtime.surfaces[0].status == line
    bpy.data.objects.remove(bpy.data.objects["Crate"])
    stale = complete(stale_surfaces(asked, rig))
    assert stale == ("Crate",)
    (line,) = note_surfaces(rig, asked, SimpleNamespace(overlaps=()), stale)
    assert line.startswith("Crate was deleted while this was solved; remove its row")


@pytest.mark.parametrize("deep", [True, False])
def test_a_row_says_what_stays_in_it(rig: bpy.types.Object, deep: bool) -> None:
    row = add_row(rig, make_box("Crate"))
    overlaps = [
        ConstraintReport(name, RowKind.SOLID, amount, 12.0, met=False)
        for name, amount in (("Left foot in Crate", 12.0), ("Left hand in the floor", 99.0))
    ][not deep :]
    write_surface_status(rig.hangtime, SimpleNamespace(overlaps=overlaps), {})
    if deep:
        assert (row.met, row.status) == ("MISSED", "In the way: Left foot 12 mm at frame 12")
    else:
        assert (row.met, row.status) == ("MET", "Nothing new is in it")
    part = replace(read(rig).objects[0], name="Crate, Lid", part_of="Crate")
    overlap = ConstraintReport("Left foot in Crate, Lid", RowKind.SOLID, 30.0, 12.0, met=False)
    report = SimpleNamespace(overlaps=[overlap])
    write_surface_status(rig.hangtime, report, {}, scene=[part])
    assert (row.met, row.status) == ("MISSED", "In the way: Left foot 30 mm at frame 12")
    row.role = "OBSTACLE"  # another question
    assert (row.met, row.status) == ("UNKNOWN", "")


@pytest.mark.parametrize(
    ("deep", "outcome"), [(True, "In the way: Left foot 12 mm at frame 12"), (False, KEPT_OUT)]
)
def test_a_row_says_what_stays_in_what_changes_its_shape(
    rig: bpy.types.Object, asked: Asked, deep: bool, outcome: str
) -> None:
    overlap = ConstraintReport("Left foot in Crate", RowKind.SOLID, 12.0, 12.0, met=False)
    reshaped = replace(asked, scene=replace(asked.scene, reshaped=("Crate",)))
    report = SimpleNamespace(overlaps=[overlap] * deep)
    (line,) = note_surfaces(rig, reshaped, report, ())
    assert line == "Crate changes its shape; what counts is that of frame 1"
    (row,) = rig.hangtime.surfaces
    assert (row.met, row.status) == ("MISSED" if deep else "MET", f"{outcome}. {line}")


@pytest.mark.slow
def test_a_jump_lands_on_a_crate(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    landing = [row for row in settings.contacts if row.phase == "ground 2"]
    x, y, _ = np.mean([row.at for row in landing], axis=0)
    crate = make_box("Crate", at=(x, y, 0.1))
    crate.scale = (0.8, 0.8, 0.2)
    add_row(analysed, crate)
    bpy.context.scene.hangtime.armature = analysed
    contact, up = settings.contacts.find(landing[0].name), (0.0, 0.0, 0.2 - landing[0].at[2])
    bpy.ops.hangtime.drag_pin(contact=contact, shift=up, ground="Crate", whole=True)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    (row,) = settings.surfaces
    assert row.met != "UNKNOWN"
    traces = kept(settings.adapted).traces
    np.testing.assert_allclose(traces.points[-1, :, 2], 0.2, atol=1e-3)
    assert settings.status.startswith("Solved in")


@pytest.mark.slow
def test_arms_keep_out_of_a_partner_who_jumps_beside(analysed: bpy.types.Object) -> None:
    """Both perform the same jump; arms that swing out are in each other."""
    partner = analysed.copy()
    partner.data = analysed.data.copy()
    bpy.context.scene.collection.objects.link(partner)
    (start, end) = (
        np.mean([row.at for row in analysed.hangtime.contacts if row.phase == phase], axis=0)
        for phase in ("ground 1", "ground 2")
    )
    along = (end - start)[:2] / np.linalg.norm((end - start)[:2])
    skin = make_skin(partner, {**dict.fromkeys(ARM, 0.04), "Spine1": 0.14}, longer=0.1)
    skin.parent = partner
    partner.location = (-along[1] * BESIDE, along[0] * BESIDE, 0.0)
    bpy.context.view_layer.objects.active = analysed
    row = add_row(analysed, skin, "OBSTACLE")
    before = apart(analysed, skin)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert (row.met, row.status) == ("MET", KEPT_OUT)
    assert before < 0.02 < HARD < apart(analysed, skin)


# ---------------------------------------------------------------- what nothing in sight carries


@pytest.mark.slow
def test_a_jump_recorded_on_a_train_rides_on_it(jump: bpy.types.Object) -> None:
    """Nothing else explains feet that slide as they stand."""
    train = bpy.data.objects.new("Train", None)
    bpy.context.scene.collection.objects.link(train)
    jump.parent = train
    for frame, x in ((0, 0.0), (400, 4.0)):  # 1.2 m/s
        train.location.x = x
        train.keyframe_insert("location", frame=frame)
    for curve in curves_of(train):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    carried = {row.phase for row in jump.hangtime.contacts}
    assert carried != {"ground 1", "ground 2"}
    floor = make_box("Wagon", size=20.0, at=(0.0, 0.0, -10.0))
    floor.parent = train
    add_row(jump, floor)
    bpy.context.view_layer.objects.active = jump
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings = jump.hangtime
    assert {row.phase for row in settings.contacts} == {"ground 1", "ground 2"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert settings.status.startswith("Solved in")
    recorded, made = (kept(owner).traces for owner in (jump, settings.adapted))
    assert np.abs(made.heads[-1] - recorded.heads[-1]).max() < 0.05
    assert made.velocity[-1, 0] == pytest.approx(1.2, abs=0.2)


def test_a_box_is_added_under_the_feet_in_the_scenes_units(rig: bpy.types.Object) -> None:
    box = SupportBox((0.4, 0.3, 0.25), (1.0, 2.0, 0.0), np.pi / 2)
    session().support = (rig.session_uid, OfferedSupport((box,)))
    bpy.context.scene.unit_settings.scale_length = 0.01
    assert bpy.ops.hangtime.add_support_box() == {"FINISHED"}
    (row,) = rig.hangtime.surfaces
    assert (row.object.name, row.role) == ("Box", "GROUND")
    bpy.context.view_layer.update()
    (read_back,) = read(rig).objects
    mesh = placed_mesh(read_back)
    np.testing.assert_allclose(mesh.low, [0.85, 1.8, 0.0], atol=1e-6)  # m; turned by a quarter
    np.testing.assert_allclose(mesh.high, [1.15, 2.2, 0.25], atol=1e-6)
    assert mesh.closed
    assert mesh.volume > 0.0
    assert not bpy.ops.hangtime.add_support_box.poll()  # what was unseen is there now


def test_a_box_that_was_added_goes_with_the_recording_onto_the_floor(
    rig: bpy.types.Object,
) -> None:
    """And back; what the artist brought into the scene stays."""
    offered = SupportBox((0.4, 0.3, 0.25), (1.0, 2.0, 0.5), 0.0)
    session().support = (rig.session_uid, OfferedSupport((offered,)))
    assert bpy.ops.hangtime.add_support_box() == {"FINISHED"}
    box, own = rig.hangtime.surfaces[0].object, make_box("Stage")
    add_row(rig, own)
    stage = tuple(own.matrix_world.translation)
    for repairs, place in (
        (Repairs(floor=0.5), (1.0, 2.0, 0.0)),
        (Repairs(floor=0.25, scale=0.5), (0.5, 1.0, 0.0)),
        (Repairs(), (1.0, 2.0, 0.5)),
    ):
        repair(rig, repairs)
        assert tuple(box.matrix_world.translation) == pytest.approx(place, abs=1e-6)
        assert tuple(own.matrix_world.translation) == stage


def test_a_box_is_offered_for_its_own_armature_alone(rig: bpy.types.Object) -> None:
    box = SupportBox((1, 1, 1), (0, 0, 0), 0.0)
    session().support = (rig.session_uid + 1, OfferedSupport((box,)))
    assert not bpy.ops.hangtime.add_support_box.poll()
    session().support = None


def test_a_hurdle_is_an_obstacle_that_is_cleared(rig: bpy.types.Object) -> None:
    row = add_row(rig, make_box("Hurdle"))
    row.role, row.clearance = "CLEAR", 5.0
    bpy.context.scene.unit_settings.scale_length = 0.01
    recording = read_recorded(rig, FIRST, LAST)
    (thing,) = read(rig).objects
    problem = problem_of(rig.hangtime, recording, (thing,))
    (clear,) = problem.requests.clears
    assert (thing.role, clear.thing, clear.bones) == (SceneRole.OBSTACLE, "Hurdle", ())
    assert clear.by == pytest.approx(0.05)
    check_scene(problem)
    row.role = "OBSTACLE"
    assert problem_of(rig.hangtime, recording, (thing,)).requests.clears == ()


def test_what_is_not_cleared_is_said_on_its_row(rig: bpy.types.Object) -> None:
    row = add_row(rig, make_box("Hurdle"))
    row.role = "CLEAR"
    name = "Left foot in the clearance of Hurdle"
    low = ConstraintReport(name, RowKind.SOLID, 12.0, 150.0, met=False)
    write_surface_status(rig.hangtime, SimpleNamespace(overlaps=(low,)), {})
    assert (row.met, row.status) == ("MISSED", "Not cleared: Left foot 12 mm at frame 150")
