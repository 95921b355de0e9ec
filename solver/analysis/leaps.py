"""How far and how high the flights of a clip go, as recorded and as its pins ask."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Phase, PhaseKind

TOGETHER = 0.15  # s, in which the points of a take-off leave, and those of a landing come down
PUSH_OFF = 0.6  # s; before it a jump from standing has no speed yet


@dataclass(frozen=True)
class Stand:
    """When a contact stands, s, and where: (3,) m, world, as recorded and as asked for."""

    start: float
    end: float
    recorded: FloatArray
    asked: FloatArray


@dataclass(frozen=True)
class Leap:
    """A flight from one ground phase to another, by their names.

    recorded, asked: (3,) m, from where the feet leave to where they land. run_up: m/s, level, of
    the figure before it pushes off.
    """

    take_off: str
    landing: str
    recorded: FloatArray
    asked: FloatArray
    run_up: float


def leaps(
    phases: Sequence[Phase], stands: Iterable[Stand], times: FloatArray, heads: FloatArray
) -> list[Leap]:
    """The flights between two stances. times: (T,) s. heads: (T, bones, 3) m, world."""
    stands, found = list(stands), []
    speed = np.linalg.norm(np.gradient(heads.mean(axis=1)[:, :2], times, axis=0), axis=1)
    for before, flight, after in zip(phases, phases[1:], phases[2:], strict=False):
        left = [s for s in stands if flight.start - TOGETHER < s.end <= flight.start + TOGETHER]
        come = [s for s in stands if flight.end - TOGETHER <= s.start < flight.end + TOGETHER]
        if flight.kind is not PhaseKind.FLIGHT or not (left and come):
            continue
        recorded = _middle(s.recorded for s in come) - _middle(s.recorded for s in left)
        asked = _middle(s.asked for s in come) - _middle(s.asked for s in left)
        run_up = np.interp(max(before.start, before.end - PUSH_OFF), times, speed)
        found.append(Leap(before.name, after.name, recorded, asked, float(run_up)))
    return found


def _middle(places: Iterable[FloatArray]) -> FloatArray:
    return np.asarray(np.mean(list(places), axis=0))
