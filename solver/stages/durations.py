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
from ..fitting.fit import LinearisedPoses
from ..numerics.block_banded import BlockBanded
from ..optimisation.kkt_step import LinearisedProblem
from ..optimisation.sqp import FeasibleSet
from ..transcription.motion import Motion
from ..transcription.rows import Rows

DERIVATIVE_STEP = 1e-4  # of s, of the finite differences of the rows
PROBE = 0.03  # of s, for which D is taken: a step with its bounds is only piecewise linear in it
MAX_STEP = 0.3  # of s in one step
MIN_STEP = 0.01  # of s: some milliseconds of a flight; the next step would change it by far less
SETTLED = 0.05  # of s, that the last step may change it by: a twentieth of a flight
MAX_STEPS = 4
SHARES = (1.0, 0.5, 0.25)  # of a step, of which the first that gains is taken
MAX_RATIO = 0.5  # of the violation, left at the end; the solve proper does the rest
CLOSE = 0.1  # of the violation, from where a small step is the last


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
    carried to places (n_contacts, 3) m. None where no such motion is found: rows linearised at the
    start tell nothing of one that is too far from it.
    """
    metric, linearised = start.metric, start.unpriced
    problem = _BorderedProblem(start.motion, linearised.rows, places, tuple(flights))
    x, timed = reference, problem.timed(np.zeros(len(flights)))
    value = timed.values(x)
    before = left = linearised.violation(value)
    for steps in range(MAX_STEPS):
        at = x, timed.s, value
        step, change = _step(linearised, metric, problem, at, metric.times(x - reference))
        for share in SHARES:
            further = problem.timed(timed.s + share * change)
            value = further.values(x + share * step)
            now = linearised.violation(value)
            if now < left:
                break
        changed = float(np.abs(change).max())
        if not now < left:
            break
        step = share * step
        x, timed, left = x + step, further, now
        if steps > 0 and changed < MIN_STEP and left < CLOSE * before:
            break
    if changed > SETTLED or not left < MAX_RATIO * before:
        return None
    # By metres alone the least change twirls a neck by 70 degrees at the end of a clip.
    x = reference + start.priced.step(timed.values(reference)).d
    return TimedMotion(timed.feasible.motion(x), problem.stretches(timed.s))


def _step(
    linearised: LinearisedProblem,
    metric: BlockBanded,
    problem: "_BorderedProblem",
    at: tuple[FloatArray, FloatArray, FloatArray],
    gradient: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Step of x (K, n_block) and s (n,) from `at`, where the rows have values (R,), the third.

    gradient: W (x - x0), (K, n_block).
    """
    x, s, value = at
    still = linearised.step(value, gradient).d
    moves = []
    for unit in np.eye(len(s)):
        aside = problem.timed(s + DERIVATIVE_STEP * unit)
        slope = (aside.values(x) - value) / DERIVATIVE_STEP
        moves.append((linearised.step(value + PROBE * slope, gradient).d - still) / PROBE)
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

    def timed(self, s: FloatArray) -> "_TimedRows":
        """The rows with these durations: what they are made of takes as long as their values."""
        warp = TimeWarp.of(self.stretches(s), self.start.duration)
        feasible = FeasibleSet(self.start.transcription.retimed(warp), self.places)
        return _TimedRows(s, feasible, np.where(self.rows.equal, self.rows.value, 0.0))


@dataclass(frozen=True)
class _TimedRows:
    """Rows with durations exp(s). left: (R,) what the start violates of the equations."""

    s: FloatArray
    feasible: FeasibleSet
    left: FloatArray

    def values(self, x: FloatArray) -> FloatArray:
        """(R,) values of the rows at x (K, n_block), less what is left."""
        return np.asarray(self.feasible.values(x) - self.left)
