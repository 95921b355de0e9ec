"""Retargeting of a recording to other bone lengths (thesis 6.2).

A bone is stretched along itself: a point of it moves by its share of the way from head to tail,
what hangs on it moves with the place where it hangs.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.faults import NotAboveZero, UnknownBone
from ..data.recording import Bone, Recording
from ..data.requests import LimbChange


def changed_recording(recording: Recording, limbs: tuple[LimbChange, ...]) -> Recording:
    """The recording on a skeleton of other bone lengths, with the same rotations.

    Factors multiply where several changes name a bone. The roots' heads keep their tracks; what a
    bone slides against its parent in the recording it still does. Raises UnknownBone, NotAboveZero.
    """
    longer = _elongations(recording, limbs)
    bones, moved = list(recording.bones), np.zeros_like(recording.heads)
    rest = np.zeros((len(bones), 3))
    for b, bone in enumerate(recording.bones):
        if bone.parent >= 0:
            parent = recording.bones[bone.parent]
            shift = axial_fraction(parent, bone.head) * longer[bone.parent]
            turn = recording.rotations[:, bone.parent] @ parent.rotation.T
            rest[b] = rest[bone.parent] + shift
            moved[:, b] = moved[:, bone.parent] + turn @ shift
        bones[b] = replace(bone, head=bone.head + rest[b], tail=bone.tail + rest[b] + longer[b])
    return replace(recording, bones=tuple(bones), heads=recording.heads + moved)


def axial_fraction(bone: Bone, point: FloatArray) -> float:
    """Fraction of a bone at which a rest point (3,) projects: clamped to 0 (head) and 1 (tail).

    0 for a bone of no length.
    """
    span = bone.tail - bone.head
    square = float(span @ span)
    return float(np.clip((point - bone.head) @ span / square, 0.0, 1.0)) if square > 0.0 else 0.0


def _elongations(recording: Recording, limbs: Sequence[LimbChange]) -> FloatArray:
    """(B, 3) elongation of each bone at rest, m, world."""
    factors = limb_factors(recording, limbs, lambda limb: limb.length)
    spans = np.stack([bone.tail - bone.head for bone in recording.bones])
    return np.asarray((factors - 1.0)[:, None] * spans)


def limb_factors(
    recording: Recording, limbs: Sequence[LimbChange], of: Callable[[LimbChange], float]
) -> FloatArray:
    """(B,) product of the limbs' factors, bone by bone. Raises UnknownBone, NotAboveZero."""
    factors = np.ones(len(recording.bones))
    for limb in limbs:
        for bone in limb.bones:
            factors[bone_index(recording, limb.name, bone)] *= require_positive(limb.name, of(limb))
    return factors


def bone_index(recording: Recording, request: str, bone: str) -> int:
    """A bone's index. Raises UnknownBone."""
    try:
        return recording.index(bone)
    except KeyError:
        raise UnknownBone(request, bone) from None


def require_positive(request: str, amount: float) -> float:
    """The amount, if positive. Raises NotAboveZero."""
    if not amount > 0.0:
        raise NotAboveZero(request, amount)
    return amount
