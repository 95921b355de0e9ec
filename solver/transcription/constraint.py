"""Constraints: bounds on a function of the motion over an interval (thesis 3.3).

They are collocated at instants. Between these a bound can be missed a little; `exchange` then adds
the worst instants: the exchange method of semi-infinite programming (Hettich & Kortanek 1993).
"""

from copy import copy
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.character import Character
from ..data.row_kinds import RowKind
from ..numerics.splines import SplineBasis
from .joint_measures import ConeAngle
from .rows import Layout, Rows, inside, violation
from .sampling import Instants, MotionFunction, State

MAX_DENSE_SPACING = 0.004  # s, between the instants that tell whether a bound holds
SAME_INSTANT = 1e-6  # s
MIN_DENSE_PER_SPAN = 6


class ConstraintFunction(MotionFunction, Protocol):
    """A motion function that can be bounded."""

    @property
    def kind(self) -> RowKind:
        """Constraint type of its rows."""


class Collocated(Protocol):
    """A bounded motion function with the instants at which it is kept between its bounds."""

    @property
    def function(self) -> ConstraintFunction:
        """What is bounded."""

    def instants(self, basis: SplineBasis) -> Instants:
        """Instants (U,) on a basis."""

    def limits(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lower and upper (U, m) bounds at those instants, s."""

    def some(self, which: BoolArray, /) -> "Collocated":
        """The same for some of its instants, by flags (U,)."""


@dataclass(frozen=True)
class Bounds:
    """Lower and upper bounds (m,), constant in time; infinite where free."""

    lower: FloatArray
    upper: FloatArray

    @staticmethod
    def scalar(lower: float | None, upper: float | None) -> "Bounds":
        """Bounds of a single value; None where it is free."""
        return Bounds(
            np.array([-np.inf if lower is None else lower]),
            np.array([np.inf if upper is None else upper]),
        )

    def at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lower and upper (U, m) at instants (U,) s."""
        return np.tile(self.lower, (len(times), 1)), np.tile(self.upper, (len(times), 1))


@dataclass(frozen=True)
class Constraint:
    """Bounds on a function between start and end, s; its instants on a basis. name: the artist's.

    per_span: instants per span. extra: instants that `exchange` added, s.
    """

    name: str
    function: ConstraintFunction
    bounds: Bounds
    start: float
    end: float
    per_span: int = 2
    extra: tuple[float, ...] = ()

    @property
    def kind(self) -> RowKind:
        return self.function.kind

    def limits(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lower and upper (U, m) bounds at instants (U,) s."""
        return self.bounds.at(times)

    def some(self, _which: BoolArray) -> "Constraint":
        """Itself: its function is the same at all of its instants."""
        return self

    def instants(self, basis: SplineBasis) -> Instants:
        """Collocation instants on a basis: both ends, and evenly inside every span.

        Torques follow accelerations, which have corners at the breaks and jump at the double ones:
        there they have instants on both sides.
        """
        if self.kind is RowKind.PEAK:
            return self._node_instants(basis)
        if self.kind is RowKind.TORQUE:
            return self._sided_instants(basis)
        inside = np.linspace(0.0, 1.0, self.per_span, endpoint=False) + 0.5 / self.per_span
        length = np.diff(basis.breaks)[:, None]
        times = (basis.breaks[:-1, None] + length * inside).ravel()
        times = times[(times > self.start) & (times < self.end)]
        ends = [self.start, self.end]
        return Instants(basis, np.unique(np.concatenate([times, ends, self.extra])))

    def _node_instants(self, basis: SplineBasis) -> Instants:
        """Force nodes: forces are linear in between, so a convex bound holds there too."""
        inside = (basis.breaks[1:] > self.start) & (basis.breaks[:-1] < self.end)
        spans = np.flatnonzero(inside)
        if not len(spans):
            spans = basis.spans(np.array([self.start]))
        times = np.concatenate([basis.breaks[spans], basis.breaks[spans + 1]])
        return Instants(basis, times, np.concatenate([spans, spans]))

    def _sided_instants(self, basis: SplineBasis) -> Instants:
        """Breaks, double ones from both sides, and evenly inside every span."""
        first, last = basis.breaks[:-1], basis.breaks[1:]
        spans = np.arange(basis.n_spans)
        ends = np.append(basis.double[1:-1], True)
        inside = (np.arange(self.per_span - 1) + 1.0) / self.per_span
        between = (first[:, None] + (last - first)[:, None] * inside).ravel()
        extra = np.array(self.extra)
        times = np.concatenate([first, between, last[ends], extra])
        owners = [spans, np.repeat(spans, len(inside)), spans[ends], basis.spans(extra)]
        owner = np.concatenate(owners)
        order = np.lexsort((owner, times))
        middle = 0.5 * (first + last)[owner]  # of the span that an instant is seen from
        # Ends that are a break's may differ from it by rounding: the break counts.
        inside = (times >= self.start - SAME_INSTANT) & (times <= self.end + SAME_INSTANT)
        inside &= (middle > self.start) | (times > self.start)
        inside &= (middle < self.end) | (times < self.end)
        order = order[inside[order]]
        if not len(order):
            return Instants(basis, np.array([0.5 * (self.start + self.end)]))
        return Instants(basis, times[order], owner[order])

    def dense(self, basis: SplineBasis) -> Instants:
        """Dense grid that tells whether it holds between its instants."""
        longest = float(np.diff(basis.breaks).max())
        per_span = max(MIN_DENSE_PER_SPAN, int(np.ceil(longest / MAX_DENSE_SPACING)))
        return replace(self, per_span=per_span, extra=()).instants(basis)


class DiscretisedConstraint:
    """A constraint collocated on one basis. owner: its index among all owners of rows, or the
    index for each instant (U,)."""

    def __init__(
        self,
        constraint: Collocated,
        character: Character,
        basis: SplineBasis,
        layout: Layout,
        owner: IntArray | int,
    ) -> None:
        self.constraint = constraint
        self.instants = constraint.instants(basis)
        self.lower, self.upper = constraint.limits(self.instants.times)
        self._character, self._layout, self._owner = character, layout, owner

    def relaxed(self, x: FloatArray, share: float) -> "DiscretisedConstraint":
        """Homotopy: bounds that x (K, n_block) violates lie `share` of the way to their own."""
        twin = copy(self)
        found = self.value(x).reshape(self.lower.shape)
        twin.lower = self.lower + (1.0 - share) * np.minimum(found - self.lower, 0.0)
        twin.upper = self.upper + (1.0 - share) * np.maximum(found - self.upper, 0.0)
        return twin

    def within(self, spans: slice) -> "DiscretisedConstraint":
        """Its instants in some of the spans."""
        twin, kept = copy(self), inside(self.instants.spans, spans)
        twin.constraint, twin.instants = self.constraint.some(kept), self.instants.some(kept)
        twin.lower, twin.upper = self.lower[kept], self.upper[kept]
        if isinstance(self._owner, np.ndarray):
            twin._owner = self._owner[kept]
        return twin

    def value(self, x: FloatArray) -> FloatArray:
        """(U m,) the values of `rows` without their Jacobian."""
        return np.asarray(self.constraint.function.value(self.state(x)).ravel())

    def rows(self, x: FloatArray) -> Rows:
        """Its rows at unknowns x (K, n_block)."""
        state, instants = self.state(x), self.instants
        function = self.constraint.function
        return Rows.of(
            instants.spans,
            function.value(state),
            instants.assemble(function.jacobians(state), self._layout),
            function.kind,
            instants.times,
            self._owner,
            (self.lower, self.upper),
        )

    def state(self, x: FloatArray) -> State:
        return State(self._character, self._layout, self.instants, x)


@dataclass(frozen=True)
class DenseViolation:
    """Largest violation of a constraint on the dense grid, in its kind's unit, and when (s)."""

    name: str
    kind: RowKind
    amount: float
    time: float


def dense_violation(
    constraint: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> DenseViolation:
    """Largest violation by unknowns x (K, n_block), between the constraint's instants too; of a
    cone the largest angle in space, which its rows' values are not where it has a stretch."""
    instants, size = _violation_on_grid(constraint, character, basis, layout, x)
    cone = constraint.function
    if isinstance(cone, ConeAngle) and size.any():
        lower, upper = constraint.bounds.at(instants.times)
        turned = cone.rotations(State(character, layout, instants, x))
        size = np.maximum(cone.past(turned, lower.ravel(), upper.ravel()).max(axis=0), 0.0)
    worst = int(np.argmax(size))
    time = float(instants.times[worst])
    return DenseViolation(constraint.name, constraint.kind, float(size[worst]), time)


def exchange(
    constraint: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> Constraint:
    """The constraint with the dense grid's local maxima of violation added to its instants.

    Returns the very same constraint where x (K, n_block) violates it nowhere.
    """
    instants, size = _violation_on_grid(constraint, character, basis, layout, x)
    bad = size > constraint.kind.tolerance
    if constraint.kind is RowKind.PEAK or not bad.any():
        return constraint
    peak = bad & (size >= np.roll(size, 1)) & (size >= np.roll(size, -1))
    added = {*constraint.extra, *instants.times[peak].tolist()}
    return replace(constraint, extra=tuple(sorted(added)))


def _violation_on_grid(
    constraint: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> tuple[Instants, FloatArray]:
    instants = constraint.dense(basis)
    value = constraint.function.value(State(character, layout, instants, x))
    off = violation(value, *constraint.bounds.at(instants.times))
    return instants, np.abs(off).max(axis=1)
