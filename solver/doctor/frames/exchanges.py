"""Limbs exchanged: for some frames capture takes the left leg for the right one, or the arms.

Where that begins and ends the limbs leap, and do not if each is followed into the other.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ...skeleton.parts import ARM, LEG, Part
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..limbs import Partners, partners
from ..local_poses import spans
from ..repairs import Repairs
from ..slack import SPARSE
from .sides import are_wrong
from .steps import AROUND

# The clavicles go with the trunk.
LIMBS = {Mend.LEGS: LEG, Mend.ARMS: ARM[1:]}
KINDS = {Mend.LEGS: FindingKind.EXCHANGED_LEGS, Mend.ARMS: FindingKind.EXCHANGED_ARMS}
JOINTS = 2  # of a limb that are looked at; hands and feet strike
# How many times a step, of all bones together, is as far off as if the limbs were exchanged at it:
# where capture exchanged them, and where a program did, which is exact. Honest ones, at 20 Hz and
# more, are up to 1.04 and 1.8 times, and do not stand out.
CLEARER = 1.2, 2.0
LEAP = np.radians(3.0)  # that each limb is off
STANDS_OUT = 2.5  # times the median of the steps around
ALIKE = 0.5  # times as far off as if they were exchanged: they may be so unseen
FEWEST = 5  # frames


def find_exchange(recording: Recording, figure: Figure, limbs: Mend) -> Finding | None:
    """Legs, or arms, that are exchanged for some frames."""
    if (told := _exchange(recording, figure, limbs)) is None:
        return None
    pair, where = told
    ways = pair.ways(recording)[:, :, :JOINTS]
    off = _off(ways, ways)[np.diff(where)].max(axis=0)
    return Finding(
        KINDS[limbs],
        float(np.degrees(off.max())),
        "°",
        spans(recording, where),
        recording.bones[pair.bones[:, :JOINTS].flat[np.argmax(off)]].name,
        Repairs(mend=(limbs,)),
    )


def exchanged_back(recording: Recording, figure: Figure, limbs: Mend) -> Recording:
    """With legs, or arms, exchanged where they are found to be."""
    told = _exchange(recording, figure, limbs)
    return recording if told is None else told[0].exchanged(recording, told[1])


def _exchange(
    recording: Recording, figure: Figure, limbs: Mend
) -> tuple[Partners, BoolArray] | None:
    """The limbs, in that way to exchange them after which they leap least, and where (T,)."""
    if len(recording.frames) < FEWEST or recording.rate < SPARSE:
        return None
    seen, told = recording, list[tuple[float, Partners, BoolArray]]()
    if limbs is Mend.ARMS:  # from the chest, for what trembles in the spine is not theirs
        chest = np.swapaxes(recording.rotations[:, figure.of(Part.SPINE)[-1]], -1, -2)
        seen = replace(recording, rotations=chest[:, None] @ recording.rotations)
    for pair, clearer in zip(partners(recording, figure, LIMBS[limbs]), CLEARER, strict=True):
        ways, other = (each[:, :, :JOINTS] for each in (pair.ways(seen), pair.ways_exchanged(seen)))
        straight, crossed = (np.linalg.norm(_off(ways, then), axis=2) for then in (ways, other))
        where = _frames(straight, crossed, clearer)
        if where is not None:
            if are_wrong(recording, pair, limbs, ~where) and not are_wrong(
                recording, pair, limbs, where
            ):
                where = ~where
            told.append((float(crossed[np.diff(where)].max()), pair, where))
    return min(told, key=lambda each: each[0])[1:] if told else None


def _frames(straight: FloatArray, crossed: FloatArray, clearer: float) -> BoolArray | None:
    """(T,) that are exchanged, by how far steps (T - 1, 2) of both limbs are off as they are, and
    as if the limbs were exchanged at them. Whether that is so of what begins and ends at the same
    steps, or of all else, no step tells: it is the fewer. None where steps tell nothing."""
    ratio = np.linalg.norm(straight, axis=1) / np.maximum(np.linalg.norm(crossed, axis=1), 1e-9)
    likelier, leaps = np.minimum(straight, crossed), np.zeros(len(ratio), bool)
    for t in np.flatnonzero((straight > LEAP).all(axis=1) & (ratio > clearer)):
        usual = np.median(likelier[max(t - AROUND, 0) : t + AROUND + 1], axis=0)
        leaps[t] = (straight[t] > STANDS_OUT * usual).all()
    if not leaps.any():
        return None
    inside = np.concatenate([[False], leaps.cumsum() % 2 == 1])
    first, last = np.flatnonzero(leaps)[[0, -1]]
    alike = np.flatnonzero(ratio > ALIKE)
    if ((alike < first - 1) | (alike > last + 1)).any():
        # What leads to an end of the clip may as well end before it, unseen.
        return None if inside[-1] else inside
    return np.asarray(min(inside, ~inside, key=np.count_nonzero))


def _off(ways: FloatArray, then: FloatArray) -> FloatArray:
    """(T - 1, 2, K) rad if small: how far steps from one path (T, 2, K, 3) into another differ from
    the mean of those beside them, on the one before and on the other after."""
    one, other = np.diff(ways, axis=0), np.diff(then, axis=0)
    before, after = np.concatenate([other[1:2], one[:-1]]), np.concatenate([other[1:], one[-2:-1]])
    off = then[1:] - ways[:-1] - 0.5 * (before + after)
    return np.asarray(np.linalg.norm(off, axis=-1))
