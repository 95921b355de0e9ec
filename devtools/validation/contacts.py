"""Contact times, centre of pressure and friction of each foot against the plates'."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from .filters import resampled
from .fitted import FittedTrial
from .forces import UP, loaded_intervals
from .trials import FEET, GroundForces, Trial

LOADED = 20.0  # N; the plates' files have zero below it
PRESSED = 50.0  # N; below it a plate's centre of pressure is uncertain
LEAST_LOAD = 0.1  # body weights on a foot, from which its friction is told
CHATTER = 0.02  # s; a foot that is unloaded for less has not left
SHORTEST = 0.03  # s, of a foot's contact
MARGIN = 0.01  # s from the ends of the valid seconds, where nothing begins or ends truly


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


def events(fitted: FittedTrial, ours: GroundForces) -> list[Event]:
    """Every touch-down and lift-off that the plates saw within the valid seconds."""
    trial, plates = fitted.trial, fitted.trial.plates
    weight = trial.mass * STANDARD_GRAVITY
    found = []

    def cut_off(time: float) -> bool:
        return not ours.times[0] + MARGIN < time < ours.times[-1] - MARGIN

    for side, foot in enumerate(FEET):
        mine = found_contacts(fitted, foot)
        loaded = ours.feet[:, side, UP] > LOADED / weight
        carried = _joined(loaded_intervals(ours.times, loaded))
        for interval in measured_contacts(plates.times, plates.feet[:, side, UP]):
            by_contact, by_force = _overlapping(interval, mine), _overlapping(interval, carried)
            for end, kind in enumerate(EventKind):
                time = interval[end]
                if trial.valid[0] + MARGIN < time < trial.valid[1] - MARGIN:
                    late = [
                        None if each is None or cut_off(each[end]) else 1000.0 * (each[end] - time)
                        for each in (by_contact, by_force)
                    ]
                    found.append(Event(foot, kind, time, *late))
    return found


def measured_contacts(times: FloatArray, vertical: FloatArray) -> list[tuple[float, float]]:
    """Contacts of one foot by its plate, s: where the force, drawn on from its first samples or
    back from its last, would be zero. Slow plates tell more than their samples so."""
    loaded = vertical > 0.0
    found = _joined(loaded_intervals(times, loaded))
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


def found_contacts(fitted: FittedTrial, foot: str) -> list[tuple[float, float]]:
    """Intervals in which heel or toe of a foot touch by our analysis, in the trial's time, s."""
    spans = sorted(
        (fitted.start + c.start, fitted.start + c.end)
        for c in fitted.fit.schedule.contacts
        if c.point.startswith(foot) and not c.point.endswith("hand")
    )
    return _joined(spans)


def _joined(spans: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Intervals in order, with gaps below CHATTER closed."""
    joined: list[tuple[float, float]] = []
    for start, end in spans:
        if joined and start < joined[-1][1] + CHATTER:
            joined[-1] = joined[-1][0], max(joined[-1][1], end)
        else:
            joined.append((start, end))
    return joined


def _overlapping(
    interval: tuple[float, float], others: list[tuple[float, float]]
) -> tuple[float, float] | None:
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
