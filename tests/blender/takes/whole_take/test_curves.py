"""Curves of a result: dense or sparse, muted or modified, turns and sizes as the take had them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.rows.choices import After
from hangtime.bridge.takes.key_splice import retime
from hangtime.bridge.takes.take_time import TakeTime
from hangtime.bridge.takes.write_result import write_result
from hangtime.solver.numerics.rotations import axis_rotation, rotation_vector
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.takes.whole_take.asked import (
    BLEND,
    FIRST,
    LAST,
    LENGTH,
    TURN,
    keys_of,
    later,
    motion,
    take,
)

pytestmark = pytest.mark.usefixtures("_enabled")


def test_curves_with_a_key_on_every_frame_have_one_on_every_frame_of_the_result() -> None:
    """Also to its very end, where the take ends with the adapted frames."""
    armature = take()
    finger = armature.pose.bones["finger"]
    finger["smile"] = 0.0
    for frame in range(1, LAST + 1):
        finger["smile"] = float(frame)
        finger.keyframe_insert('["smile"]', frame=frame)
    (curve,) = (c for c in fcurves.curves_of(armature) if "smile" in c.data_path)
    for key in curve.keyframe_points:
        key.interpolation = "LINEAR"
    write_result(armature, later(read_recording(armature)), name="Result")
    smile = keys_of(armature)['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 0].tolist() == list(range(1, LAST + 4))
    shown = np.interp(smile[:, 0], [FIRST, 53.4, LAST + 3.4], [FIRST, 50.0, LAST])
    inside = smile[:, 0] >= FIRST
    assert smile[inside, 1] == pytest.approx(shown[inside], abs=1e-4)


def test_a_switch_of_two_keys_side_by_side_is_no_baked_curve() -> None:
    armature = take()
    armature.pose.bones["finger"]["smile"] = 0.0
    for frame, value in ((10, 0.0), (45, 0.0), (46, 1.0), (90, 1.0)):
        armature.pose.bones["finger"]["smile"] = value
        armature.pose.bones["finger"].keyframe_insert('["smile"]', frame=frame)
    write_result(armature, later(read_recording(armature)), name="Result")
    smile = keys_of(armature)['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 1].tolist() == [0.0, 0.0, 1.0, 1.0]


@pytest.mark.parametrize(
    "keyed",
    [
        pytest.param({10: 0.0, 45: 0.0, 46: 1.0, 90: 1.0}, id="two keys"),
        pytest.param({10: 0.0, 44: 0.0, 45: 0.0, 46: 1.0, 47: 1.0, 90: 1.0}, id="held"),
        pytest.param({10: 0.0, 45: 0.0, 46: 1.0, 47: 0.0, 90: 0.0}, id="a blink"),
        pytest.param({frame: float(frame > 45) for frame in range(1, LAST + 1)}, id="baked"),
        pytest.param({10: 0.0, FIRST: 0.0, FIRST + 1: 1.0, 90: 1.0}, id="at the border"),
    ],
)
def test_a_switch_is_half_thrown_on_no_whole_frame(keyed: dict[int, float]) -> None:
    """Though durations change: the take has none either."""
    armature = take()
    finger = armature.pose.bones["finger"]
    for frame, value in keyed.items():
        finger["smile"] = value
        finger.keyframe_insert('["smile"]', frame=frame)
    write_result(armature, later(read_recording(armature)), name="Result")
    (curve,) = (c for c in fcurves.curves_of(armature) if "smile" in c.data_path)
    shown = np.array([curve.evaluate(frame) for frame in range(1, LAST + 4)])
    assert {0.0, 1.0} == set(shown.round(5).tolist())
    assert np.count_nonzero(np.diff(shown)) == np.count_nonzero(np.diff(list(keyed.values())))


@pytest.mark.parametrize("start", [23, 24, 25])
def test_a_motion_at_the_end_of_what_is_retimed_is_no_switch(start: int) -> None:
    rigs.reset()
    moved = bpy.data.objects.new("Moved", None)
    for frame in range(60):
        moved.location.x = 0.1 * np.clip(frame - start, 0, 30)
        moved.keyframe_insert("location", index=0, frame=frame)
    (curve,) = fcurves.curves_of(moved)
    for key in curve.keyframe_points:
        key.interpolation = "LINEAR"
    time, frames = TakeTime(np.array([10.0, 20.0, 26.0]), np.array([10.0, 22.6, 29.0])), range(30)
    wanted = [curve.evaluate(frame) for frame in time.to_recorded(np.array(frames))]
    retime(curve, time)
    assert [curve.evaluate(frame) for frame in frames] == pytest.approx(wanted, abs=1e-5)


def test_sparse_curves_keep_their_keys_and_what_is_between_them() -> None:
    armature = take(every=7)
    before, recording = keys_of(armature), read_recording(armature)
    write_result(armature, motion(recording), name="Result")
    after, now = keys_of(armature), read_recording(armature)
    for channel, keys in before.items():
        frames = set(after[channel][:, 0])
        own = keys[(keys[:, 0] <= FIRST - BLEND) | (keys[:, 0] >= LAST + BLEND)]
        assert {row.tobytes() for row in own} <= {row.tobytes() for row in after[channel]}, channel
        assert frames >= set(own[:, 0])
    outer = (recording.frames <= FIRST - BLEND) | (recording.frames >= LAST + BLEND)
    np.testing.assert_allclose(now.heads[outer], recording.heads[outer], atol=1e-6)


@pytest.mark.parametrize("keyed", [(), (1,), (LENGTH,)])
def test_without_blends_a_bone_that_is_hardly_keyed_stays_as_it_was(keyed: tuple[int, ...]) -> None:
    armature = take()
    curves = fcurves.holder(armature).fcurves
    for curve in [c for c in curves if fcurves.bone_of(c.data_path) == "foot"]:
        curves.remove(curve)
    foot = armature.pose.bones["foot"]
    foot.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
    for frame in keyed:
        foot.keyframe_insert("rotation_quaternion", frame=frame)
    recording = read_recording(armature)
    asked = motion(recording, blend_in=0.0, blend_out=0.0)
    asked.track.rotations[:, -1] = TURN @ asked.track.rotations[:, -1]  # the foot's, by itself
    write_result(armature, asked, name="Result")
    now = read_recording(armature)
    outer = (recording.frames < FIRST) | (recording.frames > LAST)
    np.testing.assert_allclose(now.rotations[outer], recording.rotations[outer], atol=1e-6)
    rows, bones = slice(FIRST - 1, LAST), [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)


def spoilt_by_a_modifier(curve: bpy.types.FCurve) -> None:
    curve.modifiers.new("NOISE")


def spoilt_by_muting(curve: bpy.types.FCurve) -> None:
    curve.mute = True


@pytest.mark.parametrize("spoil", [spoilt_by_a_modifier, spoilt_by_muting])
def test_modifiers_become_keys(spoil: Callable[[bpy.types.FCurve], None]) -> None:
    armature = take("XYZ")
    spoil(next(c for c in fcurves.curves_of(armature) if fcurves.bone_of(c.data_path) == "shin"))
    recording = read_recording(armature)
    asked = motion(recording)
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert written.applied == ("shin",)
    now = read_recording(armature)
    rows = slice(FIRST - 1, LAST)
    bones = [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)
    outer = (recording.frames < FIRST - BLEND) | (recording.frames > LAST + BLEND)
    np.testing.assert_allclose(now.rotations[outer], recording.rotations[outer], atol=5e-6)


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_a_full_turn_more_does_not_spin_back(mode: str) -> None:
    """Between the last new key and the take's next one, too."""
    armature = take(mode)
    recording = read_recording(armature)
    asked = motion(recording)
    spin = np.clip((asked.track.frames - FIRST) / (LAST - FIRST), 0.0, 1.0)
    spun = axis_rotation(2, 2.0 * np.pi * spin**2 * (3.0 - 2.0 * spin))
    track = replace(asked.track, rotations=spun[:, None] @ asked.track.rotations)
    write_result(armature, replace(asked, track=track), name="Result")
    end = round(LAST + BLEND)
    for frame in np.arange(LAST - 1, end + 2, 0.5):
        one, two = (
            np.array(rigs.world_of(armature, "spine", at).to_3x3()) for at in (frame, frame + 0.5)
        )
        assert np.linalg.norm(rotation_vector(two @ one.T)) < 0.2


def sized() -> bpy.types.Object:
    """A take whose thigh changes its size from frame to frame."""
    armature = take()
    thigh = armature.pose.bones["thigh"]
    for frame in range(1, LENGTH + 1):
        thigh.scale.y = 1.0 + 0.1 * np.sin(0.3 * frame)
        thigh.keyframe_insert("scale", frame=frame)
    return armature


SIZE = ('pose.bones["thigh"].scale', 1)


def test_a_size_that_changes_holds_still_in_the_adapted_frames_and_is_blended() -> None:
    armature = sized()
    before = keys_of(armature)
    write_result(armature, motion(read_recording(armature)), name="Result")
    was, now = before[SIZE], keys_of(armature)[SIZE]
    np.testing.assert_array_equal(now[:, 0], was[:, 0])
    frames, sizes, recorded = now[:, 0], now[:, 1], was[:, 1]
    inside = (frames >= FIRST) & (frames <= LAST)
    outside = (frames <= FIRST - BLEND) | (frames >= LAST + BLEND)
    assert sizes[outside].tobytes() == recorded[outside].tobytes()
    np.testing.assert_allclose(sizes[inside], np.median(recorded[inside]), atol=1e-6)
    assert np.abs(np.diff(sizes)).max() < 0.06  # no step at the seams; recorded 0.03 a frame


@pytest.mark.parametrize("options", [{"lock_others": True}, {"after": After.CUT}, {}])
def test_sizes_hold_at_the_recordings_median_whatever_the_durations(options) -> None:
    armature = sized()
    recorded = keys_of(armature)[SIZE][FIRST - 1 : LAST, 1]
    _, written = write_result(armature, later(read_recording(armature), **options), name="Result")
    assert written is None or written.held == ("thigh",)
    keys = keys_of(armature)[SIZE]
    sizes = keys[(keys[:, 0] >= FIRST) & (keys[:, 0] <= LAST), 1]
    np.testing.assert_allclose(sizes, np.median(recorded), atol=1e-6)
