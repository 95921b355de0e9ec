"""The doctor in Blender: what is wrong appears in rows, and remedies mend what is read."""

from __future__ import annotations

import re

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.fcurves import curves_of
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.bridge.repairs.analysis_key import repaired_since
from hangtime.bridge.repairs.placed_armature import repair
from hangtime.bridge.repairs.stored import (
    applied,
    finding_of,
    findings,
    foot_faults,
    is_applied,
    look_at_examination,
)
from hangtime.bridge.rows.phases import unseen_frames
from hangtime.operators.solve.session import session
from hangtime.operators.timeline.timeline_bars import rows_of
from hangtime.solver.data.problem import Mend
from hangtime.solver.data.scene import SupportBox
from hangtime.solver.doctor.examination.repair import as_asked, unplaced
from hangtime.solver.doctor.repairs import Repairs, UpAxis
from hangtime.solver.doctor.stance.feet import FootFaultKind
from hangtime.solver.unseen.offered import OfferedSupport
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.solids import add_row
from hangtime.tests.blender.operators.recording.damages import kinds
from hangtime.tests.helpers.clips import JUMP_FRAMES, mocap_path

SPIKED, TURN, RAISED, SLOWED = 150, 0.8, 0.2, 1.25
pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def damaged(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump with a spike in an arm, 0.2 m above the floor, played 1.25 times too fast."""
    for curve in curves_of(jump):
        if 'LeftArm"' in curve.data_path and "rotation" in curve.data_path:
            key = curve.keyframe_points[SPIKED - 1]
            assert key.co[0] == SPIKED
            key.co[1] += TURN * (curve.array_index == 2)
    jump.location.z = RAISED
    bpy.context.scene.render.fps = 150
    return jump


@pytest.fixture
def examined(damaged: bpy.types.Object) -> bpy.types.Object:
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    return damaged


def test_what_is_wrong_is_listed_with_its_frames_and_remedies(examined) -> None:
    rows = {row.name: finding_of(row) for row in findings(examined.hangtime)}
    assert set(rows) == {"spike", "time scale", "floor"}
    assert rows["spike"].frames == ((SPIKED, SPIKED),)
    assert rows["spike"].part == "LeftArm"
    assert rows["time scale"].remedy.time_scale == pytest.approx(SLOWED)
    assert rows["time scale"].alternative.scale == pytest.approx(SLOWED**-2, rel=0.05)
    feet = foot_faults(examined.hangtime)
    assert {fault.kind for fault in feet} == {FootFaultKind.FLOATS}
    assert feet[0].amount == pytest.approx(RAISED, abs=0.03)


@pytest.mark.slow
def test_all_remedies_count_at_once_and_no_key_changes(examined) -> None:
    action, scene = examined.animation_data.action, bpy.context.scene
    before = keys_digest(action)
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert keys_digest(action) == before
    assert (scene.render.fps, scene.render.fps_base) == (120, 1.0)
    assert examined.matrix_world.translation.z == pytest.approx(0.0, abs=0.03)
    recording = read_recorded(examined, *JUMP_FRAMES)
    problem = problem_of(examined.hangtime, recording)
    assert problem.mend == (Mend.SPIKES,)
    arm, at = recording.index("LeftArm"), SPIKED - JUMP_FRAMES[0]
    turned = as_asked(recording, problem).rotations[at, arm].T @ recording.rotations[at, arm]
    assert np.degrees(np.arccos(0.5 * (np.trace(turned) - 1.0))) > 30.0
    assert not foot_faults(examined.hangtime)  # they were seen elsewhere
    assert not bpy.ops.hangtime.repair_all.poll()


@pytest.mark.slow
def test_noise_is_told_by_analyze_until_it_is_smoothed(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    trembles = "joints tremble by .* Examine, and smooth them first"
    bpy.ops.hangtime.analyze()
    assert not re.search(trembles, capfd.readouterr().out)
    shaken = np.random.default_rng(0)
    for curve in curves_of(jump):
        if "rotation" in curve.data_path:
            for key in curve.keyframe_points:
                key.co[1] += shaken.normal(0.0, np.radians(1.0))
    bpy.ops.hangtime.analyze()
    assert re.search(trembles, capfd.readouterr().out)
    bpy.ops.hangtime.examine()
    bpy.ops.hangtime.repair_all()
    bpy.ops.hangtime.analyze()
    assert not re.search(trembles, capfd.readouterr().out)


@pytest.mark.slow
def test_a_box_that_was_offered_before_a_repair_is_no_longer(examined) -> None:
    """It would stand where the recording was."""
    box = SupportBox((1, 1, 1), (0, 0, 0), 0.0)
    session().support = (examined.session_uid, OfferedSupport((box,)))
    assert bpy.ops.hangtime.add_support_box.poll()
    bpy.ops.hangtime.repair_all()
    assert not bpy.ops.hangtime.add_support_box.poll()


@pytest.mark.slow
def test_a_remedy_is_left_out_again(examined) -> None:
    scene = bpy.context.scene
    bpy.ops.hangtime.repair_all()
    for row in findings(examined.hangtime):
        assert is_applied(examined.hangtime, row)
        bpy.ops.hangtime.repair(kind=row.name)
        assert not is_applied(examined.hangtime, row)
    assert examined.parent is None
    assert (scene.render.fps, scene.render.fps_base) == (150, 1.0)
    assert applied(examined.hangtime) == Repairs()


@pytest.mark.slow
def test_ground_of_the_panel_world_is_the_floor(jump) -> None:
    jump.location.z = -RAISED
    bpy.ops.hangtime.examine()
    assert kinds(jump) == ["floor"]
    bpy.ops.mesh.primitive_plane_add(size=20.0, location=(0.0, 0.0, -RAISED))
    add_row(jump, bpy.context.object)
    bpy.context.view_layer.objects.active = jump
    bpy.ops.hangtime.examine()
    assert kinds(jump) == []
    assert not foot_faults(jump.hangtime)


@pytest.mark.slow
def test_frames_that_are_left_out_tell_nothing_of_those_that_stay() -> None:
    """In a dancer's first 13 frames capture had lost the floor: Analyze found no contact at all."""
    rigs.reset()
    dance = import_clip(mocap_path("rokoko_jesse_dance.bvh")).armature
    bpy.context.view_layer.objects.active = dance
    bpy.ops.hangtime.examine()
    bpy.ops.hangtime.repair_all()
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert len(dance.hangtime.contacts) > 5
    noted = {row.name: finding_of(row).frames for row in findings(dance.hangtime)}
    carried = np.array(unseen_frames(dance.hangtime))
    skid = np.abs(carried[:, 0] - 95.0) < 0.5  # which only Analyze looks for
    assert skid.sum() == 1
    told = sorted((*noted["unseen support"], *noted["skidding"]))
    np.testing.assert_allclose(carried[~skid], told, rtol=0.0, atol=0.5)


@pytest.mark.parametrize(
    "stored", ['{"missing": [3]}', "骨", "3", '{"mend": ["more"]}', '{"shear": 2.0}']
)
def test_repairs_that_cannot_be_read_stop_the_analysis(damaged, stored) -> None:
    damaged.hangtime.repairs = stored
    with pytest.raises(RuntimeError, match="repairs cannot be read"):
        bpy.ops.hangtime.analyze()


@pytest.mark.slow
def test_repairs_that_cannot_be_read_are_told_until_it_is_examined_anew(examined, capfd) -> None:
    examined.hangtime.repairs = "3"
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert "could not be read and are left out" in capfd.readouterr().out
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def test_armatures_under_one_parent_are_repaired_each_for_itself(jump) -> None:
    """The parent moves: the figure's size counts from the world's origin all the same."""
    scene, parent = bpy.context.scene, bpy.data.objects.new("Set", None)
    other = bpy.data.objects.new("Other", bpy.data.armatures.new("Other"))
    for thing in (parent, other):
        scene.collection.objects.link(thing)
    jump.parent = other.parent = parent
    for frame, x in ((1, 0.0), (50, 3.0)):
        parent.location = x, 0.0, 1.0
        parent.keyframe_insert("location", frame=frame)

    def places() -> np.ndarray:
        """(frames, armatures, 4, 4)."""
        found = []
        for frame in (1, 30, 50):
            scene.frame_set(frame)
            found.append([np.array(each.matrix_world) for each in (jump, other)])
        return np.array(found)

    before, as_asked_for = places(), np.array((2.0, 0.5))
    repair(jump, Repairs(scale=2.0))
    repair(other, Repairs(scale=0.5))
    after = places()
    np.testing.assert_allclose(
        after[..., :3, :], as_asked_for[:, None, None] * before[..., :3, :], atol=1e-5
    )
    repair(jump, Repairs())
    np.testing.assert_allclose(places()[:, 0], before[:, 0], atol=1e-6)
    np.testing.assert_allclose(places()[:, 1], after[:, 1], atol=1e-6)
    repair(other, Repairs())
    np.testing.assert_allclose(places(), before, atol=1e-6)
    assert jump.parent == other.parent == parent
    assert not any("repairs" in each.name for each in bpy.data.objects)


@pytest.mark.slow
def test_one_remedy_takes_the_place_of_the_other(examined) -> None:
    bpy.ops.hangtime.repair(kind="time scale")
    bpy.ops.hangtime.repair(kind="time scale", other=True)
    now = applied(examined.hangtime)
    assert now.time_scale == 1.0
    assert now.scale == pytest.approx(SLOWED**-2, rel=0.05)


@pytest.mark.slow
def test_what_is_repaired_is_found_again_as_such(examined) -> None:
    found = kinds(examined)
    bpy.ops.hangtime.repair_all()
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(examined) == found
    assert all(is_applied(examined.hangtime, row) for row in findings(examined.hangtime))


@pytest.mark.slow
def test_a_row_leads_to_its_frame_and_bone(examined) -> None:
    bpy.context.scene.frame_set(1)
    bpy.ops.hangtime.show_finding(kind="spike")
    assert bpy.context.scene.frame_current == SPIKED
    assert examined.data.bones.active.name == "LeftArm"


@pytest.mark.slow
def test_the_timeline_has_a_row_of_doubtful_frames(examined) -> None:
    (row,) = rows_of(examined.hangtime, lambda frame: frame)
    spike = next(bar for bar in row.bars if bar.name == "Spike")
    assert (spike.start, spike.end) == (SPIKED - 0.5, SPIKED + 0.5)
    assert spike.used
    bpy.ops.hangtime.repair_all()
    assert not any(bar.used for bar in rows_of(examined.hangtime, lambda frame: frame)[0].bars)


@pytest.mark.slow
def test_another_key_makes_the_examination_stale(examined) -> None:
    bpy.ops.hangtime.repair_all()
    assert not look_at_examination(examined)
    curves_of(examined)[0].keyframe_points[3].co[1] += 0.1
    assert look_at_examination(examined)
    assert examined.hangtime.examination_stale


@pytest.mark.slow
def test_repairs_are_undone_saved_and_exported(examined, tmp_path) -> None:
    bpy.ops.hangtime.repair_all()
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert not repaired_since(examined.hangtime)
    repairs = applied(examined.hangtime)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "repaired.blend"))
    bpy.ops.hangtime.export_recipe(filepath=str(tmp_path / "repaired.toml"))
    recipe = parse_recipe((tmp_path / "repaired.toml").read_text(encoding="utf-8"))
    assert recipe.repairs == repairs
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "repaired.blend"))
    again = bpy.context.scene.hangtime.armature
    assert applied(again.hangtime) == repairs
    assert len(findings(again.hangtime)) == 3
    bpy.ops.hangtime.repair(kind="spike")
    assert repaired_since(again.hangtime)


def test_unplaced_takes_back_what_the_scene_shows(jump) -> None:
    raw = read_recorded(jump, *JUMP_FRAMES)
    repairs = Repairs(UpAxis.Y, time_scale=0.8, scale=0.5, floor=0.3, tilt=(1.5, -0.5))
    repair(jump, repairs)
    back = unplaced(read_recorded(jump, *JUMP_FRAMES), repairs)
    np.testing.assert_allclose(back.heads, raw.heads, atol=1e-5)
    np.testing.assert_allclose(back.times, raw.times, atol=1e-6)
    np.testing.assert_allclose(back.rotations, raw.rotations, atol=1e-5)
    np.testing.assert_allclose(back.bones[5].head, raw.bones[5].head, atol=1e-5)


def test_a_figure_without_feet_is_refused_in_words() -> None:
    rigs.reset()
    with pytest.raises(RuntimeError):
        bpy.ops.hangtime.examine()
