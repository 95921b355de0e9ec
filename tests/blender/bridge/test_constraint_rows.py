"""The rows of the lists of constraints and body changes: their bones, files and operators."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.constraints.rows import add_body_change
from hangtime.bridge.constraints.status import write_status
from hangtime.bridge.rows import bone_keys
from hangtime.bridge.rows.choices import BodyKind
from hangtime.solver.data import faults, requests
from hangtime.solver.data.reports.constraints import ConstraintReport
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.requests import When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.rows import (
    IN_FLIGHT,
    added,
    asked,
    make_rig,
    names,
    rename,
    reopen,
    select,
)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def rig() -> bpy.types.Object:
    return make_rig()


# ---------------------------------------------------------------- bones and their names


def test_a_renamed_bone_is_still_meant(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Leg")
    rename(rig, "thigh", "Oberschenkel")
    rename(rig, "shin", "thigh")  # which now is another bone
    rig.name = "Renamed"
    assert asked(rig).cones[0].bone == "Oberschenkel"
    assert rig.hangtime.constraints[0].bones[0].name == "Oberschenkel"


def test_of_a_bone_and_its_copy_the_one_of_the_same_name_is_meant(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Leg")
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in rig.data.edit_bones:
        bone.select = bone.select_head = bone.select_tail = bone.name == "thigh"
    bpy.ops.armature.duplicate()
    bpy.ops.object.mode_set(mode="OBJECT")
    copies = [bone for bone in rig.data.bones if bone.name.startswith("thigh")]
    assert len({bone_keys.key_of(bone) for bone in copies}) == 1
    assert len(copies) == 2
    assert asked(rig).cones[0].bone == "thigh"


def test_a_copied_armature_means_its_own_bones(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Leg")
    copy = rig.copy()
    copy.data = rig.data.copy()
    bpy.context.scene.collection.objects.link(copy)
    rename(copy, "thigh", "other")
    assert asked(copy).cones[0].bone == "other"
    assert asked(rig).cones[0].bone == "thigh"


def test_a_bone_that_never_had_a_key_is_found_by_name(rig: bpy.types.Object) -> None:
    row = added(rig, KINDS["CONE"], "thigh", name="Leg")
    rig.data.bones["thigh"].hangtime.key = ""
    assert row.bones[0].name == "thigh"
    row.bones[0].name = "nowhere"
    assert row.bones[0].name == "nowhere"


# ---------------------------------------------------------------- files


def fill(rig: bpy.types.Object) -> requests.Requests:
    """Some rows; what they ask for."""
    added(rig, KINDS["CONE"], "thigh", name="Leg", half_angle=0.5)
    added(rig, KINDS["TORQUE"], "shin", "foot", name="Weak", torque=20.0)
    add_body_change(rig.hangtime, BodyKind.LOAD, ["head"]).mass = 5.0
    return asked(rig)


def test_rows_survive_saving(rig: bpy.types.Object, tmp_path: Path) -> None:
    before = fill(rig)
    reopen(tmp_path / "rig.blend")
    loaded = bpy.data.objects["Rig"]
    assert asked(loaded) == before
    rename(loaded, "thigh", "Bein")
    reopen(tmp_path / "rig.blend")
    assert asked(bpy.data.objects["Rig"]).cones[0].bone == "Bein"


def library(path: Path, *, link: bool) -> bpy.types.Object:
    """The rig, saved and brought into an empty file."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    rigs.reset()
    with bpy.data.libraries.load(str(path), link=link) as (_, wanted):
        wanted.objects = ["Rig"]
    (found,) = wanted.objects
    bpy.context.scene.collection.objects.link(found)
    return found


def test_rows_survive_appending(rig: bpy.types.Object, tmp_path: Path) -> None:
    before = fill(rig)
    appended = library(tmp_path / "rig.blend", link=False)
    assert asked(appended) == before
    rename(appended, "thigh", "Bein")
    assert asked(appended).cones[0].bone == "Bein"


@pytest.fixture
def override(rig: bpy.types.Object, tmp_path: Path) -> bpy.types.Object:
    """A library override of a filled rig, active."""
    fill(rig)
    linked = library(tmp_path / "library.blend", link=True)
    made = linked.override_create(remap_local_usages=True)
    bpy.context.view_layer.objects.active = made
    return made


def test_an_override_keeps_its_values_and_its_own_rows(
    override: bpy.types.Object, tmp_path: Path
) -> None:
    settings = override.hangtime
    settings.mass = 62.0
    settings.constraints[0].half_angle = 0.75
    settings.constraints[1].used = False
    added(override, KINDS["TORQUE"], "head", "spine", name="Own")
    added(override, KINDS["POINT"], "foot", name="Pin")
    settings.body_changes[0].mass = 7.0
    before = asked(override)
    for _ in range(2):
        reopen(tmp_path / "shot.blend")
        override = next(o for o in bpy.data.objects if o.override_library)
        assert names(override) == ["Leg", "Weak", "Own", "Pin"]
        assert asked(override) == before
        assert override.hangtime.mass == 62.0


def test_an_override_keeps_where_contacts_were_moved_to(
    rig: bpy.types.Object, tmp_path: Path
) -> None:
    for name in ("ground 1", "ground 2"):
        stance = rig.hangtime.stances.add()
        stance.name, stance.forward_axis = name, (0.0, -1.0, 0.0)
    override = library(tmp_path / "library.blend", link=True).override_create(
        remap_local_usages=True
    )
    settings = override.hangtime
    settings.stances["ground 2"].forward = 0.25
    settings.contacts[0].place = (0.0, 0.5, 0.0)
    for _ in range(2):
        reopen(tmp_path / "shot.blend")
        settings = next(o for o in bpy.data.objects if o.override_library).hangtime
        places = [tuple(row.place) for row in settings.contacts]
        assert places == [pytest.approx((0.0, 0.5, 0.0)), pytest.approx((0.0, -0.25, 0.0))]
        shifts = [tuple(stance.shifted) for stance in settings.stances]
        assert shifts == [pytest.approx((-0.5, 0.0, 0.0)), pytest.approx((0.25, 0.0, 0.0))]


def test_an_override_refuses_to_remove_what_is_linked(override: bpy.types.Object) -> None:
    settings = override.hangtime
    settings.active_constraint = 0
    for operator in (bpy.ops.hangtime.remove_constraint, bpy.ops.hangtime.move_constraint):
        assert not operator.poll()
    assert bpy.ops.hangtime.copy_constraint() == {"FINISHED"}
    assert bpy.ops.hangtime.move_constraint(direction="UP") == {"CANCELLED"}
    assert names(override) == ["Leg", "Weak", "Leg 2"]
    assert bpy.ops.hangtime.remove_constraint() == {"FINISHED"}
    assert names(override) == ["Leg", "Weak"]


@pytest.mark.usefixtures("rig")
def test_a_linked_armature_is_not_changed(tmp_path: Path) -> None:
    linked = library(tmp_path / "rig.blend", link=True)
    bpy.context.view_layer.objects.active = linked
    with pytest.raises(RuntimeError, match="library override"):
        bpy.ops.hangtime.add_constraint(kind="CONE")


# ---------------------------------------------------------------- operators


def test_adding_without_selected_bones_leaves_the_bone_to_be_chosen(rig: bpy.types.Object) -> None:
    for kind in KINDS.values():
        assert bpy.ops.hangtime.add_constraint(kind=kind.name) == {"FINISHED"}
    rows = rig.hangtime.constraints
    assert [row.kind for row in rows] == [kind.name for kind in KINDS.values()]
    assert rig.hangtime.active_constraint == len(rows) - 1
    assert [bone.name for bone in rows[0].bones] == [""]
    assert len({row.name for row in rows}) == len(rows)
    with pytest.raises(faults.NoBoneChosen):
        asked(rig)


def test_adding_with_selected_bones_makes_a_row_each(rig: bpy.types.Object) -> None:
    select(rig, "foot", "head")
    assert bpy.ops.hangtime.add_constraint(kind="POINT") == {"FINISHED"}
    assert bpy.ops.hangtime.add_constraint(kind="POINT") == {"FINISHED"}
    assert names(rig) == ["foot Point", "head Point", "foot Point 2", "head Point 2"]
    assert bpy.ops.hangtime.add_constraint(kind="TORQUE") == {"FINISHED"}
    row = rig.hangtime.constraints[-1]
    assert [bone.name for bone in row.bones] == ["foot", "head"]
    assert (row.span, row.phase) == ("PHASE", "flight 1")
    assert len(asked(rig).points) == 4


def test_a_row_without_bones_is_called_by_its_phase_whatever_is_selected(
    rig: bpy.types.Object,
) -> None:
    select(rig, "foot")
    for kind in ("TIMING", "HOLD"):
        bpy.ops.hangtime.add_constraint(kind=kind)
    assert names(rig) == ["Flight 1 Timing", "Hold"]


def test_without_phases_a_new_row_holds_around_the_playhead(rig: bpy.types.Object) -> None:
    rig.hangtime.contacts.clear()
    select(rig, "shin")
    bpy.ops.hangtime.add_constraint(kind="ANGLE")
    assert asked(rig).angles[0].when == When(frames=(IN_FLIGHT - 5.0, IN_FLIGHT + 5.0))


def test_a_sided_bone_gives_a_readable_name() -> None:
    rigs.reset()
    specs = (rigs.BoneSpec("mixamorig:LeftHand", None, (0.0, 0.0, 1.0), (0.0, 0.0, 1.2)),)
    armature = rigs.make_armature(specs)
    select(armature, "mixamorig:LeftHand")
    bpy.ops.hangtime.add_constraint(kind="POINT")
    assert names(armature) == ["Left Hand Point"]


def test_rows_are_removed_copied_and_moved(rig: bpy.types.Object) -> None:
    settings = rig.hangtime
    for name in "abc":
        added(rig, KINDS["TORQUE"], "shin", "foot", name=name, torque=30.0)
    settings.active_constraint = 0
    assert bpy.ops.hangtime.copy_constraint() == {"FINISHED"}
    assert names(rig) == ["a", "b", "c", "a 2"]
    copied, original = asked(rig).torques[3], asked(rig).torques[0]
    assert (copied.bones, copied.bound) == (original.bones, original.bound)
    assert settings.active_constraint == 3
    assert bpy.ops.hangtime.move_constraint(direction="UP") == {"FINISHED"}
    assert names(rig) == ["a", "b", "a 2", "c"]
    assert settings.active_constraint == 2
    settings.active_constraint = 0
    assert bpy.ops.hangtime.move_constraint(direction="UP") == {"CANCELLED"}
    assert bpy.ops.hangtime.remove_constraint() == {"FINISHED"}
    settings.active_constraint = 2
    assert bpy.ops.hangtime.remove_constraint() == {"FINISHED"}
    assert names(rig) == ["b", "a 2"]
    assert settings.active_constraint == 1
    settings.constraints.clear()
    assert not bpy.ops.hangtime.remove_constraint.poll()


def test_selected_bones_are_assigned_and_taken_off(rig: bpy.types.Object) -> None:
    row = added(rig, KINDS["TORQUE"], "head")
    assert not bpy.ops.hangtime.assign_bones.poll()  # not in pose mode
    select(rig, "foot", "shin")
    assert bpy.ops.hangtime.assign_bones(of="CONSTRAINTS") == {"FINISHED"}
    assert [bone.name for bone in row.bones] == ["foot", "shin"]
    assert bpy.ops.hangtime.remove_bone(of="CONSTRAINTS", index=0) == {"FINISHED"}
    assert [bone.name for bone in row.bones] == ["shin"]
    with pytest.raises(RuntimeError, match="has 1 fields of bones, counted from 0, and none with"):
        bpy.ops.hangtime.remove_bone(of="CONSTRAINTS", index=1)
    cone = added(rig, KINDS["CONE"])
    assert bpy.ops.hangtime.assign_bones(of="CONSTRAINTS") == {"FINISHED"}
    assert [bone.name for bone in cone.bones] == ["foot"]


def test_ranges_are_set_from_the_timeline(rig: bpy.types.Object) -> None:
    scene = bpy.context.scene
    added(rig, KINDS["CONE"], "thigh")
    scene.frame_set(20)
    bpy.ops.hangtime.set_constraint_range(to="FRAME")
    assert asked(rig).cones[0].when == When(frames=(20.0, 20.0))
    bpy.ops.hangtime.set_constraint_range(to="PHASE")
    assert asked(rig).cones[0].when == When("ground 2")
    with pytest.raises(RuntimeError, match="Set a preview range in the timeline first"):
        bpy.ops.hangtime.set_constraint_range(to="PREVIEW")
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = 3, 12
    bpy.ops.hangtime.set_constraint_range(to="PREVIEW")
    assert asked(rig).cones[0].when == When(frames=(3.0, 12.0))


def test_a_point_is_put_where_it_is_shown(rig: bpy.types.Object) -> None:
    row = added(rig, KINDS["POINT"], "foot")
    row.offset = (0.0, 0.0, 0.0)
    bpy.context.scene.frame_set(12)
    bpy.ops.hangtime.place_constraint()
    head = rigs.world_of(rig, "foot", 12).translation
    assert tuple(row.place) == pytest.approx(tuple(head), abs=1e-5)


def test_body_changes_are_added_and_removed(rig: bpy.types.Object) -> None:
    select(rig, "head", "finger")
    bpy.ops.hangtime.add_body_change(kind="LOAD")
    bpy.ops.hangtime.add_body_change(kind="LIMB")
    assert [row.name for row in rig.hangtime.body_changes] == [
        "head Weight",
        "finger Weight",
        "Limb",
    ]
    assert bpy.ops.hangtime.remove_body_change() == {"FINISHED"}
    assert rig.hangtime.active_body_change == 1
    assert len(asked(rig).body.added) == 2


# ---------------------------------------------------------------- what a solve said


def test_every_row_is_told_how_it_came_out(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Leg")
    added(rig, KINDS["POINT"], "foot", name="Pin")
    added(rig, KINDS["TORQUE"], "foot", name="Weak")
    added(rig, KINDS["POINT"], "head", name="Bar", environment=True)
    added(rig, KINDS["TIMING"], name="Slow")
    added(rig, KINDS["CONE"], "shin", name="Off", used=False)
    add_body_change(rig.hangtime, BodyKind.LOAD, ["head"])
    report = SimpleNamespace(
        conditions=[
            ConstraintReport("Leg", RowKind.CONE, 0.0001, 213.4, met=True),
            ConstraintReport("Pin", RowKind.POINT, 12.3, 213.4, met=False),
            ConstraintReport("Weak", RowKind.TORQUE, 3.25, 213.4, met=False),
        ],
        contacts=[
            SimpleNamespace(name="Bar", worst_violation_mm=0.02, worst_violation_frame=3.0),
        ],
        times=TimeMap((1.0, 10.0), (1.0, 10.0)),
    )
    write_status(rig.hangtime, report)
    told = {row.name: (row.met, row.status) for row in rig.hangtime.constraints}
    assert told == {
        "Leg": ("MET", "Met"),
        "Pin": ("MISSED", "Missed by 12 mm at frame 213"),
        "Weak": ("MISSED", "Missed by 3.2 N·m at frame 213"),
        "Bar": ("MET", "Met"),
        "Slow": ("MET", "Applied"),
        "Off": ("UNKNOWN", ""),
    }
    assert rig.hangtime.body_changes[0].status == "Applied"
    pin = rig.hangtime.constraints["Pin"]
    pin.place.x += 0.5  # what was said of it holds no longer
    assert (pin.met, pin.status) == ("UNKNOWN", "")


def test_a_row_tells_at_which_frames_of_the_result_it_is_met(rig: bpy.types.Object) -> None:
    added(rig, KINDS["POINT"], "foot", name="Early", span="FRAME", first_frame=4.0)
    added(rig, KINDS["POINT"], "foot", name="Late", span="FRAME", first_frame=15.0)
    added(rig, KINDS["POINT"], "foot", name="Long", span="FRAMES", first_frame=4.0, last_frame=20.0)
    names = ("Early", "Late", "Long")
    report = SimpleNamespace(
        conditions=[ConstraintReport(n, RowKind.POINT, 0.0, 1.0, met=True) for n in names],
        contacts=[],
        times=TimeMap((1.0, 10.0, 20.0), (1.0, 10.0, 23.0)),
    )
    write_status(rig.hangtime, report)
    assert [row.status for row in rig.hangtime.constraints] == [
        "Met",
        "Met at frame 16.5 (the recording's 15)",
        "Met at frames 4 to 23 (the recording's 4 to 20)",
    ]
