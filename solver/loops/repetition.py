"""A range that is a cycle by itself, such as a library's: its last pose is its first, further on.

Too little may be known beyond its ends to see anything come again; what is there is itself.
"""

from dataclasses import replace

import numpy as np

from ..analysis.performance import Performance
from ..analysis.take import HELD
from ..arrays import FloatArray
from ..data.recording import Recording
from ..numerics.rotations import axis_rotation, planar_turn, rotation_matrix, rotation_vector

# Of what two frames of the range differ by in pose and velocity. The ends of strides of recorded
# runs differ by 0.07 to 0.35 of that, of hops that are alike by 0.2 to 0.5, of half a stride by
# more than 1. Where a tenth is missing it is by 0.24 to 0.73, for a run by over twice the whole's.
NEAR, NEARER = 0.5, 2.0


def repeating_range(
    performance: Performance, asked: tuple[float, float], reach: float
) -> tuple[int, int] | None:
    """Indices of the first and last frame of a cycle whose ends meet: of the frames asked for, of
    the whole performance, or from the first one asked for to where its pose comes again; None where
    none do. It lasts as long as what is asked for, within `reach` of that. The first of these, but
    for one whose ends another's are nearer than by NEARER."""
    frames = performance.recording.frames
    start, end = (int(np.abs(frames - frame).argmin()) for frame in asked)
    count = (asked[1] - asked[0]) * (len(frames) - 1) / (frames[-1] - frames[0])
    some = np.arange(len(frames))
    near = np.abs(some - start - count) <= reach * count
    again = int(np.argmin(np.where(near, _apart(performance, start, end), np.inf)))
    ranges = [(0, len(frames) - 1), (start, again)]
    if frames[0] <= asked[0] and asked[1] <= frames[-1]:
        ranges = [(start, end), *ranges]
    as_long = [each for each in ranges if abs(each[1] - each[0] - count) <= reach * count]
    apart = [float(_apart(performance, first, last)[last]) for first, last in as_long]
    near = min([NEAR, *(NEARER * each for each in apart)])
    return next((each for each, off in zip(as_long, apart, strict=True) if off <= near), None)


def repeated(recording: Recording, travel: FloatArray) -> Recording:
    """A cycle of T frames with itself before and after, 3 T - 2 frames. Frames and times go on.

    travel: (3,) m from one to the next. What the cycle's ends miss each other by fades out over
    each repetition, so that feet that stand across a seam stand, and nothing jumps.
    """
    count = len(recording.frames) - 1
    move = recording.heads[-1] - recording.heads[0] - travel
    turn = rotation_vector(recording.rotations[-1] @ np.swapaxes(recording.rotations[0], 1, 2))
    step = (recording.frames[-1] - recording.frames[0]) / count
    fading = np.linspace(1.0, 0.0, count + 1)[:, None, None]

    def repetition(side: int, some: slice) -> tuple[FloatArray, FloatArray]:
        share = side * fading[::side][some]
        heads = recording.heads[some] + side * travel + share * move
        return heads, rotation_matrix(share * turn) @ recording.rotations[some]

    before, after = repetition(-1, slice(0, count)), repetition(1, slice(1, None))
    index = np.arange(-count, 2 * count + 1)
    return replace(
        recording,
        frames=recording.frames[0] + step * index,
        times=recording.times[0] + (index + count) / recording.rate,
        heads=np.concatenate([before[0], recording.heads, after[0]]),
        rotations=np.concatenate([before[1], recording.rotations, after[1]]),
    )


def without_held_ends(recording: Recording) -> Recording:
    """A recording without the frames at its ends at which its first or last pose is held, as a clip
    shows beyond its keys; with one pose alone it stays."""
    moves = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1) >= HELD
    moving = np.flatnonzero(moves)
    if not len(moving):
        return recording
    cut = recording.part(slice(int(moving[0]), int(moving[-1]) + 2))
    return replace(cut, times=cut.times - cut.times[0])


def _apart(performance: Performance, first: int, last: int) -> FloatArray:
    """(T,) by how much pose and velocities, each in its own heading, differ from those of the frame
    `first`, in shares of what two frames from there to `last` differ by: rms of both."""
    centres = performance.centres
    about = centres - centres.mean(axis=1, keepdims=True)
    turns = axis_rotation(2, planar_turn(about, about[first]))
    velocities = np.gradient(centres, performance.times, axis=0)
    shares = []
    for each in (about, velocities):
        flat = (each @ np.swapaxes(turns, 1, 2)).reshape(len(each), -1)
        typical = np.sqrt(2.0 * flat[first : last + 1].var(axis=0).sum())
        shares.append(np.linalg.norm(flat - flat[first], axis=1) / max(float(typical), HELD))
    return np.asarray(np.sqrt(np.mean(np.square(shares), axis=0)))
