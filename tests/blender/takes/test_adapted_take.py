"""The operators on a recorded jump within a longer take: carried along, stacked, in a strip."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import read_recorded, recorded_action
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.results.look_again import TAKE_CHANGED, look_again
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import JUMP_FRAMES
from mathutils import Matrix

FIRST, LAST = JUMP_FRAMES
BLEND = 30  # frames, a quarter of a second

pytestmark = pytest.mark.usefixtures("_enabled")


def keys_of(armature: bpy.types.Object) -> dict[tuple[str, int], np.ndarray]:
    curves = fcurves.curves_of(armature)
    names = ("co", "handle_left", "handle_right")
    return {
        (c.data_path, c.array_index): np.hstack([fcurves.table(c)[name] for name in names])
        for c in curves
    }


@pytest.mark.slow
def test_what_follows_a_moved_landing_is_carried_along(analysed: bpy.types.Object) -> None:
    before, take = keys_of(analysed), read_recording(analysed)
    stance = analysed.hangtime.stances["ground 2"]
    stance.forward = 0.2
    place = np.array(stance.forward_axis)
    analysed.hangtime.keep_times = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    after, now = keys_of(analysed), read_recording(analysed)
    assert now.frames.tolist() == take.frames.tolist()
    for channel, keys in before.items():
        own, was = (each[each[:, 0] <= FIRST - BLEND] for each in (after[channel], keys))
        assert own.tobytes() == was.tobytes()
    rest = take.frames > LAST + BLEND
    np.testing.assert_allclose(now.heads[rest], take.heads[rest] + 0.2 * place, atol=1e-6)
    # The feet that stand at the end of the range go on standing there.
    foot = now.index("LeftFoot")
    standing = slice(LAST - 10 - 1, LAST + BLEND)
    assert np.ptp(now.heads[standing, foot, :2], axis=0).max() < 0.02
    speed = np.diff(now.heads[:, 0], axis=0)
    bends = np.linalg.norm(np.diff(speed, axis=0), axis=1)
    assert bends[LAST - 3 : LAST + 2].max() < 2.0 * bends[FIRST : LAST - 5].max()
    assert "carried along with Landing" in analysed.hangtime.status


@pytest.mark.slow
def test_a_second_edit_builds_on_the_first(analysed: bpy.types.Object) -> None:
    take = read_recording(analysed)
    analysed.hangtime.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    first = current_action(analysed)
    assert bpy.ops.hangtime.start_from(result=True) == {"FINISHED"}
    assert not analysed.hangtime.contacts
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert recorded_action(analysed) == first
    analysed.hangtime.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    second = current_action(analysed)
    assert second.hangtime.recording == first
    carried = read_recording(analysed).heads[-1, 0] - take.heads[-1, 0]
    assert np.linalg.norm(carried) == pytest.approx(0.2, abs=1e-3)
    assert bpy.ops.hangtime.show_take(action=first.name) == {"FINISHED"}
    assert analysed.hangtime.stances["ground 2"].forward == pytest.approx(0.1)


@pytest.mark.slow
def test_update_refines_again_when_the_take_below_was_edited(analysed: bpy.types.Object) -> None:
    take, slot = current_action(analysed), fcurves.slot_identifier(analysed)
    analysed.hangtime.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.refine() == {"FINISHED"}
    first = current_action(analysed)
    path = analysed.pose.bones["LeftArm"].path_from_id("rotation_quaternion")
    if fcurves.holder_in(take, slot).fcurves.find(path, index=1) is None:
        path = analysed.pose.bones["LeftArm"].path_from_id("rotation_euler")
    for key in fcurves.holder_in(take, slot).fcurves.find(path, index=1).keyframe_points:
        key.co.y += 0.05
    look_again(analysed)
    assert first.hangtime.stale == TAKE_CHANGED
    with pytest.raises(RuntimeError, match="Analyze"):  # these contacts are another motion's
        bpy.ops.hangtime.adapt()
    assert bpy.ops.hangtime.update() == {"FINISHED"}
    second = current_action(analysed)
    assert second != first
    assert second.hangtime.refined
    look_again(analysed)
    assert second.hangtime.stale == ""
    assert analysed.hangtime.stances["ground 2"].forward == pytest.approx(0.1, abs=1e-5)


@pytest.mark.slow
def test_a_result_in_a_strip_is_switched_off(
    analysed: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    take, before = current_action(analysed), read_recording(analysed)
    analysed.hangtime.result.written_as = "STRIP"
    analysed.hangtime.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert f"Wrote the strip {current_action(analysed).name}" in capfd.readouterr().out
    track = analysed.animation_data.nla_tracks[-1]
    track.mute = True
    assert current_action(analysed) == take
    now = read_recorded(analysed, 1.0, float(before.frames[-1]))
    assert now.heads.tobytes() == before.heads.tobytes()
    track.mute = False
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}  # the take is what it starts from
    assert recorded_action(analysed) == take
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(analysed) == take
    assert len(analysed.animation_data.nla_tracks) == 2


@pytest.mark.slow
def test_a_jump_in_a_strip_of_the_artist_s_is_adapted_where_it_plays(
    jump: bpy.types.Object,
) -> None:
    data, later = jump.animation_data, 50
    take, before = data.action, read_recording(jump)
    strip = data.nla_tracks.new().strips.new("Jump", 1 + later, take)
    data.action = None
    strip.action_frame_start, strip.action_frame_end = take.frame_range
    jump.hangtime.first_frame, jump.hangtime.last_frame = FIRST + later, LAST + later
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    jump.hangtime.stances["ground 2"].up = 0.05
    jump.hangtime.keep_times = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    now = read_recording(jump)
    assert now.frames.tolist() == (before.frames + later).tolist()
    up = now.heads[:, 0, 2] - before.heads[:, 0, 2]
    np.testing.assert_allclose(up[before.frames > LAST + BLEND], 0.05, atol=1e-5)
    np.testing.assert_allclose(up[before.frames < FIRST - BLEND], 0.0, atol=1e-5)
    assert bpy.ops.hangtime.compare() == {"FINISHED"}
    assert data.action is None
    assert recorded_action(jump) == current_action(jump) == take


def test_a_return_before_the_last_adapted_frame_is_refused(analysed: bpy.types.Object) -> None:
    result = analysed.hangtime.result
    result.after, result.use_return_frame, result.return_frame = "RETURN", True, 200
    with pytest.raises(RuntimeError, match="choose a later frame"):
        bpy.ops.hangtime.adapt()


def test_a_return_beyond_the_takes_end_is_refused(analysed: bpy.types.Object) -> None:
    end = round(read_recording(analysed).frames[-1])
    result = analysed.hangtime.result
    result.after, result.use_return_frame, result.return_frame = "RETURN", True, end + 1
    with pytest.raises(RuntimeError, match=f"by frame {end + 1}, but its last frame is {end};"):
        bpy.ops.hangtime.adapt()


@pytest.mark.slow
def test_edits_made_by_hand_are_told_before_they_stay_behind(
    analysed: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    analysed.hangtime.result.keep_polish = False
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    first = current_action(analysed)
    fcurves.curves_of(analysed)[0].keyframe_points[50].co.y += 1.0
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert f"Keys of {first.name} were edited by hand" in capfd.readouterr().out
    assert first.use_fake_user


def turn(armature: bpy.types.Object, bone: str, frames: range, angle: float) -> None:
    """Turn a bone about its own X on some frames of what is shown, as an artist does by keys."""
    posed = armature.pose.bones[bone]
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        more = Matrix.Rotation(angle, 3, "X")
        rigs.set_rotation(posed, (posed.matrix_basis.to_3x3() @ more).to_quaternion())
        posed.keyframe_insert(rigs.rotation_path(posed), frame=frame)


def basis(armature: bpy.types.Object, bone: str, frame: float) -> np.ndarray:
    bpy.context.scene.frame_set(int(frame))
    return np.array(armature.pose.bones[bone].matrix_basis.to_3x3())


@pytest.mark.slow
def test_hand_polish_is_kept_when_the_landing_is_moved_again(analysed: bpy.types.Object) -> None:
    scene, stance = bpy.context.scene, analysed.hangtime.stances["ground 2"]
    analysed.hangtime.keep_times = True
    stance.forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    solved = basis(analysed, "Head", 200)
    turn(analysed, "Head", range(190, 211), 0.3)  # in flight, and of no pinned point
    stance.forward = 0.2
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    second = current_action(analysed)
    assert second.hangtime.polished
    assert "Hand polish of" in analysed.hangtime.status
    assert not second.hangtime.warning
    polished = basis(analysed, "Head", 200)
    analysed.hangtime.result.keep_polish = False
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    clean = basis(analysed, "Head", 200)
    turned = np.array(Matrix.Rotation(0.3, 3, "X"))
    np.testing.assert_allclose(clean.T @ polished, turned, atol=1e-4)
    assert np.abs(clean - solved).max() > 1e-4  # it was solved anew beneath
    assert scene.frame_current == 200


@pytest.mark.slow
def test_hand_polish_that_moves_a_pinned_foot_is_warned_about(analysed: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    turn(analysed, "LeftFoot", range(250, 256), 0.2)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    result = current_action(analysed)
    assert "Hand polish moves Left toe 2 by" in result.hangtime.warning
    assert "Hand polish moves Left toe 2 by" in result.hangtime.report


@pytest.mark.slow
def test_contacts_are_marked_and_told_to_engines(analysed: bpy.types.Object) -> None:
    options = analysed.hangtime.result
    options.markers, options.contact_channels = "ACTION", True
    analysed.hangtime.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    result = current_action(analysed)
    curve = next(c for c in fcurves.curves_of(analysed) if c.data_path == '["contact_left_foot"]')
    assert set(fcurves.keys(curve)[:, 1]) == {0.0, 1.0}
    assert {point.interpolation for point in curve.keyframe_points} == {"CONSTANT"}
    markers = {(m.name, m.frame) for m in result.pose_markers}
    (up,) = (frame for name, frame in markers if name == "Left foot up")
    (down,) = (frame for name, frame in markers if name == "Left foot down")
    scene = bpy.context.scene
    for frame, touches in ((up, 1.0), (up + 1, 0.0), (down - 1, 0.0), (down, 1.0)):
        scene.frame_set(frame)
        assert analysed["contact_left_foot"] == touches
    # it lands later where it lands further, as the result's own times are told
    found = next(c.found_start for c in analysed.hangtime.contacts if c.name == "Left toe 2")
    assert down >= round(found)
    assert not scene.timeline_markers
    options.markers, options.written_as = "TIMELINE", "COMBINE"
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert {m.name for m in scene.timeline_markers} >= {"Right foot up", "Right foot down"}
    scene.frame_set(up + 1)
    assert analysed["contact_left_foot"] == 0.0
    scene.frame_set(up)
    assert analysed["contact_left_foot"] == 1.0
