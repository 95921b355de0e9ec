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
ON_IT = 0.03  # m from the floor, of a foot that is on it all the while: then the other one is wrong


def find_sinking(performance: Performance) -> Finding | None:
    """Feet that are for more than a frame deeper than the lowest height on which they stand: a
    moment of it changes neither the floor nor the spread of heights that tells a floating body."""
    depths = _Depths.of(performance)
    places = [(a, b) for a, b in runs(depths.deepest > SUNK) if a < b]
    if not places:
        return None
    worst = max(places, key=lambda place: depths.deepest[place[0] : place[1] + 1].max())
    deepest = depths.each[:, worst[0] : worst[1] + 1].max(axis=1)
    frames = performance.recording.frames
    spans = tuple((float(frames[first]), float(frames[last])) for first, last in places)
    part, amount = depths.names[int(np.argmax(deepest))], 100.0 * float(deepest.max())
    lifted = all(depths.lifted[first : last + 1].all() for first, last in places)
    remedy = Repairs(mend=(Mend.SINKING,)) if lifted else None
    return Finding(FindingKind.SINKING, amount, "cm", spans, part, remedy)


def lifted_out(recording: Recording, chosen: Mapping[str, str] | None) -> Recording:
    """With the whole body raised by as much as its deepest sole is below the floor, around where
    that is more than honest ones are; not where the other foot stands on it. recording: in its
    right size and time. chosen: bones by parts of the body. Raises MissingPart."""
    depths = _Depths.of(perform(recording, build_character(recording, chosen=chosen)))
    lift = np.where(depths.lifted, depths.deepest, 0.0)
    return replace(recording, heads=recording.heads + lift[:, None, None] * [0.0, 0.0, 1.0])


@dataclass(frozen=True)
class _Depths:
    """How far, m, points of feet are below the floor, (P, T), by their names, the deepest, (T,),
    and where with the whole body they are raised, (T,)."""

    names: tuple[str, ...]
    each: FloatArray
    deepest: FloatArray
    lifted: BoolArray

    @staticmethod
    def of(performance: Performance) -> _Depths:
        points, floor = contact_points(performance)
        feet = {name: p for name, p in points.items() if p.kind.is_of_foot}
        each = floor - np.stack([p.track[:, 2] for p in feet.values()])
        sides = np.array([name.split()[0] for name in feet])
        foot = np.stack([each[sides == side].max(axis=0) for side in dict.fromkeys(sides)])
        deepest, other = foot.max(axis=0), foot.min(axis=0)
        lifted = np.zeros(len(deepest), bool)
        for first, last in runs(deepest > 0.0):
            around = slice(first, last + 1)
            sunk = deepest[around] > SUNK
            on_it = np.abs(other[around][sunk]) < ON_IT
            lifted[around] = sunk.sum() > 1 and not on_it.all()
        return _Depths(tuple(feet), each, deepest, lifted)
