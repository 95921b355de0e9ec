"""Joints that are turned by half a turn from a frame to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...body.anatomy import Part
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.rotations import angles_between, rotation_matrix, rotation_vector
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..local_poses import LocalPoses, spans
from ..repairs import Repairs
from ..slack import SPARSE

FLIP = np.radians(140.0)  # from a frame to the next; no joint turns so far, but a hand in 1/15 s
COMPARED = 500  # poses of a joint, among which one like any other is


@dataclass(frozen=True)
class Flip:
    """A bone, and the first and the last index of frames in which it is turned by half a turn."""

    bone: int
    first: int
    last: int

    def edges(self, frames: int) -> list[tuple[int, int]]:
        """The outer and the inner index of frames at its beginning and at its end, of so many
        frames: one of both where it reaches an end of the clip."""
        begins, ends = (self.first - 1, self.first), (self.last + 1, self.last)
        return [each for each in (begins, ends) if 0 <= each[0] < frames]


def flips(recording: Recording, local: LocalPoses, figure: Figure) -> list[Flip]:
    """Those of all joints. local: the recording's."""
    found, sparse = list[Flip](), recording.rate < SPARSE
    for b in (b for b, part in figure.parts if not (sparse and part is Part.HAND)):
        turns = local.rotations[:, b]
        jumps = np.flatnonzero(angles_between(turns[:-1], turns[1:]) > FLIP) + 1
        edges = [*jumps.tolist(), len(turns)]
        for start, end in zip(edges[::2], edges[1::2], strict=False):
            # Of one flip a clip does not tell which side is right: the longer.
            before = end == len(turns) and 2 * start < end
            found.append(Flip(b, 0, start - 1) if before else Flip(b, start, end - 1))
    return found


def find_flips(recording: Recording, figure: Figure) -> Finding | None:
    """Joints that turn by half a turn from a frame to the next."""
    found = flips(recording, LocalPoses.of(recording), figure)
    if not found:
        return None
    flipped = np.zeros(len(recording.frames), bool)
    for flip in found:
        flipped[flip.first : flip.last + 1] = True
    name = recording.bones[found[0].bone].name
    remedy = Repairs(mend=(Mend.FLIPS,))
    return Finding(FindingKind.FLIP, 180.0, "°", spans(recording, flipped), name, remedy)


def unflipped(recording: Recording, figure: Figure) -> Recording:
    """With the joints' half turns turned back."""
    local = LocalPoses.of(recording)
    for flip in flips(recording, local, figure):
        turns = local.rotations[:, flip.bone]
        turns[flip.first : flip.last + 1] = _turned_back(turns, flip)
    return local.posed(recording)


def _turned_back(turns: FloatArray, flip: Flip) -> FloatArray:
    """(N, 3, 3) the frames of a flip, of a bone's turns (T, 3, 3) in its parent, without it.

    The last of a bone's Euler angles turns about an axis of its own, the first about one of its
    parent's, which is the same at both edges. An angle between these turns about one that goes from
    what it is at one edge to what it is at the other.
    """
    edges, inside = flip.edges(len(turns)), turns[flip.first : flip.last + 1]
    of_parent = np.array([_axis(turns, *edge) for edge in edges])
    own = np.array([turns[at].T @ axis for (_, at), axis in zip(edges, of_parent, strict=True)])
    about_parent = _half_turns(of_parent, len(inside)) @ inside
    about_own = inside @ _half_turns(own, len(inside))
    if len(edges) == 1:  # both fit it: a limb bends as it does outside
        outside = np.delete(turns, np.s_[flip.first : flip.last + 1], axis=0)
        parents = _likeness(about_parent, outside) > _likeness(about_own, outside)
    else:
        parents = abs(of_parent[0] @ of_parent[1]) > abs(own[0] @ own[1])
    return np.asarray(about_parent if parents else about_own)


def _likeness(turns: FloatArray, others: FloatArray) -> float:
    """How near rotations (N, 3, 3) are to that of others (M, 3, 3) that is nearest to each."""
    few = others[:: 1 + len(others) // COMPARED]
    return float((turns.reshape(-1, 9) @ few.reshape(-1, 9).T).max(axis=1).sum())


def _axis(turns: FloatArray, outer: int, inner: int) -> FloatArray:
    """(3,) unit, of the half turn between two frames, as the parent sees it: from where the bone
    would have gone on to."""
    before = min(max(2 * outer - inner, 0), len(turns) - 1)
    if angles_between(turns[before], turns[outer]) > FLIP:  # it is in another flip
        before = outer
    expected = turns[outer] @ turns[before].T @ turns[outer]
    turn = rotation_vector(turns[inner] @ expected.T)
    return np.asarray(turn / np.linalg.norm(turn))


def _half_turns(axes: FloatArray, count: int) -> FloatArray:
    """(count, 3, 3) about axes from the first to the last of these (1 or 2, 3), whose sign means
    nothing."""
    first, last = axes[0], axes[-1] * (1.0 if axes[0] @ axes[-1] >= 0.0 else -1.0)
    way = np.linspace(first, last, count)
    return rotation_matrix(np.pi * way / np.linalg.norm(way, axis=1, keepdims=True))
