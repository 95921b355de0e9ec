"""Durations as unknowns of a least-change problem (thesis 4.4, with flights' durations unknown).

Who jumps further flies longer. Which duration goes with a moved landing is what the least change of
*pose* tells: with s the logarithms of the flights' durations over the present ones, find

    min  1/2 (x - x0)' W (x - x0)   subject to   C(x, s) = 0

x0: the motion carried to its new places. W: the distance between poses at the same phase, since
control points keep their place in their phase while a phase stretches. People jump further by a
longer push, not by the same forces, so that forces hardly count in W. The few
durations border the banded matrix of a step: with D = dx/ds on the linearised rows, from the factor
that is there, their Schur complement is D' W D (Nocedal & Wright, 16.2). Where nothing is moved
x = x0, s = 0 is the solution exactly.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Interval
from ..data.timeline import Stretch, TimeWarp
from ..numerics.block_banded import BlockBanded
from ..optimisation.kkt_step import LinearisedProblem
from ..optimisation.sqp import FeasibleSet
from ..transcription.motion import Motion
from ..transcription.tracking_cost import CostWeights
from .fit import motion_metric

# As in an adaptation, but for forces and the centre of mass: they settle what no pose shows.
POSE_COST_WEIGHTS = CostWeights(shape=1.0, com=1e-4, acceleration_time=0.1, force=1e-5)
DERIVATIVE_STEP = 1e-4  # of s, of the finite differences of the rows
PROBE = 0.03  # of s, for which D is taken: a step with its bounds is only piecewise linear in it
MAX_STEP = 0.3  # of s in one step
MIN_STEP = 0.01  # of s: some milliseconds of a flight; the next step would change it by far less
MAX_STEPS = 4
MAX_RATIO = 0.5  # of the violation, left at the end; the solve proper does the rest


@dataclass(frozen=True)
class TimedMotion:
    """A motion with the stretches of time that it was found with."""

    motion: Motion
    stretches: tuple[Stretch, ...]


def find_durations(
    start: Motion, reference: FloatArray, places: FloatArray, flights: Sequence[Interval]
) -> TimedMotion | None:
    """Durations of flights for contacts at other places, and the motion that goes with them.

    start: a motion that obeys physics. reference: x0 (K, n_block), of the same transcription,
    carried to places (n_contacts, 3) m. None where no such motion is found.
    """
    problem = _BorderedProblem(start, places, tuple(flights))
    metric = motion_metric(start, POSE_COST_WEIGHTS)
    x, s = reference, np.zeros(len(flights))
    feasible = problem.feasible(s)
    linearised = feasible.linearise(feasible.rows(x), metric)
    before = linearised.violation(feasible.values(x))
    for _ in range(MAX_STEPS):
        value = problem.feasible(s).values(x)
        slope = problem.derivatives(x, s, value)
        gradient = metric.times(x - reference)
        change = _change(linearised, metric, value, slope, gradient)
        s = s + change
        x = x + linearised.step(problem.feasible(s).values(x), gradient)[0]
        if np.abs(change).max() < MIN_STEP:
            break
    feasible = problem.feasible(s)
    if not linearised.violation(feasible.values(x)) < MAX_RATIO * before:
        return None
    return TimedMotion(feasible.motion(x), problem.stretches(s))


def _change(
    linearised: LinearisedProblem,
    metric: BlockBanded,
    value: FloatArray,
    slope: FloatArray,
    gradient: FloatArray,
) -> FloatArray:
    """(n,) change of s, of the linearised problem.

    value: (R,) of the rows. slope: (R, n) by s. gradient: W (x - x0), (K, n_block).
    """
    still = linearised.step(value, gradient)[0]
    moves = [
        (linearised.step(value + PROBE * column, gradient)[0] - still) / PROBE for column in slope.T
    ]
    pulls = [metric.times(move) for move in moves]
    schur = np.array([[float((pull * move).sum()) for move in moves] for pull in pulls])
    slopes = [
        float((gradient * move).sum() + (pull * still).sum())
        for move, pull in zip(moves, pulls, strict=True)
    ]
    change = -np.linalg.solve(schur, np.array(slopes))
    return np.clip(change, -MAX_STEP, MAX_STEP)


@dataclass(frozen=True)
class _BorderedProblem:
    """Rows by unknowns and durations."""

    start: Motion
    places: FloatArray
    flights: tuple[Interval, ...]

    def stretches(self, s: FloatArray) -> tuple[Stretch, ...]:
        return tuple(
            Stretch(f.start, f.end, float(k)) for f, k in zip(self.flights, np.exp(s), strict=True)
        )

    def feasible(self, s: FloatArray) -> FeasibleSet:
        """The feasible set of these durations."""
        warp = TimeWarp.of(self.stretches(s), self.start.duration)
        return FeasibleSet(self.start.transcription.retimed(warp), self.places)

    def derivatives(self, x: FloatArray, s: FloatArray, value: FloatArray) -> FloatArray:
        """(R, n) derivatives of the rows' values (R,) by the durations."""
        ahead = [self.feasible(s + DERIVATIVE_STEP * unit).values(x) for unit in np.eye(len(s))]
        return np.stack([(each - value) / DERIVATIVE_STEP for each in ahead], axis=1)
