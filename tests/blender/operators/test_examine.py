"""The doctor in Blender: what is wrong appears in rows, and remedies mend what is read."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.fcurves import curves_of, put, table
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.fake_users import guard
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.bridge.repairs.analysis_key import repaired_since
from hangtime.bridge.repairs.missing_keys import put_in
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
from hangtime.bridge.takes.takes import derive
from hangtime.operators.solve.session import session
from hangtime.operators.timeline.timeline_bars import rows_of
from hangtime.solver.data.problem import Mend
from hangtime.solver.data.scene import SupportBox
from hangtime.solver.doctor.examination.repair import as_asked, unplaced
from hangtime.solver.doctor.repairs import MissingFrames, Repairs, UpAxis
from hangtime.solver.doctor.stance.feet import FootFaultKind
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.solids import add_row
from hangtime.tests.helpers.clips import (
    JUMP,
    JUMP_FRAMES,
    begun_at_rest,
    mocap_path,
    with_frames_repeated,
    without_frames,
)

SPIKED, TURN, RAISED, SLOWED = 150, 0.8, 0.2, 1.25
GAP, LACKS = 150, 4  # frames are missing after one
HELD, EXTRA, LATER = 195, 36, 250  # a frame that is held for so many more, and a gap after it
JOINED = 240

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


def kinds(armature: bpy.types.Object) -> list[str]:
    return [row.name for row in findings(armature.hangtime)]


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
    session().support = (examined.session_uid, (SupportBox((1, 1, 1), (0, 0, 0), 0.0),))
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


def take_frames_out(armature: bpy.types.Object) -> None:
    """Leaves out frames 151 to 154, those after them that much earlier."""
    for curve in curves_of(armature):
        keys = table(curve)
        at = keys["co"][:, 0]
        keys = {name: column[(at <= GAP) | (at > GAP + LACKS)] for name, column in keys.items()}
        late = keys["co"][:, 0] > GAP
        for name in ("co", "handle_left", "handle_right"):
            keys[name][late, 0] -= LACKS
        put(curve, keys)


@pytest.fixture
def lacking(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump without frames 151 to 154, those after them that much earlier."""
    take_frames_out(jump)
    return jump


@pytest.mark.slow
def test_missing_frames_are_put_into_a_copy(jump, request) -> None:
    whole = read_recorded(jump, *JUMP_FRAMES)
    lacking = request.getfixturevalue("lacking")
    settings, recorded = lacking.hangtime, lacking.animation_data.action
    before = keys_digest(recorded)
    settings.use_range, settings.first_frame, settings.last_frame = True, 60, 326
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert finding_of(settings.findings["dropped frames"]).amount == LACKS
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert lacking.animation_data.action != recorded
    assert keys_digest(recorded) == before
    assert (settings.first_frame, settings.last_frame) == (60, 326 + LACKS)
    filled = read_recorded(lacking, *JUMP_FRAMES)
    assert np.abs(filled.heads - whole.heads).max() < 2e-3
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert is_applied(settings, settings.findings["dropped frames"])  # no more is found to be wrong
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert lacking.animation_data.action == recorded
    assert list(bpy.data.actions) == [recorded]
    assert settings.last_frame == 326
    assert applied(settings) == Repairs()


@pytest.mark.slow
def test_frames_that_are_too_many_are_taken_out_and_later_ones_put_in(tmp_path: Path) -> None:
    """Remedies count in the recording's frames, whichever are out already."""
    held = with_frames_repeated(mocap_path(JUMP), HELD, EXTRA, tmp_path)
    take = import_clip(without_frames(held, LATER, LACKS, tmp_path)).armature
    settings, recorded = take.hangtime, take.animation_data.action
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    told = finding_of(settings.findings["repeated frames"])
    assert told.remedy == Repairs(missing=(MissingFrames(HELD, -EXTRA),))
    assert bpy.ops.hangtime.repair(kind="repeated frames") == {"FINISHED"}
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert bpy.ops.hangtime.repair(kind="dropped frames") == {"FINISHED"}
    assert applied(settings).missing == (MissingFrames(HELD, -EXTRA), MissingFrames(LATER, LACKS))
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {row.name for row in findings(settings) if not is_applied(settings, row)} == set()
    mended = read_recorded(take, *JUMP_FRAMES)
    whole = read_recorded(import_clip(mocap_path(JUMP)).armature, *JUMP_FRAMES)
    assert np.abs(mended.heads - whole.heads).max() < 5e-3
    bpy.context.view_layer.objects.active = take
    for kind in ("dropped frames", "repeated frames"):
        assert bpy.ops.hangtime.repair(kind=kind) == {"FINISHED"}
    assert take.animation_data.action == recorded
    assert finding_of(settings.findings["repeated frames"]) == told


def test_frames_left_out_again_leave_a_recording_its_fake_user_while_a_result_lives(
    lacking,
) -> None:
    recorded, gap = lacking.animation_data.action, (MissingFrames(GAP, LACKS),)
    recorded.use_fake_user = False
    result = recorded.copy()
    derive(result, recorded, lacking)
    guard(recorded)
    for left in (True, False):
        put_in(lacking, gap, ())
        assert lacking.animation_data.action != recorded
        put_in(lacking, (), gap)
        assert lacking.animation_data.action == recorded
        assert recorded.use_fake_user == left
        if left:
            bpy.data.actions.remove(result)


@pytest.mark.slow
def test_missing_frames_are_not_put_into_a_strip(lacking) -> None:
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    data = lacking.animation_data
    action, slot = data.action, getattr(data, "action_slot", None)
    strip = data.nla_tracks.new().strips.new("Take", 1, action)
    if slot is not None:
        strip.action_slot = slot
    data.action = None
    with pytest.raises(RuntimeError, match="a strip plays it"):
        bpy.ops.hangtime.repair(kind="dropped frames")
    assert applied(lacking.hangtime) == Repairs()


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


def legs_exchanged(source: Path, target: Path, frames: slice) -> Path:
    """A copy of a BVH file in which each leg has the other's angles."""
    head, rows = source.read_text().split("Frame Time:")
    clock, *lines = rows.strip().splitlines()
    joints = re.findall(r"(?:ROOT|JOINT) (\S+)", head)
    values = np.array([line.split() for line in lines], float)
    for part in ("Hip", "Knee", "Ankle", "Toe"):
        left, right = (
            slice(3 * joints.index(side + part) + 3, 3 * joints.index(side + part) + 6)
            for side in ("Left", "Right")
        )
        values[frames, left], values[frames, right] = (
            values[frames, right].copy(),
            values[frames, left].copy(),
        )
    changed = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in values)
    target.write_text(f"{head}Frame Time: {clock.strip()}\n{changed}\n")
    return target


@pytest.mark.slow
def test_legs_that_were_exchanged_in_a_file_are_exchanged_back(tmp_path) -> None:
    rigs.reset()
    source = mocap_path("131_03_hop.bvh")
    whole = read_recording(import_clip(source).armature)
    rigs.reset()
    clip = legs_exchanged(source, tmp_path / "exchanged.bvh", slice(280, 320))
    hop = import_clip(clip).armature
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(hop) == ["exchanged legs", "sliding feet"]  # as they are: he turns on them
    found = finding_of(hop.hangtime.findings["exchanged legs"])
    assert found.frames == ((281.0, 320.0),)
    assert bpy.ops.hangtime.repair(kind="exchanged legs") == {"FINISHED"}
    recording = read_recording(hop)
    mended = as_asked(recording, problem_of(hop.hangtime, recording))
    assert np.abs(recording.heads - whole.heads).max() > 0.3
    assert np.abs(mended.heads - whole.heads).max() < 0.05
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert is_applied(hop.hangtime, hop.hangtime.findings["exchanged legs"])


@pytest.mark.slow
def test_frames_at_rest_are_left_out_by_the_range(tmp_path) -> None:
    rigs.reset()
    jump = import_clip(begun_at_rest(mocap_path(JUMP), tmp_path)).armature
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]
    bpy.ops.hangtime.repair(kind="bind pose")
    assert (jump.hangtime.use_range, jump.hangtime.first_frame) == (True, 2)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]  # to be left in again
    bpy.ops.hangtime.repair(kind="bind pose")
    assert not jump.hangtime.use_range


@pytest.mark.slow
def test_frames_at_rest_at_both_ends_are_left_out_together(tmp_path) -> None:
    rigs.reset()
    jump = import_clip(begun_at_rest(mocap_path(JUMP), tmp_path, ended=True)).armature
    last = round(read_recording(jump).frames[-1])
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["bind pose"]
    bpy.ops.hangtime.repair(kind="bind pose")
    settings = jump.hangtime
    assert (settings.use_range, settings.first_frame, settings.last_frame) == (True, 2, last - 1)
    bpy.ops.hangtime.repair(kind="bind pose")
    assert not settings.use_range


@pytest.fixture
def joined(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump, 0.4 m elsewhere from frame 240 on."""
    for curve in curves_of(jump):
        if 'Hips"' in curve.data_path and curve.data_path.endswith("location"):
            keys = table(curve)
            keys["co"][keys["co"][:, 0] >= JOINED, 1] += 0.4 / jump.scale.x / np.sqrt(3.0)
            put(curve, keys)
    return jump


@pytest.mark.slow
def test_of_a_clip_that_was_joined_the_longest_part_is_kept(joined) -> None:
    settings = joined.hangtime
    settings.use_range = False
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert "jump" in kinds(joined)
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert (settings.use_range, settings.first_frame, settings.last_frame) == (True, 1, JOINED - 1)
    assert is_applied(settings, settings.findings["jump"])
    assert bpy.ops.hangtime.repair(kind="jump") == {"FINISHED"}
    assert not settings.use_range


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chosen", "left"),
    [
        ((100, 290), (100, JOINED - 1)),
        ((JOINED - 20, 320), (JOINED, 320)),
        ((JOINED + 5, 320), (JOINED + 5, 320)),
    ],
)
def test_of_the_frames_that_were_chosen_the_longest_part_stays(joined, chosen, left) -> None:
    """A range on the other side needs no repair."""
    settings = joined.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = chosen
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    if bpy.ops.hangtime.repair_all.poll():
        bpy.ops.hangtime.repair_all()
    assert (settings.first_frame, settings.last_frame) == left


@pytest.mark.slow
def test_frames_that_are_put_in_move_what_is_left_out(joined) -> None:
    settings = joined.hangtime
    settings.use_range = False
    take_frames_out(joined)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {"dropped frames", "jump"} <= set(kinds(joined))
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert (settings.first_frame, settings.last_frame) == (1, JOINED - 1)
    assert finding_of(settings.findings["jump"]).frames == ((JOINED - 1, JOINED),)


def test_a_trim_makes_the_frame_range(jump) -> None:
    assert bpy.ops.hangtime.trim(first=100, last=290) == {"FINISHED"}
    assert (jump.hangtime.first_frame, jump.hangtime.last_frame) == (100, 290)
    with pytest.raises(RuntimeError, match="no range"):
        bpy.ops.hangtime.trim(first=100, last=90)


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


@pytest.mark.slow
def test_a_body_that_drifts_upwards_is_held_level_and_goes_on_where_it_was(jump) -> None:
    """What follows the adapted frames drifts still; it is moved so that nothing jumps."""
    rise = 0.1
    for curve in curves_of(jump):
        if 'Hips"' in curve.data_path and curve.data_path.endswith("location"):
            hips = jump.data.bones["Hips"].matrix_local.to_3x3()
            turn = np.linalg.inv(np.array(jump.matrix_world.to_3x3() @ hips))
            keys = table(curve)
            seconds = (keys["co"][:, 0] - 1.0) / 120.0
            keys["co"][:, 1] += rise * seconds * turn[curve.array_index, 2]
            put(curve, keys)
    settings = jump.hangtime
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["rising"]
    assert finding_of(settings.findings["rising"]).amount == pytest.approx(rise, abs=0.015)
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert settings.unseen == ""
    settings.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    heights = read_recording(jump).heads[:, 0, 2]
    bends = np.abs(np.diff(heights, 2))[settings.last_frame - 20 :]
    assert bends.max() < 4e-3  # at 120 frames a second
    taken_out = rise * (settings.last_frame - settings.first_frame) / 120.0
    recorded = read_recorded(jump, None, None).heads[-1, 0, 2]
    assert recorded - heights[-1] == pytest.approx(taken_out, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bone", "attribute", "usual"), [("Spine", "scale", 1.0), ("LeftFoot", "location", 0.0)]
)
def test_a_length_is_told_by_the_bone_whose_keys_change_it(
    jump: bpy.types.Object, bone: str, attribute: str, usual: float
) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    jump.data.edit_bones[bone].use_connect = False  # else its location does not count
    bpy.ops.object.mode_set(mode="OBJECT")
    for frame, more in ((150, 0.0), (200, 0.2), (250, 0.0)):
        setattr(jump.pose.bones[bone], attribute, [usual + more] * 3)
        jump.pose.bones[bone].keyframe_insert(attribute, frame=frame)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    found = {row.name: finding_of(row) for row in findings(jump.hangtime)}
    assert found["bone length"].part == bone


@pytest.mark.slow
def test_hips_that_keep_one_place_get_height_and_way_back_and_are_adapted(
    jump: bpy.types.Object,
) -> None:
    """As capture by video has them that tells all places from the hips."""
    recorded = read_recorded(jump, *JUMP_FRAMES).heads[:, 0]
    hips = jump.pose.bones[0].name
    for curve in curves_of(jump):
        if curve.data_path == f'pose.bones["{hips}"].location':
            for key in curve.keyframe_points:
                key.co[1] = 0.0
            curve.update()
    before = keys_digest(action := jump.animation_data.action)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {"level hips", "in place"} <= set(kinds(jump))
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert keys_digest(action) == before
    adapted = read_recording(jump).heads[:, 0]
    assert [each.name for each in jump.hangtime.stances] == ["ground 1", "ground 2"]
    assert np.ptp(adapted[:, 2]) == pytest.approx(np.ptp(recorded[:, 2]), rel=0.1)
    way, wanted = (np.linalg.norm((each[-1] - each[0])[:2]) for each in (adapted, recorded))
    assert way == pytest.approx(wanted, rel=0.3)
