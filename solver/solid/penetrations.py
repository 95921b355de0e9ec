"""What of a motion is in what, at which instants, and how much deeper than is allowed."""

from collections.abc import Set
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind
from ..transcription.constraint import DenseViolation
from ..transcription.guard_rows import named
from ..transcription.motion import Motion
from .surfaces import Placed

SPACING = 0.004  # s, of the dense grid
MOST_NEW = 0.002  # m, by which solids may be deeper in each other than in the fit; no one sees it


@dataclass(frozen=True)
class Penetrations:
    """What is in what: items (M,), times (M,) s, over (M,) m, how much deeper than allowed.

    lower: (M,) m, the allowed distance. side: (M, 3), see Closest.side.
    """

    names: tuple[str, ...]
    items: IntArray
    times: FloatArray
    over: FloatArray
    lower: FloatArray
    side: FloatArray

    def some(self, which: IntArray | BoolArray) -> "Penetrations":
        """Some of them."""
        return Penetrations(
            self.names,
            self.items[which],
            self.times[which],
            self.over[which],
            self.lower[which],
            self.side[which],
        )

    def but(self, given_up: Set[str]) -> "Penetrations":
        """All but those of these names."""
        return self.some(~named(self.names, self.items, given_up))

    def with_more(self, more: "Penetrations") -> "Penetrations":
        """These and more."""
        return Penetrations(
            self.names,
            np.concatenate([self.items, more.items]),
            np.concatenate([self.times, more.times]),
            np.concatenate([self.over, more.over]),
            np.concatenate([self.lower, more.lower]),
            np.concatenate([self.side, more.side]),
        )

    def worst(self) -> list[DenseViolation]:
        """The deepest of each name, deepest first."""
        found: dict[str, DenseViolation] = {}
        for i in np.argsort(-self.over).tolist():
            name = self.names[self.items[i]]
            amount, time = float(self.over[i]), float(self.times[i])
            found.setdefault(name, DenseViolation(name, RowKind.SOLID, amount, time))
        return list(found.values())


def placed_at(motion: Motion, times: FloatArray) -> Placed:
    """A motion's poses at instants (N,) s."""
    return Placed(times, motion.pose(times), motion.com(times))
