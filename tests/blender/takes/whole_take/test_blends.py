"""Beside the adapted frames a result is the take, and in blends it joins them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.stance_move import StanceMove
from hangtime.solver.numerics.rotations import rotation_vector
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.takes.whole_take.asked import (
    BLEND,
    FIRST,
    LAST,
    LENGTH,
    MOVED,
    OPTIONS,
    SHIFT,
    keys_of,
    motion,
    outside,
    take,
)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZXY", "AXIS_ANGLE"])
def test_keys_outside_of_frames_and_blends_stay_bit_by_bit(mode: str) -> None:
    armature = take(mode)
    before = keys_of(armature)
    write_result(armature, motion(read_recording(armature)), name="Result")
    after = keys_of(armature)
    assert before.keys() == after.keys()
    for channel, keys in before.items():
        own = outside(after[channel], FIRST - BLEND, LAST + BLEND)
        assert own == outside(keys, FIRST - BLEND, LAST + BLEND)
    changed = [
        channel for channel in before if after[channel].tobytes() != before[channel].tobytes()
    ]
    assert {fcurves.bone_of(path) for path, _ in changed} == set(rigs.MOVING)


def test_the_adapted_frames_are_as_solved_and_seams_have_no_bend() -> None:
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording)
    write_result(armature, asked, name="Result")
    now = read_recording(armature)
    assert now.frames.tolist() == recording.frames.tolist()
    rows = slice(FIRST - 1, LAST)
    bones = [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.heads[rows, 0], asked.track.root_head, atol=2e-6)
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)
    # Neither pose nor velocity jumps: what is left of the offset changes as smoothly as it is.
    left = now.heads[:, 0] - recording.heads[:, 0]
    bends = np.abs(np.diff(left, 2, axis=0)).max(axis=1)
    inside = bends[FIRST : LAST - 2].max()
    assert bends.max() < 2.0 * inside + 1e-4
    turned = rotation_vector(now.rotations[:, 0] @ recording.rotations[:, 0].swapaxes(1, 2))
    assert np.abs(np.diff(turned, 2, axis=0)).max() < 0.01
    assert np.abs(left[: FIRST - int(BLEND)]).max() == 0.0


def test_how_blends_move_the_hips_is_told() -> None:
    """Of hips that are 0.4 m beside the take at both seams."""
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording)
    steady = recording.window(FIRST, LAST).heads[:, 0] + [0.0, 0.4, 0.0]
    asked = replace(asked, track=replace(asked.track, root_head=steady))
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    into, out = written.blends
    assert (into.into, into.first_frame, into.last_frame) == (True, FIRST - BLEND, FIRST)
    assert (out.into, out.first_frame, out.last_frame) == (False, LAST, LAST + BLEND)
    rate = bpy.context.scene.render.fps
    usual = 0.4 * 1.875 * rate / BLEND  # the quintic polynomial's highest speed, halfway
    for each in written.blends:
        assert each.off_m == pytest.approx(0.4, abs=1e-6)
        assert each.speed_m_s == pytest.approx(usual, abs=each.take_speed_m_s + 0.05 * usual)
        assert each.first_frame < each.frame < each.last_frame


@pytest.mark.parametrize(
    ("moved", "out"),
    [(None, 0.1), (StanceMove("ground 2", (0.0, 0.0, 0.0), 0.0, (0.0, 0.1, 0.0)), 0.0)],
)
def test_feet_that_stand_in_the_take_and_slide_in_a_blend_are_told(
    moved: StanceMove | None, out: float
) -> None:
    """Of a figure that stands still, and 0.1 m aside in the adapted frames."""
    armature = rigs.make_armature()
    for frame in (1, LENGTH):
        for bone in rigs.MOVING:
            armature.pose.bones[bone].keyframe_insert("rotation_quaternion", frame=frame)
        armature.pose.bones["hips"].keyframe_insert("location", frame=frame)
    part = read_recording(armature).window(FIRST, LAST)
    bones = [part.index(bone) for bone in rigs.MOVING]
    aside = part.heads[:, 0] + [0.0, 0.1, 0.0]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], aside)
    times = TimeMap((FIRST, LAST), (FIRST, LAST))
    asked = AdaptedMotion(track, times, moved, OPTIONS, touching=("foot",))
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert [each.slide_bone for each in written.blends] == ["foot", "foot"]
    assert [each.slide_m for each in written.blends] == pytest.approx([0.1, out], abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("moved", [None, MOVED])
@pytest.mark.parametrize("longer", [0.0, 3.0, 3.4, 3.958, -3.5, -2.6])
@pytest.mark.parametrize("room", [1, 2, 5, 7, 8, 9])
def test_nothing_jumps_where_the_take_ends_in_or_beside_the_blend(
    room: int, longer: float, moved: StanceMove | None
) -> None:
    """Whatever the durations: all bones go to one last frame, no faster than in a whole blend."""
    armature = take()
    for curve in fcurves.curves_of(armature):
        fcurves.crop(curve, 1.0, LAST + room)
    recording = read_recording(armature)
    asked = motion(recording, moved)
    count = int(np.floor(LAST + longer)) - FIRST + 1
    rows = np.minimum(np.arange(count), LAST - FIRST)
    track = PoseTrack(
        FIRST + np.arange(count, dtype=float),
        rigs.MOVING,
        asked.track.rotations[rows],
        asked.track.root_head[rows],
    )
    times = TimeMap((FIRST, 50.0, LAST), (FIRST, 50.0 + longer, LAST + longer))
    _, written = write_result(armature, replace(asked, track=track, times=times), name="Result")
    assert written is not None
    ends = {float(keys[-1, 0]) for keys in keys_of(armature).values()}
    assert ends == {LAST + room + written.later}
    now = read_recording(armature)
    steps = np.linalg.norm(np.diff(now.heads, axis=0), axis=2).max(axis=1)
    usual = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max()
    assert steps[track.frames[-1].astype(int) - 1 :].max() < 1.3 * usual + 0.03


@pytest.mark.parametrize(
    ("first", "last"), [(1, 60), (3, 60), (40, LENGTH), (40, LENGTH - 3), (1, LENGTH)]
)
def test_blends_end_with_the_take(first: int, last: int) -> None:
    armature = take()
    recording = read_recording(armature)
    part = recording.window(first, last)
    bones = [recording.index(bone) for bone in rigs.MOVING]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], part.heads[:, 0] + SHIFT)
    times = TimeMap((first, last), (first, last))
    write_result(armature, AdaptedMotion(track, times, None, OPTIONS), name="Result")
    now = read_recording(armature)
    assert now.frames.tolist() == recording.frames.tolist()
    rows = slice(first - 1, last)
    np.testing.assert_allclose(now.heads[rows, 0], track.root_head, atol=2e-6)
    assert np.abs(np.diff(now.heads[:, 0] - recording.heads[:, 0], axis=0)).max() < 0.01


def test_no_blend_reaches_into_another_adaptation_of_the_take() -> None:
    armature = take()
    before, recording = keys_of(armature), read_recording(armature)
    asked = replace(motion(recording), kept=((10.0, 37.0), (63.0, 70.0)))
    write_result(armature, asked, name="Result")
    after = keys_of(armature)
    for channel, keys in before.items():
        assert outside(after[channel], 37.0, 63.0) == outside(keys, 37.0, 63.0)
