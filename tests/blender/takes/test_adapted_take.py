"""The operators on a recorded jump within a longer take: carried along, stacked, in a strip."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import read_recorded, recorded_action
from hangtime.bridge.armature.read import read_recording

FIRST, LAST = 110, 260
BLEND = 30  # frames, a quarter of a second

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def analysed(jump: bpy.types.Object) -> bpy.types.Object:
    jump.hangtime.first_frame, jump.hangtime.last_frame = FIRST, LAST
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    return jump


def keys_of(armature: bpy.types.Object) -> dict[tuple[str, int], np.ndarray]:
    curves = fcurves.curves_of(armature)
    names = ("co", "handle_left", "handle_right")
    return {
        (c.data_path, c.array_index): np.hstack([fcurves.table(c)[name] for name in names])
        for c in curves
    }


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
    assert "carried along with ground 2" in analysed.hangtime.status


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


def test_a_result_in_a_strip_is_switched_off(analysed: bpy.types.Object) -> None:
    take, before = current_action(analysed), read_recording(analysed)
    analysed.hangtime.result.written_as = "STRIP"
    analysed.hangtime.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
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


def test_a_return_before_the_last_adapted_frame_is_refused(analysed: bpy.types.Object) -> None:
    result = analysed.hangtime.result
    result.after, result.use_return_frame, result.return_frame = "RETURN", True, 200
    with pytest.raises(RuntimeError, match="choose a later frame"):
        bpy.ops.hangtime.adapt()


def test_edits_made_by_hand_are_told_before_they_stay_behind(
    analysed: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    first = current_action(analysed)
    fcurves.curves_of(analysed)[0].keyframe_points[50].co.y += 1.0
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert f"Keys of {first.name} were edited by hand" in capfd.readouterr().out
    assert first.use_fake_user


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
