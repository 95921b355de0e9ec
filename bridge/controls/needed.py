"""Which controls a motion needs, of all that move the bodies: the fewest, and the most usual.

What bodies may do that hang together is spanned by turns of each and a shift of the whole. Controls
are left out one by one, the least wanted first, as long as the others do all of that without them:
backward elimination in least squares (Miller, Subset Selection in Regression, 2002, 3.2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from .posing import Posed
from .responses import Responses

LEVER = 0.3  # m, by which turns of bodies count beside shifts
REACHED = 0.05  # share of a motion that may be missed by all controls, of what counts as reached
NEED = 0.03  # share that may be missed more for want of controls
DEAR = 1e-3  # m for a metre or radian of a control: what takes many of either is not done by it
CHEAP = 30.0  # likewise, of which more is no better: in its rounding DEAR would be lost


@dataclass(frozen=True)
class Effects:
    """At a pose of a figure with B bodies: what D dofs do, and what bodies may do.

    done: (D, 6 B) shifts of heads, then turns times LEVER, m for a radian or metre of each dof.
    wanted: (3 B + 3, 6 B), likewise.
    """

    done: FloatArray
    wanted: FloatArray

    def part(self, dofs: Sequence[int]) -> Effects:
        """Those of some dofs."""
        return Effects(self.done[list(dofs)], self.wanted)

    @property
    def torn(self) -> FloatArray:
        """(D,) share of what each dof does that bodies which hang together do not."""
        basis = np.linalg.qr(self.wanted.T)[0]
        apart = self.done - self.done @ basis @ basis.T
        size = np.linalg.norm(self.done, axis=1)
        return np.asarray(np.linalg.norm(apart, axis=1) / np.where(size > 0.0, size, 1.0))


def effects_at(
    responses: Responses, posed: Posed, bases: FloatArray, parents: Sequence[int], unit: float
) -> Effects:
    """Effects at a pose of the controls. parents: of bodies, -1 for none. unit: m in one of the
    armature's."""
    columns = responses.columns(posed, bases)
    lengths = np.array([unit if dof.shifts else 1.0 for dof in responses.dofs])[:, None]
    count = len(lengths)
    done = [unit * columns.shifts.reshape(count, -1), LEVER * columns.turns.reshape(count, -1)]
    return Effects(
        np.concatenate(done, axis=1) / lengths, _joined(unit * posed.bodies[:, :3, 3], parents)
    )


def _joined(heads: FloatArray, parents: Sequence[int]) -> FloatArray:
    """(3 B + 3, 6 B) shifts and turns of bodies that hang together: each turns by itself, and
    carries those below."""
    count = len(heads)
    below = np.eye(count, dtype=bool)  # [a, b]: whether b is a, or hangs on it
    for b, parent in enumerate(parents):
        if parent >= 0:
            below[:, b] |= below[:, parent]
    shifts = np.zeros((count + 1, 3, count, 3))
    turns = np.zeros_like(shifts)
    shifts[count] = np.eye(3)[:, None]
    for b in range(count):
        turns[b, :, b] = LEVER * np.eye(3)
        for child in (c for c, parent in enumerate(parents) if parent == b):
            shifts[b][:, below[child]] = np.cross(np.eye(3), heads[child] - heads[b])[:, None]
    rows = 3 * (count + 1)
    return np.concatenate([shifts.reshape(rows, -1), turns.reshape(rows, -1)], axis=1)


def needed(groups: Sequence[Sequence[int]], looks: Sequence[Effects]) -> list[int]:
    """Those of the groups of dofs without which, at any of the looks, something wanted is missed.

    groups: the most wanted first.
    """
    left = [_Solved.of(look) for look in looks]
    kept = []
    for index in reversed(range(len(groups))):
        fewer = [solved.without(list(groups[index])) for solved in left]
        if all(solved.worst < NEED for solved in fewer):
            left = fewer
        else:
            kept.append(index)
    return kept[::-1]


@dataclass
class _Solved:
    """Dofs that do what is wanted, by ridge regression; left out ones do nothing.

    inverse: (D, D) of the normal matrix. amounts: (D, K) of the dofs for each that is wanted.
    missed: (K, K) m², by those that are left out.
    """

    inverse: FloatArray
    amounts: FloatArray
    missed: FloatArray

    @staticmethod
    def of(look: Effects) -> _Solved:
        """All dofs, for what they can do of what is wanted."""
        size = np.linalg.norm(look.done, axis=1, keepdims=True)
        done = look.done / np.maximum(size / CHEAP, 1.0)
        inverse = np.linalg.inv(done @ done.T + DEAR**2 * np.eye(len(done)))
        basis = np.linalg.qr(look.wanted.T)[0].T
        across = done @ basis.T
        missed, parts = np.linalg.eigh(np.eye(len(basis)) - across.T @ inverse @ across)
        amounts = inverse @ across @ parts[:, missed < REACHED**2]
        return _Solved(inverse, amounts, np.zeros((amounts.shape[1],) * 2))

    def without(self, dofs: list[int]) -> _Solved:
        """The same without these dofs."""
        across, amounts = self.inverse[:, dofs], self.amounts[dofs]
        own = np.linalg.inv(self.inverse[np.ix_(dofs, dofs)])
        return _Solved(
            self.inverse - across @ own @ across.T,
            self.amounts - across @ own @ amounts,
            self.missed + amounts.T @ own @ amounts,
        )

    @property
    def worst(self) -> float:
        """Share that is missed of what is wanted and missed most; of nothing, none."""
        return float(np.sqrt(np.linalg.eigvalsh(self.missed).max(initial=0.0)))
