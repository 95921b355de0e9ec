"""Contact times, centre of pressure and friction of each foot against the plates'."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ..filters import resampled
from .forces import UP, loaded_intervals
from .trials import FEET, GroundForces, Trial

LOADED = 20.0  # N; the plates' files have zero below it
PRESSED = 50.0  # N; below it a plate's centre of pressure is uncertain
LEAST_LOAD = 0.1  # body weights on a foot, from which its friction is told
CHATTER = 0.02  # s; a foot that is unloaded for less has not left
SHORTEST = 0.03  # s, of a foot's contact
MARGIN = 0.01  # s from the ends of the valid seconds, where nothing begins or ends truly

Spans = list[tuple[float, float]]  # s, first and last instant of each


class EventKind(Enum):
    """Begin or end of a foot's contact."""

    TOUCH_DOWN = "touch-down"
    LIFT_OFF = "lift-off"


@dataclass(frozen=True)
class Event:
    """A foot's touch-down or lift-off by the plates, s, and how much later ours is, ms.

    late_ms: of the contacts found; force_late_ms: of when the fit's force passes 20 N. None where
    ours has no such event: no contact then, or one that the clip's end cuts off.
    """

    foot: str
    kind: EventKind
    time: float
    late_ms: float | None
    force_late_ms: float | None


@dataclass(frozen=True)
class Pressure:
    """Distance of ours from the plates' centre of pressure, cm: weighted by force."""

    distance_cm: float
    forward_cm: float
    left_cm: float


@dataclass(frozen=True)
class Friction:
    """Tangential over vertical force of a foot that carries more than 0.1 body weights."""

    largest: float
    largest_95: float  # percentile


def events(trial: Trial, ours: GroundForces, found: Sequence[Spans]) -> list[Event]:
    """Every touch-down and lift-off that the plates saw within the valid seconds.

    found: of each foot, when it touches by our analysis.
    """
    plates, least = trial.plates, LOADED / (trial.mass * STANDARD_GRAVITY)
    begun = []

    def late(mine: tuple[float, float] | None, end: int, time: float) -> float | None:
        if mine is None or not ours.times[0] + MARGIN < mine[end] < ours.times[-1] - MARGIN:
            return None
        return 1000.0 * (mine[end] - time)

    for side, foot in enumerate(FEET):
        carried = joined(loaded_intervals(ours.times, ours.feet[:, side, UP] > least))
        for interval in measured_contacts(plates.times, plates.feet[:, side, UP]):
            by_contact, by_force = (_overlapping(interval, x) for x in (found[side], carried))
            for end, kind in enumerate(EventKind):
                time = interval[end]
                if trial.valid[0] + MARGIN < time < trial.valid[1] - MARGIN:
                    begun.append(
                        Event(
                            foot, kind, time, late(by_contact, end, time), late(by_force, end, time)
                        )
                    )
    return begun


def measured_contacts(times: FloatArray, vertical: FloatArray) -> Spans:
    """Contacts of one foot by its plate, s: where the force, drawn on from its first samples or
    back from its last, would be zero. Slow plates tell more than their samples so."""
    loaded = vertical > 0.0
    found = joined(loaded_intervals(times, loaded))
    return [
        (_zero_before(times, vertical, start), -_zero_before(-times[::-1], vertical[::-1], -end))
        for start, end in found
        if end - start >= SHORTEST
    ]


def _zero_before(times: FloatArray, vertical: FloatArray, first: float) -> float:
    """At most one sample before the first loaded one, s."""
    at = int(np.searchsorted(times, first - 1e-9))
    if at == 0:
        return first
    step = times[at] - times[at - 1]
    rise = max(vertical[at + 1] - vertical[at], 1e-9)
    return float(first - step * min(vertical[at] / rise, 1.0))


def joined(spans: Spans) -> Spans:
    """Intervals in order, with gaps below CHATTER closed."""
    kept: Spans = []
    for start, end in spans:
        if kept and start < kept[-1][1] + CHATTER:
            kept[-1] = kept[-1][0], max(kept[-1][1], end)
        else:
            kept.append((start, end))
    return kept


def _overlapping(interval: tuple[float, float], others: Spans) -> tuple[float, float] | None:
    """The one that shares the most time with an interval, None where none does."""
    shared = [min(interval[1], o[1]) - max(interval[0], o[0]) for o in others]
    return others[int(np.argmax(shared))] if shared and max(shared) > 0.0 else None


def pressure(trial: Trial, ours: GroundForces) -> Pressure | None:
    """Over the instants of ours at which both sides press one foot; None where there are none."""
    plates, least = trial.plates, PRESSED / (trial.mass * STANDARD_GRAVITY)
    carried = resampled(plates.times, plates.feet[..., UP], ours.times)
    pressed = plates.feet[..., UP] > least
    both = resampled(plates.times, pressed.astype(float), ours.times) > 1.0 - 1e-9
    both &= (ours.feet[..., UP] > least) & _compared(trial, ours)[:, None]
    if not both.any():
        return None
    apart = (ours.pressure - resampled(plates.times, plates.pressure, ours.times))[both]
    weights = carried[both] / carried[both].sum()
    forward, left = (weights @ apart).tolist()
    distance = float(weights @ np.linalg.norm(apart, axis=1))
    return Pressure(100.0 * distance, 100.0 * forward, 100.0 * left)


def friction(trial: Trial, forces: GroundForces) -> Friction:
    """Of either foot, within the compared seconds."""
    vertical = forces.feet[..., UP]
    loaded = (vertical > LEAST_LOAD) & _compared(trial, forces)[:, None]
    if not loaded.any():
        return Friction(0.0, 0.0)
    used = np.linalg.norm(forces.feet[..., :UP], axis=-1)[loaded] / vertical[loaded]
    return Friction(float(used.max()), float(np.percentile(used, 95)))


def _compared(trial: Trial, forces: GroundForces) -> BoolArray:
    start, end = trial.compared
    return np.asarray((forces.times >= start) & (forces.times <= end))
