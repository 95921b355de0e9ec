"""Interior-point method for the small program of a step (Mehrotra 1992), to tell its working set.

    min 1/2 u'S u + support   with   lower <= r <= upper,   r = -S u

where rows cannot all be at one bound or the other of narrow intervals, as torques of a limp limb at
hundreds of instants: the sets between are more than an active-set method can walk through, and the
way through the middle is as long as of any other program. Its end is not exact, but it tells which
rows are at which bounds; what these make of the multipliers is (active_set.py).
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...numerics.dense_cholesky import DenseCholesky

ENOUGH = 1e-6  # of the farthest row's way, that rows may be off, and slacks of pushing rows left
MOST_STEPS = 40  # from twelve to 25 are the rule
SOFTENED = 1e-2  # of a row's own stiffness, by which all give way in the first guess
SHORT_OF_BOUNDS = 0.99  # of the way to the first slack or push that would end
SIDES = np.array([[1.0], [-1.0]])  # upper, lower


def predicted_sides(
    stiffness: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray | None:
    """(m,) 1 for rows that will be at their upper bounds, -1 at their lower ones, 0 between.

    stiffness: (m, m) positive, ones on its diagonal. lower < upper: (m,), which 0 must miss
    somewhere. None where it does not come to an end.
    """
    farthest = max(float(lower.max()), float(-upper.min()))
    bounded = np.isfinite([upper, lower])
    program = _Interior(stiffness, lower / farthest, upper / farthest, bounded)
    try:
        iterate = program.start()
        for _ in range(MOST_STEPS):
            if program.ended(iterate):
                at = bounded & (iterate.push > iterate.slack)
                return np.asarray((SIDES * at).sum(axis=0))
            iterate = program.step(iterate)
    except np.linalg.LinAlgError:
        return None
    return None


@dataclass(frozen=True)
class _Iterate:
    """reached: (m,) r, within its bounds. slack: (2, m) from it to the upper and lower ones. push:
    (2, m) of these, u = push[0] - push[1]. All are positive; of no bound slack 1 and push 0.
    A change of one has the same parts."""

    reached: FloatArray
    slack: FloatArray
    push: FloatArray


@dataclass(frozen=True)
class _Interior:
    """The program in units in which the farthest row has a way of 1. bounded: (2, m)."""

    stiffness: FloatArray
    lower: FloatArray
    upper: FloatArray
    bounded: BoolArray

    def start(self) -> _Iterate:
        """In the middle of narrow intervals, by what a softer program pushes."""
        soft = self.stiffness + SOFTENED * np.eye(len(self.lower))
        u = DenseCholesky.of(soft).solve(-np.clip(0.0, self.lower, self.upper))
        room = 0.5 * np.minimum(self.upper - self.lower, 2.0)
        reached = np.clip(-(self.stiffness @ u), self.lower + room, self.upper - room)
        slack = np.where(self.bounded, [self.upper - reached, reached - self.lower], 1.0)
        push = np.where(self.bounded, np.maximum(SIDES * u, 0.0) + np.abs(u).mean(), 0.0)
        return _Iterate(reached, slack, push)

    def ended(self, iterate: _Iterate) -> bool:
        return (
            self._gap(iterate.slack, iterate.push) < ENOUGH**2
            and float(np.abs(self._off(iterate)).max()) < ENOUGH
        )

    def _gap(self, slack: FloatArray, push: FloatArray) -> float:
        """Mean of slack times push, which comes to nothing."""
        return float((slack * push).sum() / self.bounded.sum())

    def _off(self, iterate: _Iterate) -> FloatArray:
        """(m,) by which -S u is off what is taken for it."""
        u = iterate.push[0] - iterate.push[1]
        return np.asarray(-(self.stiffness @ u) - iterate.reached)

    def step(self, iterate: _Iterate) -> _Iterate:
        """Predictor and corrector on one factor. Raises LinAlgError."""
        slack, push = iterate.slack, iterate.push
        gives = (push / slack).sum(axis=0)  # by how much the push grows with r
        matrix = self.stiffness.copy()
        matrix[np.diag_indices(len(matrix))] += 1.0 / gives
        factor, off = DenseCholesky.of(matrix), self._off(iterate)

        def change(product: FloatArray) -> _Iterate:
            """That brings slack times push to what it is and the product (2, m) beside."""
            direct = (SIDES * product / slack).sum(axis=0)
            du = factor.solve(direct / gives + off)
            dr = (du - direct) / gives
            ds = np.where(self.bounded, -SIDES * dr, 0.0)
            return _Iterate(dr, ds, (product - push * ds) / slack)

        gap = self._gap(slack, push)
        predicted = change(-slack * push)
        length = min(1.0, _longest(iterate, predicted))
        left = self._gap(slack + length * predicted.slack, push + length * predicted.push)
        centre = np.where(self.bounded, (left / gap) ** 3 * gap, 0.0)
        found = change(centre - slack * push - predicted.slack * predicted.push)
        length = min(1.0, SHORT_OF_BOUNDS * _longest(iterate, found))
        return _Iterate(
            iterate.reached + length * found.reached,
            slack + length * found.slack,
            push + length * found.push,
        )


def _longest(iterate: _Iterate, change: _Iterate) -> float:
    """The share of a change with which the first slack or push would end."""
    x = np.concatenate([iterate.slack, iterate.push])
    dx = np.concatenate([change.slack, change.push])
    ending = dx < 0.0
    return float((-x[ending] / dx[ending]).min(initial=np.inf))
