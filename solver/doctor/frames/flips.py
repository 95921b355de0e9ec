"""Joints that are turned by half a turn from a frame to the next."""

from __future__ import annotations

import numpy as np

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


def flips(recording: Recording, figure: Figure) -> list[tuple[int, int, int]]:
    """Bone, first and last index of frames in which a joint is turned by half a turn."""
    local, found = LocalPoses.of(recording), []
    sparse = recording.rate < SPARSE
    for b in (b for b, part in figure.parts if not (sparse and part is Part.HAND)):
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
