"""The jump's own frame: the feet's take-off place is its origin, their landing lies ahead."""

from dataclasses import dataclass

import numpy as np

from ...solver.analysis.performance import Performance
from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part, Side
from ...solver.data.constants import UP
from ...solver.data.contacts import ContactSchedule, Phase, PhaseKind

BEFORE, AFTER = (-0.3, -0.05), (0.1, 0.35)  # s from take-off, from landing: the feet stand still
LEVEL = 0.03  # m; a smaller step up or down is the recording's noise on a level floor


@dataclass(frozen=True)
class JumpFrame:
    """Frame of a jump: origin (3,) m and axes (3, 3) with columns forward, left, up, world.

    landing: (3,) m, of the feet, in the frame; (distance, 0, step).
    """

    origin: FloatArray
    axes: FloatArray
    landing: FloatArray

    def of(self, points: FloatArray) -> FloatArray:
        """Points (..., 3) m, world, in this frame."""
        return np.asarray((points - self.origin) @ self.axes)

    def offset_to(self, other: "JumpFrame") -> FloatArray:
        """(3,) m, world: how far this jump's landing must move to be where the other's is."""
        return np.asarray(self.axes @ (other.landing - self.landing))


def longest_flight(schedule: ContactSchedule) -> Phase:
    """The flight that is the jump. Raises ValueError where there is none."""
    flights = [p for p in schedule.phases if p.kind is PhaseKind.FLIGHT]
    return max(flights, key=lambda p: p.end - p.start)


def landing_phase(schedule: ContactSchedule, flight: Phase) -> str:
    """The name of the ground phase after a flight. Raises StopIteration where there is none."""
    return next(p.name for p in schedule.phases if abs(p.start - flight.end) < 1e-9)


def jump_frame(performance: Performance, schedule: ContactSchedule) -> JumpFrame:
    """Frame of the longest flight, its origin on the floor.

    The feet's place is that of their balls: the mean over time of their middle while they stand.
    """
    flight = longest_flight(schedule)
    feet = [_ball(performance, side) for side in (Side.LEFT, Side.RIGHT)]
    middle = 0.5 * (feet[0] + feet[1])
    start = _standing(performance.times - flight.start, middle, BEFORE)
    moved = _standing(performance.times - flight.end, middle, AFTER) - start
    distance = float(np.hypot(*moved[:2]))
    step = float(moved[2]) if abs(moved[2]) > LEVEL else 0.0
    ahead = np.array([moved[0], moved[1], 0.0]) / distance
    origin = np.array([start[0], start[1], schedule.floor_m])
    axes = np.stack([ahead, np.cross(UP, ahead), UP], axis=1)
    return JumpFrame(origin, axes, np.array([distance, 0.0, step]))


def _ball(performance: Performance, side: Side) -> FloatArray:
    """(T, 3) m: the ball of a foot; its tip where the figure has no toes."""
    character = performance.character
    toe, foot = (character.body(part, side) for part in (Part.TOE, Part.FOOT))
    if toe is not None:
        return performance.centres[:, toe]
    assert foot is not None
    tip = performance.rotations[:, foot] @ character.bodies[foot].tip
    return np.asarray(performance.centres[:, foot] + tip)


def _standing(times: FloatArray, place: FloatArray, span: tuple[float, float]) -> FloatArray:
    inside = (times >= span[0]) & (times <= span[1])
    return np.asarray(np.mean(place[inside], axis=0))
