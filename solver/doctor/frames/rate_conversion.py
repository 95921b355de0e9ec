"""Frames doubled at a steady beat, as where 24 frames a second were made 30: the clock is right,
but between its beats the body hurries and at each it stops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.interpolation import interpolate
from ..finding import Finding, FindingKind
from ..local_poses import LocalPoses, spans
from ..repairs import Repairs
from .holds import holds, steps_between, still_steps

LONGEST_BEAT = 25  # frames: 24 a second made 25
FEWEST = 4  # beats, and poses that are held amid movement: fewer may fall so by chance


@dataclass(frozen=True)
class Conversion:
    """rate: Hz, before it. repeats: (T,) the frames that repeat the one before."""

    rate: float
    repeats: BoolArray


def conversion(recording: Recording) -> Conversion | None:
    """Of a recording whose held poses are all at one beat, which holds one throughout."""
    found = holds(recording)
    if len(found) < FEWEST:
        return None
    steps = steps_between(recording)
    still, held = still_steps(recording, steps), np.zeros(len(steps), bool)
    for hold in found:
        held[hold.at : hold.at + hold.count] = True
    for beat in range(2, min(LONGEST_BEAT, len(still) // FEWEST) + 1):
        phase = np.arange(len(still)) % beat
        always = np.array([still[phase == each].all() for each in range(beat)])
        repeated = always[phase]
        if always.any() and repeated[held].all():
            rate = recording.rate * float(1.0 - always.mean())
            return Conversion(rate, np.concatenate([[False], repeated]))
    return None


def find_conversion(recording: Recording) -> Finding | None:
    """Frames that are doubled at a steady beat."""
    found = conversion(recording)
    if found is None:
        return None
    where, remedy = spans(recording, found.repeats), Repairs(mend=(Mend.HELD_FRAMES,))
    return Finding(FindingKind.CONVERTED_RATE, found.rate, "fps", where, remedy=remedy)


def evened(recording: Recording, found: Conversion) -> Recording:
    """With its poses at even intervals from the first frame on, and its frames on the curve through
    them: as long, and by the same numbers."""
    local, own = LocalPoses.of(recording), ~found.repeats
    instants = np.arange(own.sum()) * recording.rate / found.rate  # in frames
    at = np.minimum(np.arange(len(own)), instants[-1])  # beyond it a curve runs away
    mixed = interpolate(instants, local.rotations[own], at)
    u, _, vt = np.linalg.svd(mixed)
    return LocalPoses(u @ vt, interpolate(instants, local.heads[own], at)).posed(recording)
