"""Frames that do not belong: spikes, flips of 180°, held poses, and where frames are missing."""

from __future__ import annotations

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..body.anatomy import Part
from ..data.problem import Mend
from ..data.recording import Recording
from ..numerics.rotations import rotation_matrix, rotation_vector
from .figure import Figure
from .finding import Finding, FindingKind
from .local_poses import LocalPoses, angles_between, fourth_differences, runs, spans
from .repairs import MissingFrames, Repairs

# From the cubic through the frames around; honest toes that strike the ground are 25° off, and no
# other joint is 13° off.
SPIKE, TOE_SPIKE = np.radians(14.0), np.radians(35.0)
SPIKE_PLACE = 0.04  # m, the root; honest ones are 8 mm off
RETURNED = 0.5  # of what it leaves by; a frame that is off alone is back in the next
STANDS_OUT = 5.0  # times what the frames around are off
AROUND = 8  # frames on each side that a spike is compared with
FLIP = np.radians(140.0)  # from a frame to the next; no joint turns so far
HELD = 1e-5  # m and entries of a matrix; a pose that changes by less is held
MOVING = 1e-3  # m, of the farthest joint from a frame to the next, beside a pose that is held
LONGEST_HELD = 0.25  # s; a longer one is a pause
DROPPED = (0.8, 10.5)  # further than the frames beside: by one to ten missing frames
ALIKE = 0.15  # of a step, by which it may differ from its neighbours' way


def unsound_spikes(recording: Recording, figure: Figure) -> BoolArray:
    """(T, B) which bones' poses in their parents are a single frame's, far from those around."""
    local, unsound = LocalPoses.of(recording), np.zeros(recording.heads.shape[:2], bool)
    if len(recording.frames) <= 4:
        return unsound
    bones, toes = figure.bones, figure.of(Part.TOE)
    limits = np.where(np.isin(bones, toes), TOE_SPIKE, SPIKE)
    turns = local.rotations[:, bones]
    off = np.linalg.norm(fourth_differences(turns), axis=(2, 3)) / np.sqrt(2.0)  # rad, if small
    unsound[:, bones] = _single(off, limits) & _returned(
        angles_between(turns[:-1], turns[1:]), angles_between(turns[:-2], turns[2:])
    )
    for root in (b for b, bone in enumerate(recording.bones) if bone.parent < 0):
        heads = local.heads[:, root]
        away = np.linalg.norm(fourth_differences(heads), axis=1)[:, None]
        step, over = (np.linalg.norm(heads[n:] - heads[:-n], axis=1)[:, None] for n in (1, 2))
        single = _single(away, np.array(SPIKE_PLACE)) & _returned(step, over)
        unsound[:, root] |= single[:, 0]
    return unsound


def find_spikes(recording: Recording, figure: Figure) -> Finding | None:
    """Single frames far from those around them."""
    unsound = unsound_spikes(recording, figure)
    if not unsound.any():
        return None
    local = LocalPoses.of(recording)
    filled = local.filled(unsound)
    turned = np.degrees(angles_between(filled.rotations, local.rotations)) * unsound
    worst = int(np.argmax(turned.max(axis=0)))
    return Finding(
        FindingKind.SPIKE,
        float(turned.max()),
        "°",
        spans(recording, unsound.any(axis=1)),
        recording.bones[worst].name,
        Repairs(mend=(Mend.SPIKES,)),
    )


def flips(recording: Recording, figure: Figure) -> list[tuple[int, int, int]]:
    """Bone, first and last index of frames in which a joint is turned by half a turn."""
    local, found = LocalPoses.of(recording), []
    for b in figure.bones:
        turns = local.rotations[:, b]
        jumps = np.flatnonzero(angles_between(turns[:-1], turns[1:]) > FLIP) + 1
        edges = [*jumps.tolist(), len(turns)]
        for start, end in zip(edges[::2], edges[1::2], strict=False):
            # Of one flip a clip does not tell which side is right: the longer.
            before = end == len(turns) and 2 * start < end
            found.append((b, 0, start - 1) if before else (b, start, end - 1))
    return found


def find_flips(recording: Recording, figure: Figure) -> Finding | None:
    """Joints that turn by half a turn from a frame to the next."""
    found = flips(recording, figure)
    if not found:
        return None
    flipped = np.zeros(len(recording.frames), bool)
    for _, first, last in found:
        flipped[first : last + 1] = True
    name = recording.bones[found[0][0]].name
    remedy = Repairs(mend=(Mend.FLIPS,))
    return Finding(FindingKind.FLIP, 180.0, "°", spans(recording, flipped), name, remedy)


def unflipped(recording: Recording, figure: Figure) -> Recording:
    """With the joints' half turns turned back, about the bone's own axis that fits best."""
    local = LocalPoses.of(recording)
    for b, first, last in flips(recording, figure):
        turns = local.rotations[:, b]
        inside, outside = (first, first - 1) if first > 0 else (last, last + 1)
        turn = rotation_vector(turns[outside].T @ turns[inside])
        half = rotation_matrix(np.pi * turn / np.linalg.norm(turn))
        turns[first : last + 1] = turns[first : last + 1] @ half.T
    return local.posed(recording)


def held_frames(recording: Recording) -> BoolArray:
    """(T,) frames in which a body that moves before and after has the pose of the frame before."""
    steps = _steps(recording)
    turned = np.abs(np.diff(recording.rotations, axis=0)).max(axis=(1, 2, 3))
    still = (steps < HELD) & (turned < HELD)
    out = np.zeros(len(recording.frames), bool)
    for first, last in runs(still):
        inside = first > 0 and last < len(steps) - 1
        short = (last - first + 1) / recording.rate <= LONGEST_HELD
        if inside and short and min(steps[first - 1], steps[last + 1]) > MOVING:
            out[first + 1 : last + 2] = True
    return out


def find_held(recording: Recording) -> Finding | None:
    """Poses that are held, or doubled, amid a movement."""
    held = held_frames(recording)
    if not held.any():
        return None
    remedy = Repairs(mend=(Mend.HELD_FRAMES,))
    count = float(held.sum())
    return Finding(FindingKind.HELD_FRAMES, count, "frames", spans(recording, held), "", remedy)


def find_dropped(recording: Recording) -> Finding | None:
    """Steps of the whole body as long as two to eleven of those beside them: frames are missing."""
    moves = np.diff(recording.heads, axis=0).reshape(len(recording.frames) - 1, -1)
    if len(moves) < 3:
        return None
    usual = 0.5 * (moves[:-2] + moves[2:])
    own = moves[1:-1]
    square = np.maximum(np.einsum("ti,ti->t", usual, usual), 1e-12)
    times = np.einsum("ti,ti->t", own, usual) / square
    rest = np.linalg.norm(own - times[:, None] * usual, axis=1)
    alike = rest < ALIKE * np.linalg.norm(own, axis=1)
    whole = (times - 1.0 > DROPPED[0]) & (times - 1.0 < DROPPED[1])
    fast = np.abs(usual).max(axis=1) > MOVING
    counts = np.zeros(len(recording.frames), int)  # before each frame
    counts[2:-1] = np.where(whole & alike & fast, np.round(times - 1.0), 0)
    after = np.flatnonzero(counts)
    if len(after) == 0:
        return None
    missing = tuple(MissingFrames(round(recording.frames[t - 1]), int(counts[t])) for t in after)
    return Finding(
        FindingKind.DROPPED_FRAMES,
        float(counts.sum()),
        "frames",
        spans(recording, counts > 0),
        remedy=Repairs(missing=missing),
    )


def _steps(recording: Recording) -> FloatArray:
    """(T - 1,) m, by which the joint that moves most does so from a frame to the next."""
    return np.asarray(np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1))


def _single(off: FloatArray, limit: FloatArray) -> BoolArray:
    """(T, B) where `off` is beyond the limit, most among its neighbours, and stands out."""
    around = np.zeros_like(off)
    for shift in (*range(-AROUND, -2), *range(3, AROUND + 1)):
        moved = np.roll(off, shift, axis=0)
        moved[: max(shift, 0)] = 0.0
        moved[len(off) + min(shift, 0) :] = 0.0
        around = np.maximum(around, np.where(moved > limit, 0.0, moved))
    padded = np.pad(off, ((1, 1), (0, 0)))
    most = (off >= padded[:-2]) & (off >= padded[2:])
    return np.asarray(most & (off > limit) & (off > STANDS_OUT * around))


def _returned(steps: FloatArray, over: FloatArray) -> BoolArray:
    """(T, B) where the frames beside are nearer to each other than to the one between them.

    steps: (T - 1, B) from a frame to the next, over: (T - 2, B) to the next but one.
    """
    inner = over < RETURNED * np.minimum(steps[:-1], steps[1:])
    return np.pad(inner, ((1, 1), (0, 0)))
