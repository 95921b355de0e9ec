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
