"""A named condition on the motion: bounds on a quantity at instants (thesis 3.3).

Between the instants a bound can be missed a little; `exchange` then adds the worst instants, the
way semi-infinite programs are solved (Hettich and Kortanek 1993).
"""

from copy import copy
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..data.row_kinds import RowKind
from ..numerics.splines import SplineBasis
from .rows import Layout, Rows, violation
from .sampling import Instants, Slope, State

DENSE = 0.004  # s, between the instants that tell whether a bound holds
FEWEST_DENSE = 6  # of them a span


class ConstraintFunction(Protocol):
    """A quantity of the motion that can be bounded."""

    @property
    def kind(self) -> RowKind:
        """What its rows are called."""

    def value(self, state: State) -> FloatArray:
        """(U, m) at the state's instants."""

    def slopes(self, state: State) -> list[Slope]:
        """Its derivatives."""


@dataclass(frozen=True)
class Bounds:
    """lower, upper (m,); infinite where free."""

    lower: FloatArray
    upper: FloatArray

    def at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Each (U, m)."""
        return np.tile(self.lower, (len(times), 1)), np.tile(self.upper, (len(times), 1))


@dataclass(frozen=True)
class Constraint:
    """Bounds on a measure between start and end, s. name: the artist's.

    per_span: rows per span. extra: instants that `exchange` added.
    """

    name: str
    measure: ConstraintFunction
    bounds: Bounds
    start: float
    end: float
    per_span: int = 2
    extra: tuple[float, ...] = ()

    @property
    def kind(self) -> RowKind:
        return self.measure.kind

    def instants(self, basis: SplineBasis) -> Instants:
        """Where its rows are on a basis: at the ends, and evenly inside every span.

        Torques follow accelerations, which have corners at the breaks and jump at the double ones:
        there they have rows on both sides.
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
        """The force nodes: forces are linear in between, so a bound that is convex holds there."""
        inside = (basis.breaks[1:] > self.start) & (basis.breaks[:-1] < self.end)
        spans = np.flatnonzero(inside)
        if not len(spans):
            spans = basis.spans(np.array([self.start]))
        times = np.concatenate([basis.breaks[spans], basis.breaks[spans + 1]])
        return Instants(basis, times, np.concatenate([spans, spans]))

    def _sided_instants(self, basis: SplineBasis) -> Instants:
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
        inside = (times >= self.start) & (times <= self.end)
        inside &= (middle > self.start) | (times > self.start)
        inside &= (middle < self.end) | (times < self.end)
        order = order[inside[order]]
        if not len(order):
            return Instants(basis, np.array([0.5 * (self.start + self.end)]))
        return Instants(basis, times[order], owner[order])

    def dense(self, basis: SplineBasis) -> Instants:
        """Instants that tell whether it holds between the rows."""
        longest = float(np.diff(basis.breaks).max())
        per_span = max(FEWEST_DENSE, int(np.ceil(longest / DENSE)))
        return replace(self, per_span=per_span, extra=()).instants(basis)


class Bounded:
    """A condition on one basis, ready to give rows. owner: its index among all owners."""

    def __init__(
        self,
        condition: Constraint,
        character: Character,
        basis: SplineBasis,
        layout: Layout,
        owner: int,
    ) -> None:
        self.condition = condition
        self.instants = condition.instants(basis)
        self.lower, self.upper = condition.bounds.at(self.instants.times)
        self._character, self._layout, self._owner = character, layout, owner

    def eased(self, x: FloatArray, share: float) -> "Bounded":
        """The same with the bounds that x misses moved `share` of the way from x to their own."""
        twin = copy(self)
        found = self.value(x).reshape(self.lower.shape)
        twin.lower = self.lower + (1.0 - share) * np.minimum(found - self.lower, 0.0)
        twin.upper = self.upper + (1.0 - share) * np.maximum(found - self.upper, 0.0)
        return twin

    def value(self, x: FloatArray) -> FloatArray:
        """(U m,) the values of `rows` alone, cheaper."""
        return np.asarray(self.condition.measure.value(self.state(x)).ravel())

    def rows(self, x: FloatArray) -> Rows:
        state, instants = self.state(x), self.instants
        measure = self.condition.measure
        return Rows.of(
            instants.spans,
            measure.value(state),
            instants.spread(measure.slopes(state), self._layout),
            measure.kind,
            instants.times,
            self._owner,
            (self.lower, self.upper),
        )

    def state(self, x: FloatArray) -> State:
        return State(self._character, self._layout, self.instants, x)


@dataclass(frozen=True)
class Missed:
    """By how much a condition is missed at worst, in its kind's unit, and when (s)."""

    name: str
    kind: RowKind
    amount: float
    time: float


def missed(
    condition: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> Missed:
    """How badly a motion misses a condition at worst, between its rows too."""
    instants, off = _dense_violation(condition, character, basis, layout, x)
    worst = int(np.argmax(off))
    return Missed(condition.name, condition.kind, float(off[worst]), float(instants.times[worst]))


def exchange(
    condition: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> Constraint:
    """The condition with the instants added at which it is missed most, one for each stretch."""
    instants, off = _dense_violation(condition, character, basis, layout, x)
    bad = off > condition.kind.tolerance
    if condition.kind is RowKind.PEAK or not bad.any():
        return condition
    peak = bad & (off >= np.roll(off, 1)) & (off >= np.roll(off, -1))
    added = {*condition.extra, *instants.times[peak].tolist()}
    return replace(condition, extra=tuple(sorted(added)))


def _dense_violation(
    condition: Constraint, character: Character, basis: SplineBasis, layout: Layout, x: FloatArray
) -> tuple[Instants, FloatArray]:
    instants = condition.dense(basis)
    value = condition.measure.value(State(character, layout, instants, x))
    off = violation(value, *condition.bounds.at(instants.times))
    return instants, np.abs(off).max(axis=1)
