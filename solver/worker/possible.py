"""What cannot be, found on the recording's splines before the fit takes its seconds."""

from collections.abc import Sequence

import numpy as np

from ..analysis.performance import Performance
from ..constraints.constraint_builder import build_constraints
from ..data.contacts import ContactSchedule
from ..data.problem import MotionProblem
from ..data.status import Status
from ..fitting.fit import Fit, recorded_motion
from ..optimisation.sqp import FeasibleSet
from ..stages.requested import check_forces, check_places, requested, retimed_jumps
from ..transcription.ride import Ride


def stand_in(
    performance: Performance,
    schedule: ContactSchedule,
    *,
    periodic: bool = False,
    rides: Sequence[Ride | None] = (),
) -> Fit:
    """The recording's splines, which stand for the fit. periodic, rides: as of `fit`."""
    guess = recorded_motion(performance, schedule, periodic=periodic, rides=rides)
    outcome = FeasibleSet(guess.transcription, guess.places).outcome(
        guess.x, Status.STALLED, [], np.inf
    )
    return Fit((outcome,), guess.places, performance, schedule)


def check_requested(fit: Fit, problem: MotionProblem) -> None:
    """Everything that can be wrong with a problem, before the fit takes its seconds.

    fit: a stand-in. Raises as `requested`, `build_constraints`, `check_places` and `check_forces`
    do.
    """
    asked = requested(fit, problem)
    build_constraints(problem.requests, asked.context, asked.start.transcription)
    check_places(fit, problem, asked.context, asked.start, asked.fitted, asked.target)
    if not retimed_jumps(problem, asked.context, asked.start, asked.target.places):
        check_forces(problem, asked.context, asked.start, asked.target)
