"""KKT step: the linearised problem of a step, solved on one banded factor (thesis 4.4).

    min  g . d + 1/2 d . W d   subject to   C + C_x d = 0,   lo <= B + B_x d <= hi

The equalities are settled by an augmented Lagrangian (Nocedal & Wright, 17.3), which also settles
redundant rows (two feet planted, pins on one rigid foot) without choosing among them; the bounds by
a small quadratic program (bounds/bounded_qp.py), which limp joints do not crowd (limp_torques.py).
"""

from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.constants import STANDARD_GRAVITY
from ..data.row_kinds import RowKind
from ..numerics.block_banded import BlockBanded, CholeskyFactor
from ..numerics.tied_factor import Factor, TiedFactor
from ..transcription.rows import Rows, by_kind
from ..transcription.transcription import Transcription
from .acceleration import Anderson
from .bounds.bounded_qp import BoundedStep
from .limp_torques import LimpTorques
from .span_rows import SpanRows

# Velocities are weighed against positions by the time in which they would move as far.
ROW_SCALES = {RowKind.PIN_SPEED: 30.0}
# Ten times as much saves no more steps and takes digits in the directions that cost least; with a
# tenth the sweeps of weak rows do not end in time.
PENALTY = 2e4
MAX_SWEEPS = 8
SWEEP_REDUCTION = 1e-3  # of the equality residual, at which sweeps end
SWEEP_REST = 0.25  # of a tolerance, at which sweeps end too: closer, weak rows cost long ways
# Of the diagonal, from a rounding on as little as will do: what steps cost along weak directions is
# a rounding of it as well, and a ridge of 1e-8 turned toes by 26 rad.
RIDGES = tuple(10.0**k for k in range(-14, -7))
MERIT_DEAD_BAND = 0.5  # of a bound's tolerance, which the merit function ignores


@dataclass(frozen=True)
class KktStep:
    """d: (K, n_block) of the unknowns. change: (R,) of the rows' values by it, to first order.
    multipliers: (R,) of the rows in units of ROW_SCALES."""

    d: FloatArray
    change: FloatArray
    multipliers: FloatArray


@dataclass(frozen=True)
class Remains:
    """What a linearised problem leaves to the next one with the same rows.

    sides: (R,) working set of its last step (bounds/bounded_qp.py). matrix, equalities: storage;
    once the next one has been made in it, the problem itself is no more.
    """

    sides: FloatArray
    matrix: BlockBanded
    equalities: SpanRows


class LinearisedProblem:
    """Rows linearised at one point, with the factor of A = W + rho J'J + s L'L, L the rows of limp
    joints' torques (limp_torques.py), ready for steps.

    metric: W. basis: (n_block, k) the changes of a block that are allowed, None all. last:
    what the problem before leaves.
    """

    def __init__(
        self,
        transcription: Transcription,
        rows: Rows,
        metric: BlockBanded,
        *,
        basis: FloatArray | None = None,
        last: Remains | None = None,
    ) -> None:
        self._basis = basis
        self._metric = metric if basis is None else metric.congruent(basis)
        self._window = transcription.blocks
        self._equal = np.flatnonzero(rows.equal)
        scale = by_kind(rows.kind[self._equal], ROW_SCALES)
        spans = transcription.spans  # of whose window the rows' spans and blocks are counted
        self._first = transcription.basis.first_coefficient[spans] - self._window.start
        rows, first = replace(rows, span=rows.span - spans.start), self._first
        into = None if last is None else last.equalities
        self._equalities = SpanRows.of(rows, self._equal, scale, first, basis, into)
        weight = transcription.character.mass * STANDARD_GRAVITY
        self._limp = LimpTorques.of(rows, weight, first, basis)
        self._matrix = self._system(None if last is None else last.matrix)
        self._factor: Factor = self._factored()
        if transcription.seam is not None:
            ties = transcription.seam.columns(self._window.stop)
            ties = ties if basis is None else np.einsum("knr,nb->kbr", ties, basis)
            self._factor = TiedFactor.of(self._factor, ties)
        self._bound(transcription, rows, None if last is None else last.sides)

    def _system(self, into: BlockBanded | None = None) -> BlockBanded:
        """A, see above."""
        system = self._metric.copy(into=into)
        self._equalities.add_normal(system, PENALTY)
        self._limp.add_normal(system)
        return system

    def _factored(self) -> CholeskyFactor:
        """The matrix's factor, which takes its place; rounding can spoil it, and the least ridge
        that does mends that. Raises numpy.linalg.LinAlgError where none does."""
        for ridge in (0.0, *RIDGES):
            if ridge:
                self._matrix = self._system(self._matrix)
                diagonal = np.diagonal(self._matrix.lower[0], axis1=1, axis2=2)
                self._matrix.add_diagonal(ridge * diagonal)
            with suppress(np.linalg.LinAlgError):
                return self._matrix.factor(overwrite=True)
        raise np.linalg.LinAlgError("the matrix is not positive definite")

    def widened(self, transcription: Transcription, guards: Rows) -> "LinearisedProblem":
        """The same with other guard rows, which are the last: they need no new factor."""
        twin = copy(self)
        kept = self.rows.unguarded
        sides = np.concatenate([self._sides[: len(kept.value)], np.zeros(len(guards.value))])
        twin._bound(transcription, Rows.join([kept, guards]), sides)
        return twin

    def renewed(self) -> "LinearisedProblem":
        """The same as if no step had been taken yet: the bounds' program begins where the last one
        ended, and what is kept for other problems must not tell of earlier ones."""
        twin = copy(self)
        twin._bound(self._transcription, self.rows, None)
        return twin

    def _bound(self, transcription: Transcription, rows: Rows, sides: FloatArray | None) -> None:
        """Sets the rows, all equalities being those of the factor, and the bounds' program."""
        self._transcription, self.rows = transcription, rows
        self._scale, self._tolerance = by_kind(rows.kind, ROW_SCALES), rows.tolerance
        self._free = np.flatnonzero(~rows.equal)
        scale = self._scale[self._free]
        bounds = SpanRows.of(rows, self._free, scale, self._first, self._basis)
        self._bounds = bounds
        was = np.zeros(len(self._free)) if sides is None else sides[self._free]
        self._bounded = BoundedStep(
            self._factor,
            bounds.columns,
            bounds.begins,
            np.where(rows.guards, rows.owner, -1 - np.arange(len(rows.value)))[self._free],
            (self._scaled(rows.lower, self._free), self._scaled(rows.upper, self._free)),
            self._scaled(self._tolerance, self._free),
            was,
        )

    @property
    def remains(self) -> Remains:
        """For the next problem with the same rows."""
        return Remains(self._sides, self._matrix, self._equalities)

    @property
    def _sides(self) -> FloatArray:
        """(R,) working set of the last step."""
        sides = np.zeros(len(self.rows.value))
        sides[self._free] = self._bounded.sides
        return sides

    def times(self, d: FloatArray) -> FloatArray:
        """(R,) first-order change of the rows' values by a change d (K, n_block) of the unknowns,
        of which only what the basis allows counts."""
        d = d if self._basis is None else d @ self._basis
        change = np.empty(len(self.rows.value))
        change[self._equal] = self._equalities.times(d)[self._equalities.where]
        change[self._free] = self._bound_values(d)
        return np.asarray(change * self._scale)

    def violation(self, value: FloatArray) -> float:
        """The worst violation by values (R,) over its tolerance; at most 1: all rows hold."""
        return float(self.violations(value).max())

    def violations(self, value: FloatArray) -> FloatArray:
        """(R,) violations by values (R,) over their tolerances."""
        return np.asarray(np.abs(self.rows.violation(value)) / self._tolerance)

    def worst_owner(self, value: FloatArray) -> str:
        """Name of the worst row's contact or constraint, else of its kind; value (R,)."""
        worst = int(np.argmax(self.violations(value)))
        owner = int(self.rows.owner[worst])
        kind: RowKind = self.rows.kind[worst]
        return self._transcription.owners[owner] if owner >= 0 else kind.label

    def merit(self, value: FloatArray) -> float:
        """Squared l2 violation by values (R,) in units of ROW_SCALES (thesis eq. 4.6).

        A part of a bound's tolerance is ignored: it is large beside the equalities'.
        """
        off = np.abs(self.rows.violation(value))
        off[self._free] = np.maximum(
            off[self._free] - MERIT_DEAD_BAND * self._tolerance[self._free], 0.0
        )
        return float(((off / self._scale) ** 2).sum())

    def l1_violation(self, value: FloatArray) -> float:
        """l1 violation by values (R,) in units of ROW_SCALES."""
        return float((np.abs(self.rows.violation(value)) / self._scale).sum())

    def _scaled(self, values: FloatArray, rows: IntArray) -> FloatArray:
        return np.asarray(values[rows] / self._scale[rows])

    def step(
        self,
        value: FloatArray,
        gradient: FloatArray | None = None,
        multipliers: FloatArray | None = None,
        sweeps: int = MAX_SWEEPS,
        *,
        limp_to_middle: bool = False,
    ) -> KktStep:
        """Augmented Lagrangian: repeat d = -A^-1 (g + J'(y + rho r) + s L'l) within the bounds,
        y += rho (r + J d), until the linearised equalities hold a thousand times better than
        before, or well within their tolerances. Rows that bounds leave little room settle slowly,
        which Anderson acceleration mends. value: (R,). gradient: g (K, n_block), None for the
        minimum-norm step. multipliers: y to begin with (R,), None zero. sweeps: at most so many.
        limp_to_middle: whether l is how far limp joints' torques are off the middle of their
        bounds; else they are only held back, l = 0, which shifts no minimum.
        """
        windows = self._equalities
        r = np.zeros(windows.J.shape[:2])
        r[windows.where] = self._scaled(value - self.rows.lower, self._equal)
        y = np.zeros_like(r)
        if multipliers is not None:
            y[windows.where] = multipliers[self._equal]
        blocks = self._window.stop - self._window.start
        if gradient is not None and self._basis is not None:
            gradient = gradient @ self._basis
        d = np.zeros((blocks, windows.size))
        residual = r
        enough = SWEEP_REST * self._scaled(self._tolerance, self._equal)
        enough = np.maximum(enough, SWEEP_REDUCTION * float(np.abs(residual).max()))
        off = self._limp.off(value) if limp_to_middle else self._limp.none
        at, accelerated = self._scaled(value, self._free), Anderson()
        z = at
        for sweep in range(sweeps):
            lagrangian_gradient = windows.transposed(y + PENALTY * residual, blocks)
            if sweep:
                lagrangian_gradient += self._metric.times(d)
            lagrangian_gradient += self._limp.gradient(off, d)
            if gradient is not None:
                lagrangian_gradient += gradient
            half = self._factor.forward(-lagrangian_gradient)
            change, z = self._bounded.correct(half, z, self._bound_values)
            d = d + change
            residual = r + windows.times(d)
            if sweep == sweeps - 1 or (np.abs(residual[windows.where]) < enough).all():
                y = y + PENALTY * residual
                break
            y = accelerated.next(y, PENALTY * residual)
        found, change = np.zeros(len(value)), np.zeros(len(value))
        found[self._equal], found[self._free] = y[windows.where], self._bounded.multipliers
        change[self._equal], change[self._free] = (residual - r)[windows.where], z - at
        d = d if self._basis is None else d @ self._basis.T
        whole = np.zeros((self._transcription.basis.n_coefficients, d.shape[1]))
        whole[self._window] = d
        return KktStep(whole, change * self._scale, found)

    def _bound_values(self, d: FloatArray) -> FloatArray:
        """(R_bounds,) product B_x d."""
        return np.asarray(self._bounds.times(d)[self._bounds.where])
