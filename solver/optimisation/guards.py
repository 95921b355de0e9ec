"""Guards of a solve: what a motion must not do though nobody asks, by rows that join where it does.

Where not all of it can be met together with what the artist asks for, the rows that pull the
hardest are given up, by name, and reported.
"""

from collections.abc import Sequence, Set
from dataclasses import replace
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from ..data.row_kinds import RowKind
from ..numerics.block_banded import BlockBanded
from ..transcription.constraint import DenseViolation
from ..transcription.guard_rows import GuardRows
from ..transcription.motion import Motion
from ..transcription.transcription import Transcription
from .sqp import FeasibleSet

HARD_PULL = 0.1  # of the hardest, for another row to be in the way as well


class Guard(Protocol):
    """One kind of thing that a motion must not do."""

    @property
    def kind(self) -> RowKind:
        """Of its rows."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of its items."""

    @property
    def hard(self) -> bool:
        """Whether nothing of it may be given up."""

    def rows(self, motion: Motion, given_up: Set[str]) -> GuardRows | None:
        """A motion's rows of this kind, with more where it violates something; else the same.

        given_up: names of items that get no rows.
        """

    def sparse(self) -> "Guard":
        """The same, for which fewer instants are looked at: a drag's, which is in a hurry."""

    def violations(self, motion: Motion) -> list[DenseViolation]:
        """The worst of each item that a motion violates at all, worst first."""


def guarded(motion: Motion, guards: Sequence[Guard], given_up: Set[str]) -> Transcription:
    """A motion's transcription with the rows of its guards; the very same where none are new."""
    t = motion.transcription
    rows = {old.kind: old for old in t.guards}
    for guard in guards:
        if (new := guard.rows(motion, given_up)) is not None:
            rows[guard.kind] = new
    same = all(new is t.guard(kind) for kind, new in rows.items())
    return t if same else t.guarded(tuple(rows.values()))


def with_guards(guards: Sequence[Guard], now: FeasibleSet, x: FloatArray) -> FeasibleSet:
    """A feasible set with the rows that its guards have at x (K, n_block); the very same where
    none are new."""
    t = guarded(now.motion(x), guards, set())
    return now if t is now.transcription else replace(now, transcription=t)


def in_the_way(feasible: FeasibleSet, metric: BlockBanded, x: FloatArray) -> set[str]:
    """Names of the guard rows that pull the hardest at x (K, n_block), where a solve got stuck, or
    where they joined; none where all hold.

    What cannot be met has multipliers far beyond the others'; each counts as what its tolerance
    costs, as a millimetre and a tenth of a degree have no common unit.
    """
    rows = feasible.rows(x)
    multipliers = feasible.linearise(rows, metric).step(rows.value).multipliers
    pull = np.abs(multipliers * rows.tolerance) * rows.guards
    owners = feasible.transcription.owners
    hardest = (pull > 0.0) & (pull >= HARD_PULL * pull.max())
    return {owners[i] for i in rows.owner[hardest]}
