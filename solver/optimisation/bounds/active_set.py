"""Dual active-set method for the small program of a step (Goldfarb and Idnani 1983).

    min 1/2 |w|^2   subject to   lower <= C w <= upper,   S = C C',   w = -C'u

A working set of rows is at its bounds. The row that is beyond its own the farthest is pushed back
while those of the set stay where they are; a row whose multiplier comes to nothing on the way
leaves the set, and the pushed one joins it. The dual's value grows with each change, so that no set
comes twice. It begins with any set: from the last program's few changes are left, where a solver
that begins with none makes hundreds. Where many are left, an interior-point method tells the set.
"""

from dataclasses import dataclass, field

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...numerics.dense_cholesky import DenseCholesky
from .interior_point import predicted_sides

ROUNDING = 1e-10  # of the farthest row's way, that a row may be beyond its bound
MOST_CHANGES = 10  # times the rows; programs from nothing take one to four
FRESH = 50  # changes, after which the set's inverse is made anew, for each leaves it some rounding
PATIENCE = 100  # changes, which cost as much as the interior-point method that tells the rest
DEPENDENT = 1e-9  # of a row's own stiffness: less is rounding, as every row gives by more


def multipliers_by_active_set(
    stiffness: FloatArray, lower: FloatArray, upper: FloatArray, guess: FloatArray
) -> FloatArray | None:
    """Multipliers u (m,) of min 1/2 u'S u + support, lower <= -S u <= upper, S (m, m) positive.

    u > 0 where a row is at its upper bound, u < 0 at its lower, 0 in between. guess: (m,) the signs
    of u to begin with. None where rounding keeps it from ending. Raises LinAlgError where rows or
    bounds are not finite.
    """
    # Of rows in their own units none is lost in the rounding of another's.
    scale = np.sqrt(np.diagonal(stiffness))
    program = _Program(stiffness / np.outer(scale, scale), lower / scale, upper / scale)
    # Infinite where a bound is on the wrong side, and NaN as well.
    if not (program.farthest < np.inf and np.isfinite(program.stiffness).all()):
        raise np.linalg.LinAlgError("rows or bounds are not finite")
    working = _WorkingSet.of(program, guess)
    changes, predicted = 0, bool(program.fixed.any())  # whose rows have no interior
    while not working.settled and changes < MOST_CHANGES * len(scale):
        if changes >= PATIENCE and not predicted:
            predicted = True
            sides = predicted_sides(program.stiffness, program.lower, program.upper)
            working = _WorkingSet.of(program, working.u if sides is None else sides)
            continue
        try:
            more = working.change(FRESH)
        except np.linalg.LinAlgError:  # by rounding the set's rows depend on each other
            return None
        if not more:
            return None
        changes += more
        working = _WorkingSet.of(program, working.u)
    return np.asarray(working.u / scale) if working.settled else None


@dataclass(frozen=True)
class _Program:
    """The program with rows in units of their own: a diagonal of ones."""

    stiffness: FloatArray
    lower: FloatArray
    upper: FloatArray

    @property
    def fixed(self) -> BoolArray:
        """(m,) rows whose multipliers may have either sign."""
        return np.asarray(self.lower == self.upper)

    @property
    def farthest(self) -> float:
        """The way that the farthest row has to its bounds."""
        return float(np.maximum(self.lower, -self.upper).max(initial=0.0))

    def bounds(self, u: FloatArray) -> FloatArray:
        """(m,) of each row the bound that its multiplier's sign stands for."""
        return np.where(u > 0.0, self.upper, self.lower)


@dataclass
class _WorkingSet:
    """rows: (n,) that are at their bounds. own: (n, n) their stiffness. u: (m,) multipliers.
    reached: (m,) values of all rows, -S u. All are of the bounds exactly until it changes. inverse:
    (n, n) of the rows' stiffness, once it is to change."""

    program: _Program
    rows: IntArray
    own: FloatArray
    u: FloatArray
    reached: FloatArray
    inverse: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))

    @staticmethod
    def of(program: _Program, guess: FloatArray) -> "_WorkingSet":
        """The set that signs (m,) stand for, without rows that would pull from their bound."""
        bounds, side = program.bounds(guess), np.sign(guess)
        side[~np.isfinite(bounds)] = 0.0
        while True:
            rows = np.flatnonzero(side)
            own = program.stiffness[np.ix_(rows, rows)]
            push = np.linalg.solve(own, -bounds[rows])
            pulls = (push * side[rows] < 0.0) & ~program.fixed[rows]
            if not pulls.any():
                break
            side[rows[pulls]] = 0.0
        u = np.zeros(len(side))
        u[rows] = push
        reached = -push @ program.stiffness[rows]  # which is symmetric; rows lie together
        return _WorkingSet(program, rows, own, u, reached)

    @property
    def settled(self) -> bool:
        """Whether no row is beyond its bounds."""
        return self._worst()[1] <= 0.0

    def _worst(self) -> tuple[int, float]:
        """The row that is the farthest beyond its bounds, and how far it is beyond rounding."""
        program = self.program
        beyond = np.maximum(self.reached - program.upper, program.lower - self.reached)
        beyond[self.rows] = 0.0
        worst = int(np.argmax(beyond))
        return worst, float(beyond[worst]) - ROUNDING * program.farthest

    def change(self, enough: int) -> int:
        """Changes the set until it is settled, or has changed often enough, or rounding has taken
        over; how often it has."""
        changes, self.inverse = 0, DenseCholesky.of(self.own).inverse()
        while changes < enough:
            row, beyond = self._worst()
            if beyond <= 0.0:
                break
            more = self._push(row)
            changes += more
            if not more:
                break
        return changes

    def _push(self, row: int) -> int:
        """Brings a row to its bound, where it joins the set; how often the set changes by that. It
        stops on the way where by rounding the row does not move by itself."""
        program, changes = self.program, 0
        above = self.reached[row] > program.upper[row]
        bound, sign = (program.upper[row], 1.0) if above else (program.lower[row], -1.0)
        column = program.stiffness[:, row]
        while True:
            rows = self.rows
            share = self.inverse @ column[rows]  # by how much these give way, of a push by one
            own = float(column[row] - column[rows] @ share)
            if own <= DEPENDENT:
                return changes
            whole = sign * float(self.reached[row] - bound) / own
            weakens = (sign * self.u[rows] * share > 0.0) & ~program.fixed[rows]
            strength, loss = np.abs(self.u[rows]), np.abs(share)
            ends_first = weakens & (strength < whole * loss)
            first, push = -1, whole
            if ends_first.any():
                until = np.where(ends_first, strength / np.where(ends_first, loss, 1.0), np.inf)
                first = int(np.argmin(until))
                push = float(until[first])
            self.u[rows] -= sign * push * share
            self.u[row] += sign * push
            given = np.zeros(len(column))
            given[rows] = share
            self.reached -= sign * push * (column - program.stiffness @ given)
            changes += 1
            if first < 0:
                self._join(row, share, own)
                return changes
            self.u[rows[first]] = 0.0
            self._leave(first)

    def _join(self, row: int, share: FloatArray, own: float) -> None:
        """Borders the inverse."""
        n = len(self.rows)
        inverse = np.empty((n + 1, n + 1))
        inverse[:n, :n] = self.inverse + np.outer(share, share / own)
        inverse[n, :n] = inverse[:n, n] = -share / own
        inverse[n, n] = 1.0 / own
        self.inverse, self.rows = inverse, np.append(self.rows, row)

    def _leave(self, k: int) -> None:
        """Takes the k-th of the rows out of the inverse."""
        kept = np.arange(len(self.rows)) != k
        column = self.inverse[kept, k]
        inverse = self.inverse[np.ix_(kept, kept)]
        self.inverse = inverse - np.outer(column, column / self.inverse[k, k])
        self.rows = self.rows[kept]
