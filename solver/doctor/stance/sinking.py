"""Feet below the floor for moments, as where capture by video loses how high the body is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...analysis.performance import Performance, contact_points, perform
from ...arrays import BoolArray, FloatArray
from ...body.character import build_character
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.runs import runs
from ..finding import Finding, FindingKind
from ..repairs import Repairs

SUNK = 0.06  # m below the floor; honest soles go 5 cm below the lowest of uneven ones


def find_sinking(performance: Performance) -> Finding | None:
    """Feet that are for more than a frame deeper than the lowest height on which they stand: a
    moment of it changes neither the floor nor the spread of heights that tells a floating body."""
    depths = _Depths.of(performance)
    if not depths.places:
        return None
    worst = max(depths.places, key=lambda place: depths.deepest[place[0] : place[1] + 1].max())
    deepest = depths.each[:, worst[0] : worst[1] + 1].max(axis=1)
    frames = performance.recording.frames
    spans = tuple((float(frames[first]), float(frames[last])) for first, last in depths.places)
    part, amount = depths.names[int(np.argmax(deepest))], 100.0 * float(deepest.max())
    remedy = Repairs(mend=(Mend.SINKING,))
    return Finding(FindingKind.SINKING, amount, "cm", spans, part, remedy)


def lifted_out(recording: Recording, chosen: Mapping[str, str] | None) -> Recording:
    """With the whole body raised by as much as its deepest sole is below the floor, around where
    that is more than honest ones are. recording: in its right size and time. chosen: bones by parts
    of the body. Raises MissingPart."""
    depths = _Depths.of(perform(recording, build_character(recording, chosen=chosen)))
    if not depths.places:
        return recording
    lift = np.where(depths.around, depths.deepest, 0.0)
    return replace(recording, heads=recording.heads + lift[:, None, None] * [0.0, 0.0, 1.0])


@dataclass(frozen=True)
class _Depths:
    """How far, m, points of feet are below the floor, (P, T), by their names."""

    names: tuple[str, ...]
    each: FloatArray

    @staticmethod
    def of(performance: Performance) -> _Depths:
        points, floor = contact_points(performance)
        feet = {name: p for name, p in points.items() if p.kind.is_of_foot}
        return _Depths(tuple(feet), floor - np.stack([p.track[:, 2] for p in feet.values()]))

    @property
    def deepest(self) -> FloatArray:
        """(T,) m."""
        return np.asarray(self.each.max(axis=0))

    @property
    def places(self) -> list[tuple[int, int]]:
        """The first and last frame of each place in which they sink."""
        return [(a, b) for a, b in runs(self.deepest > SUNK) if a < b]

    @property
    def around(self) -> BoolArray:
        """(T,) these, as far as something is below the floor at all."""
        found = np.zeros(len(self.deepest), bool)
        for first, last in runs(self.deepest > 0.0):
            found[first : last + 1] = any(a <= last and first <= b for a, b in self.places)
        return found
