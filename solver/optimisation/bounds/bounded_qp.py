"""Bound-constrained quadratic program of a step, on the rows that matter (thesis 4.4).

The step without bounds is known from one banded factor of A = W + rho J'J. Bounds lo <= z + G d
<= hi change it by -A^-1 G'u, where the multipliers u belong to

    min 1/2 |w|^2   subject to   lo <= z + C w <= hi,   C C' = G A^-1 G',   w = -C'u

so only the rows that are, or become, violated enter (row generation), and the program is as small
as their number. With A = L L', columns of L^-1 G' are made by groups of rows that are near in time,
as far as they reach: rows far apart do not couple, and work grows with the clip and no faster.
"""

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray, IntArray
from ...numerics.block_banded import LocalColumns
from ...numerics.tied_factor import Factor
from ...transcription.rows import violation
from .active_set import multipliers_by_active_set

CONSTRAINT_SOFTNESS = 1e-7  # of a row's own stiffness, so that rows may depend on others
MAX_ROUNDS = 6  # of row generation
MOST_ROWS = 1000  # of the program, which is dense; a limp arm has 600, and with 3000 a step takes
# half a minute. The next step goes on with what is left.
GROUP = 48  # blocks of unknowns; rows that begin in as many are forward-substituted together
STEP_TOLERANCE = 0.1  # of a row's own tolerance: the violation that a step may leave


class BoundedStep:
    """Bound corrections of steps on one factor of A, by row generation.

    columns(rows) gives G' of rows (m,). begins: (R,) block in which each row's column begins.
    series: (R,) of rows that are one thing at many instants; of those only the peaks join.
    bounds: lower, upper (R,). tolerance: (R,). sides: (R,) initial working set, 1 for rows at their
    upper bounds, -1 at their lower ones, 0 between. multipliers: (R,), of the last correction.
    """

    def __init__(
        self,
        factor: Factor,
        columns: Callable[[IntArray], LocalColumns],
        begins: IntArray,
        series: IntArray,
        bounds: tuple[FloatArray, FloatArray],
        tolerance: FloatArray,
        sides: FloatArray,
    ) -> None:
        self._factor, self._columns = factor, columns
        self._begins, self._series = begins, series
        self._order = np.empty(len(series), dtype=int)  # of each row, series by series, in time
        self._order[np.lexsort((begins, series))] = np.arange(len(series))
        self.lower, self.upper = bounds
        self._tolerance = STEP_TOLERANCE * tolerance
        self.multipliers = np.zeros(len(tolerance))
        self._rows = np.zeros(0, dtype=int)
        self._halves: list[LocalColumns] = []  # L^-1 G' of these rows, by groups
        self._stiffness = np.zeros((0, 0))  # G A^-1 G' (m, m)
        self._sides = sides.copy()  # that the next program begins with

    @property
    def sides(self) -> FloatArray:
        """(R,) working set, as above."""
        return np.sign(self.multipliers)

    def correct(
        self, half: FloatArray, z: FloatArray, times: Callable[[FloatArray], FloatArray]
    ) -> tuple[FloatArray, FloatArray]:
        """Step d = A^-1 b (K, n) corrected so that it brings rows with values z (R,) into their
        bounds, and the values there.

        half: L^-1 b (K, n). times: G d for (K, n).
        """
        if not len(self._rows) and self._sides.any():
            self._add(np.flatnonzero(self._sides))
        for _ in range(1 + MAX_ROUNDS):
            left = half
            if len(self._rows):
                u = self._solve(z[self._rows] + self._reach(half))
                if u is None:  # more rows make it no easier; the line search judges
                    self.multipliers[:] = 0.0
                    d = self._factor.backward(half)
                    return d, z + times(d)
                left = half - self._pull(u)
            d = self._factor.backward(left)
            reached = z + times(d)
            beyond = violation(reached, self.lower, self.upper)
            off = np.abs(beyond) / self._tolerance
            off[self._rows] = 0.0
            more = self._peaks(np.flatnonzero(off > 1.0), off)
            worst = np.argsort(-off[more], kind="stable")[: MOST_ROWS - len(self._rows)]
            more = np.sort(more[worst])
            if not len(more):
                break
            self._sides[more] = np.sign(beyond[more])
            self._add(more)
        return d, reached

    def _peaks(self, rows: IntArray, off: FloatArray) -> IntArray:
        """Those of rows (m,) that are no less far off than what is next to them in their series:
        who brings an arm out of the trunk brings it out at the instants beside as well."""
        rows = rows[np.argsort(self._order[rows])]
        beside = self._series[rows[1:]] == self._series[rows[:-1]]
        beside &= np.diff(self._order[rows]) == 1
        rises = off[rows[1:]] > off[rows[:-1]]
        peaks = np.ones(len(rows), dtype=bool)
        peaks[1:] &= ~beside | rises
        peaks[:-1] &= ~(beside & rises)
        return np.asarray(rows[peaks])

    def _add(self, rows: IntArray) -> None:
        groups = self._begins[rows] // GROUP
        for group in np.unique(groups):
            near = rows[groups == group]
            half = self._factor.forward_locally(self._columns(near))
            none = np.zeros((0, len(near)))
            beside = np.concatenate([none, *(each.products(half) for each in self._halves)])
            self._stiffness = np.block([[self._stiffness, beside], [beside.T, half.products(half)]])
            self._halves.append(half)
            self._rows = np.concatenate([self._rows, near])
        self._soft = CONSTRAINT_SOFTNESS * np.diagonal(self._stiffness) + 1e-14

    def _pull(self, u: FloatArray) -> FloatArray:
        """(K, n) L^-1 G' u of the program's multipliers u (m,)."""
        total = np.zeros(self._factor.shape)
        ends = np.cumsum([half.values.shape[2] for half in self._halves])
        for half, mine in zip(self._halves, np.split(u, ends[:-1]), strict=True):
            half.add_times(mine, total)
        return total

    def _reach(self, half: FloatArray) -> FloatArray:
        """(m,) change of the program's rows by the step whose half is given, (K, n)."""
        return np.concatenate([each.transposed_times(half) for each in self._halves])

    def _solve(self, z: FloatArray) -> FloatArray | None:
        """The program's multipliers (m,), of its rows' values z (m,); None where rounding keeps
        them from being found."""
        rows = self._rows
        # The rows give a little (SOFT); their last multipliers make up for it.
        base = z + self._soft * self.multipliers[rows]
        lower, upper = self.lower[rows] - base, self.upper[rows] - base
        stiffness = self._stiffness + np.diag(self._soft)
        u = multipliers_by_active_set(stiffness, lower, upper, self._sides[rows])
        if u is not None:
            self.multipliers[rows], self._sides[rows] = u, np.sign(u)
        return u
