"""Damages together, as video capture has them: each is told in spite of the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...solver.data.recording import Recording
from .damages.damage import Damage, Damaged
from .damages.every import DAMAGES
from .damages.poses import noisy
from .damages.whole_body import in_place, levelled, sliding


def both(first: Damage, second: Damage) -> Damage:
    """One damage and then the other, which leaves the frames as they are."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        damaged = first.do(recording, rng)
        return replace(damaged, recording=second.do(damaged.recording, rng).recording)

    also = (*first.also, second.kind, *second.also)
    return Damage(f"{first.name}, {second.name}", first.kind, do, also)


ALONE_AND_COMBINED = (
    *DAMAGES,
    both(noisy(3.0, 1.0), sliding(0.2)),
    both(levelled(), in_place()),
    both(noisy(3.0, 1.0), levelled()),
)
