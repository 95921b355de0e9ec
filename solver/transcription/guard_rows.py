"""Guard rows: what nobody asks for but a motion must not do, such as going through a solid.

They begin with no instants at all and get them where a dense grid finds a violation
(solid/solid_world.py, human/human_guard.py), so each row has its own item, instant and bound.
"""

from collections.abc import Iterator, Set
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind
from ..numerics.splines import SplineBasis
from .constraint import ConstraintFunction
from .sampling import Instants


class GuardFunction(ConstraintFunction, Protocol):
    """A constraint function whose items are the rows themselves, each at its own instant."""

    def some(self, which: BoolArray) -> "GuardFunction":
        """Of some of the rows (U,)."""


@dataclass(frozen=True)
class GuardRows:
    """U rows. names: of the items, such as "Left hand in right thigh"; items: (U,) of the rows.

    function: gives (U, 1), row by row. times: (U,) s. lower: (U,) in the unit of its kind.
    """

    names: tuple[str, ...]
    items: IntArray
    times: FloatArray
    lower: FloatArray
    function: GuardFunction

    @property
    def kind(self) -> RowKind:
        return self.function.kind

    def some(self, which: BoolArray) -> "GuardRows":
        """Some of the rows, by flags (U,)."""
        items, times, lower = self.items[which], self.times[which], self.lower[which]
        return GuardRows(self.names, items, times, lower, self.function.some(which))

    def instants(self, basis: SplineBasis) -> Instants:
        """Each row's own."""
        return Instants(basis, self.times)

    def limits(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lower and upper (U, 1)."""
        return self.lower[:, None], np.full((len(times), 1), np.inf)


class Violations(Protocol):
    """What a dense grid found: items (M,), times (M,) s, over (M,) by how much too far."""

    @property
    def items(self) -> IntArray: ...

    @property
    def times(self) -> FloatArray: ...

    @property
    def over(self) -> FloatArray: ...


def chosen(found: Violations, spacing: float, apart: float) -> IntArray:
    """Indices of the violations that get rows: of every run the worst, and others `apart` s away.

    spacing: s, of the grid.
    """
    return np.array(list(_chosen(found, spacing, round(apart / spacing))), dtype=int)


def _chosen(found: Violations, spacing: float, step: int) -> Iterator[int]:
    order = np.lexsort((found.times, found.items))
    times, items = found.times[order], found.items[order]
    ends = np.flatnonzero((np.diff(items) != 0) | (np.diff(times) > 1.5 * spacing)) + 1
    for run in np.split(order, ends):
        worst = int(np.argmax(found.over[run]))
        yield from run[worst % step :: step].tolist()


def named(names: tuple[str, ...], items: IntArray, wanted: Set[str]) -> IntArray:
    """(U,) flags of the items that have one of the wanted names."""
    return np.asarray(np.isin(np.array(names, dtype=str)[items], list(wanted)))
