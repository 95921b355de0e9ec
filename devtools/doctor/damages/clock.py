"""Durations and frames: played at a wrong speed, frames held, put in or left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....solver.analysis.performance import perform
from ....solver.arrays import IntArray
from ....solver.body.character import build_character
from ....solver.data.recording import Recording
from ....solver.doctor.falls import each_fall
from ....solver.doctor.finding import FindingKind
from ....solver.doctor.retimed import LONG
from .damage import Damage, Damaged, at_rate

AROUND = 6  # frames about a flight, that are retimed with it


def slowed(factor: float) -> Damage:
    """Played too slowly, or where the factor is below 1 too fast."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        return Damaged(replace(recording, times=factor * recording.times), recording, factor)

    return Damage(f"time × {factor:g}", FindingKind.TIME_SCALE, do)


def ramped(factor: float) -> Damage:
    """A flight, of several, with some frames around it, played too slowly, or too fast."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        flights = _long_flights(recording)
        first, last = flights[int(rng.integers(len(flights)))]
        inside = (recording.frames >= first - AROUND) & (recording.frames < last + AROUND)
        steps = np.diff(recording.times) * np.where(inside[:-1], factor, 1.0)
        times = np.concatenate([[0.0], np.cumsum(steps)])
        return Damaged(at_rate(replace(recording, times=times), recording.rate), recording)

    name = f"a flight's time × {factor:.2g}"
    return Damage(name, FindingKind.RETIMED, do, possible=lambda r: len(_long_flights(r)) > 1)


def _long_flights(recording: Recording) -> list[tuple[float, float]]:
    """First and last scene frames of those that tell a clock."""
    found, spans = each_fall(perform(recording, build_character(recording)))
    return [span for span, (_, seconds) in zip(spans, found, strict=True) if seconds > LONG]


def held(count: int) -> Damage:
    """Single frames dropped, the one before held in their place."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        for frame in _moving(recording, rng, count):
            rotations[frame], heads[frame] = rotations[frame - 1], heads[frame - 1]
        return Damaged(replace(recording, rotations=rotations, heads=heads), recording)

    return Damage(f"{count} frames held", FindingKind.HELD_FRAMES, do)


def frozen(seconds: float, *, repeated: bool = False) -> Damage:
    """A pose that is held amid fast movement: over others, or by frames that are put in."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        count = round(seconds * recording.rate)
        moving = _moving(recording, rng, len(recording.frames))
        at = next(t for t in moving if t + count + 4 < len(recording.frames))
        if repeated:
            rows = np.insert(np.arange(len(recording.frames)), at, np.full(count, at))
        else:
            rows = np.arange(len(recording.frames))
            rows[at + 1 : at + count + 1] = at
        index = np.arange(len(rows))
        damaged = replace(
            recording,
            frames=recording.frames[0] + index,
            times=index / recording.rate,
            heads=recording.heads[rows],
            rotations=recording.rotations[rows],
        )
        return Damaged(damaged, recording)

    kind = FindingKind.REPEATED_FRAMES if repeated else FindingKind.HELD_FRAMES
    what = "put in" if repeated else "held"
    return Damage(f"a pose {what} for {seconds:g} s", kind, do)


def converted(rate: float, to: float) -> Damage:
    """Sampled at a rate, Hz, and played at a higher one by repeating frames at a steady beat."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        slow, original = at_rate(recording, rate), at_rate(recording, to)
        rows = (np.arange(len(original.frames)) * rate / to + 1e-9).astype(int)
        rotations, heads = slow.rotations[rows], slow.heads[rows]
        return Damaged(replace(original, rotations=rotations, heads=heads), original)

    return Damage(f"{rate:g} Hz made {to:g}", FindingKind.CONVERTED_RATE, do)


def dropped(count: int) -> Damage:
    """Single frames missing, so that the rest comes earlier."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        gone = set(_moving(recording, rng, count))
        keep = np.array([t for t in range(len(recording.frames)) if t not in gone])
        return _without(recording, keep)

    return Damage(f"{count} frames missing", FindingKind.DROPPED_FRAMES, do)


def gap(count: int, every: int = 1) -> Damage:
    """Frames missing in one place, as where capture stalls. every: 2 of every second one."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        moving = _moving(recording, rng, len(recording.frames))
        at = next(t for t in moving if t + every * count + 4 < len(recording.frames))
        gone = slice(at, at + every * count, every)
        return _without(recording, np.delete(np.arange(len(recording.frames)), gone))

    where = "in a row" if every == 1 else f"{every} apart"
    return Damage(f"{count} frames missing {where}", FindingKind.DROPPED_FRAMES, do)


def _without(recording: Recording, keep: IntArray) -> Damaged:
    """With some frames alone, so that the rest comes earlier."""
    size = len(keep)
    less = replace(
        recording,
        frames=recording.frames[:size],
        times=recording.times[:size],
        heads=recording.heads[keep],
        rotations=recording.rotations[keep],
    )
    return Damaged(less, recording)


def _moving(recording: Recording, rng: np.random.Generator, count: int) -> list[int]:
    """Frames amid fast movement, apart from each other."""
    steps = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1)
    fast = np.flatnonzero(steps > np.median(steps))
    fast = fast[(fast > 4) & (fast < len(steps) - 4)]
    found: list[int] = []
    for frame in rng.permutation(fast).tolist():
        if len(found) < count and all(abs(frame - other) > 4 for other in found):
            found.append(frame)
    return found
