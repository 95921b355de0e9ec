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

from ..analysis.timeline import Stretch, TimeWarp
from ..arrays import FloatArray
from ..data.contacts import Interval
from ..numerics.block_banded import BlockBanded
from ..optimisation.kkt_step import LinearisedProblem
from ..optimisation.sqp import FeasibleSet
from ..transcription.motion import Motion
from ..transcription.rows import Rows
from .fit import LinearisedPoses

DERIVATIVE_STEP = 1e-4  # of s, of the finite differences of the rows
PROBE = 0.03  # of s, for which D is taken: a step with its bounds is only piecewise linear in it
MAX_STEP = 0.3  # of s in one step
MIN_STEP = 0.01  # of s: some milliseconds of a flight; the next step would change it by far less
MAX_STEPS = 4
MAX_RATIO = 0.5  # of the violation, left at the end; the solve proper does the rest
DIVERGED = 10.0  # times the violation, from where no step has come back


@dataclass(frozen=True)
class TimedMotion:
    """A motion with the stretches of time that it was found with."""

    motion: Motion
    stretches: tuple[Stretch, ...]


def find_durations(
    start: LinearisedPoses, reference: FloatArray, places: FloatArray, flights: Sequence[Interval]
) -> TimedMotion | None:
    """Durations of flights for contacts at other places, and the motion that goes with them.

    start: what it violates is let be. reference: x0 (K, n_block), of the same transcription,
    carried to places (n_contacts, 3) m. None where no such motion is found.
    """
    metric, linearised = start.metric, start.unpriced
    problem = _BorderedProblem(start.motion, linearised.rows, places, tuple(flights))
    x, s = reference, np.zeros(len(flights))
    value = problem.values(x, s)
    before = linearised.violation(value)
    for steps in range(1, MAX_STEPS + 1):
        gradient = metric.times(x - reference)
        step, change = _step(linearised, metric, problem, (x, s), value, gradient)
        x, s = x + step, s + change
        value = problem.values(x, s)
        settled = steps > 1 and np.abs(change).max() < MIN_STEP
        if settled or not linearised.violation(value) < DIVERGED * before:
            break
    if not linearised.violation(value) < MAX_RATIO * before:
        return None
    # By metres alone the least change twirls a neck by 70 degrees at the end of a clip.
    x = reference + start.priced.step(problem.values(reference, s))[0]
    return TimedMotion(problem.feasible(s).motion(x), problem.stretches(s))


def _step(
    linearised: LinearisedProblem,
    metric: BlockBanded,
    problem: "_BorderedProblem",
    at: tuple[FloatArray, FloatArray],
    value: FloatArray,
    gradient: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Step of x (K, n_block) and s (n,) from `at`. value: of the rows there, (R,). gradient:
    W (x - x0), (K, n_block)."""
    x, s = at
    still = linearised.step(value, gradient)[0]
    moves = []
    for unit in np.eye(len(s)):
        slope = (problem.values(x, s + DERIVATIVE_STEP * unit) - value) / DERIVATIVE_STEP
        moves.append((linearised.step(value + PROBE * slope, gradient)[0] - still) / PROBE)
    pulls = [metric.times(move) for move in moves]
    schur = np.array([[float((pull * move).sum()) for move in moves] for pull in pulls])
    slopes = [
        float((gradient * move).sum() + (pull * still).sum())
        for move, pull in zip(moves, pulls, strict=True)
    ]
    change = np.clip(-np.linalg.solve(schur, np.array(slopes)), -MAX_STEP, MAX_STEP)
    step = still + sum(each * move for each, move in zip(change, moves, strict=True))
    return step, change


@dataclass(frozen=True)
class _BorderedProblem:
    """Rows by unknowns and durations. rows: of the start, with the contacts where they are."""

    start: Motion
    rows: Rows
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

    def values(self, x: FloatArray, s: FloatArray) -> FloatArray:
        """(R,) values of the rows, less what the start violates of the equations."""
        left = np.where(self.rows.equal, self.rows.value, 0.0)
        return np.asarray(self.feasible(s).values(x) - left)
