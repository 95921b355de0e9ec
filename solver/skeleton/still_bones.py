"""Bones of the trunk that do not move against each other: one body, whatever a rig cuts it into.

Rigs cut spine and neck into one to seven bones. Where a recording never bends two of them against
each other, there is no joint: a solver that had one there would bend what the performer does not,
and on each rig differently.
"""

from collections.abc import Sequence

import numpy as np

from ..data.recording import Recording
from ..numerics.rotations import mean_rotation, rotation_vector
from .parts import Part, Segment

# What a trunk has in any case, still or not: the loins, the back and the chest, and a neck.
TRUNK = {Part.SPINE: 3, Part.NECK: 1}
STILL = np.radians(0.5)  # a bone turns less against the one below it; no one sees it


def without_still(
    recording: Recording, segments: Sequence[Segment]
) -> tuple[tuple[Segment, ...], tuple[tuple[str, str], ...]]:
    """Segments, parents first, without the bones that are one body with the bone below them.

    And these: their bone's name, and that of the bone whose body they belong to.
    """
    kept, joined = list(segments), dict[str, str]()
    names = [bone.name for bone in recording.bones]
    for part, fewest in TRUNK.items():
        chain = [segment for segment in kept if segment.part is part]
        for upper in chain[:0:-1]:
            if sum(segment.part is part for segment in kept) <= fewest:
                break
            lower = chain[chain.index(upper) - 1]
            if _is_still(recording, lower.bone, upper.bone):
                kept.remove(upper)
                joined[names[upper.bone]] = names[lower.bone]
    return tuple(kept), tuple((bone, _last(joined, bone)) for bone in joined)


def _is_still(recording: Recording, lower: int, upper: int) -> bool:
    """Whether a bone keeps its rotation against another throughout."""
    turned = np.swapaxes(recording.rotations[:, lower], 1, 2) @ recording.rotations[:, upper]
    off = rotation_vector(mean_rotation(turned).T @ turned)
    return bool(np.linalg.norm(off, axis=1).max() < STILL)


def _last(joined: dict[str, str], bone: str) -> str:
    while bone in joined:
        bone = joined[bone]
    return bone
