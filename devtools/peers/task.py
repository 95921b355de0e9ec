"""One adaptation as plain mathematics, the same for every solver that is compared.

    min 1/2 (x - x0) . W (x - x0)   subject to   lower <= C(x) <= upper

with our rows C, and bounds widened by the violation that our own solver lets stand.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...solver.data.problem import MotionProblem
from ...solver.numerics.block_banded import BlockBanded
from ...solver.numerics.splines import ORDER
from ...solver.optimisation.sqp import worst_violation
from ...solver.stages.fit import Fit
from ...solver.stages.setup import set_up
from ...solver.stages.warm_start import stance_moves, warm_start
from ...solver.transcription.rows import Rows
from ...solver.transcription.transcription import Transcription

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int_]


SOLVED = 1.1  # a solver meets the bounds within a tolerance of its own: a tenth of ours


@dataclass(frozen=True)
class Task:
    """transcription: the rows C, pins at places (n_contacts, 3) m. start: x0 (K, n_block), the fit
    carried along with the pins. metric: W."""

    transcription: Transcription
    places: FloatArray
    start: FloatArray
    metric: BlockBanded

    @staticmethod
    def of(fit: Fit, problem: MotionProblem) -> "Task":
        """The adaptation of a fit to a problem, in one stage."""
        setup = set_up(fit, problem)
        moves = stance_moves(setup.schedule, setup.start.places, setup.target_places, setup.turns)
        start = warm_start(setup.start, moves)
        return Task(setup.start.transcription, setup.target_places, start, setup.metric)

    def rows(self, x: FloatArray) -> Rows:
        """The rows at x (K, n_block)."""
        return self.transcription.rows(x, self.places)

    def violation(self, x: FloatArray) -> float:
        """Worst violation of x (K, n_block) over its tolerance; at most 1 when solved."""
        return worst_violation(self.rows(x))

    def distance(self, x: FloatArray) -> float:
        """How far x (K, n_block) is from the start, in the metric."""
        step = x - self.start
        return float(np.sqrt((step * self.metric.times(step)).sum()))

    def unpack(self, packed: FloatArray) -> FloatArray:
        """(K, n_block) from the unknowns that exist, (n,)."""
        x = self.start.copy()
        x[self.transcription.active] = packed
        return x


@dataclass(frozen=True)
class PeerResult:
    """How a solver fared. seconds: from its first iteration to its last unknowns x (K, n_block);
    setup: what passed before. violation: worst over tolerance, at most 1 when
    solved; distance: from the start, in the metric."""

    seconds: float
    setup: float
    iterations: int
    status: str
    violation: float
    distance: float
    x: FloatArray

    @property
    def solved(self) -> bool:
        return self.violation <= SOLVED


def judged(
    task: Task, x: FloatArray, seconds: float, setup: float, iterations: int, status: str
) -> PeerResult:
    """A peer's last unknowns (K, n_block), judged by our rows and not by its own word."""
    return PeerResult(seconds, setup, iterations, status, task.violation(x), task.distance(x), x)


@dataclass(frozen=True)
class Entries:
    """Where a sparse matrix may differ from zero: row and column (nnz,), columns first."""

    row: IntArray
    column: IntArray

    @staticmethod
    def sorted(row: IntArray, column: IntArray) -> tuple["Entries", IntArray]:
        """Entries in order, and the order that the values must take."""
        order = np.lexsort((row, column))
        return Entries(row[order], column[order]), order

    def starts(self, columns: int) -> list[int]:
        """(columns + 1,) where each column begins."""
        return [int(i) for i in np.searchsorted(self.column, np.arange(columns + 1))]


class Equations:
    """The task's rows as a function of the packed unknowns (n,), with a sparse Jacobian."""

    def __init__(self, task: Task) -> None:
        self.task = task
        t = task.transcription
        rows = task.rows(task.start)
        self.count, self.size = len(rows.value), t.n_unknowns
        self.kind = rows.kind
        self.lower, self.upper = rows.lower - rows.tolerance, rows.upper + rows.tolerance
        number = np.full(t.active.shape, -1)
        number[t.active] = np.arange(self.size)
        columns = number[t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)]
        self._used = self._pattern() & (columns >= 0)
        row = np.broadcast_to(np.arange(self.count)[:, None, None], columns.shape)[self._used]
        self.entries, self._order = Entries.sorted(row, columns[self._used])

    def _pattern(self) -> NDArray[np.bool_]:
        """Entries that differ from zero at some of a few random places."""
        random = np.random.default_rng(0)
        start = self.task.start
        used = np.zeros(self.task.rows(start).jacobian.shape, dtype=bool)
        for _ in range(3):
            near = start + 0.1 * random.normal(size=start.shape)
            used |= self.task.rows(near).jacobian != 0.0
        return used

    def values(self, packed: FloatArray) -> FloatArray:
        """(count,)"""
        task = self.task
        return task.transcription.values(task.unpack(packed), task.places)

    def jacobian(self, packed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values (count,) and the Jacobian's entries in the order of `entries`."""
        rows = self.task.rows(self.task.unpack(packed))
        return rows.value, rows.jacobian[self._used][self._order]


def metric_entries(task: Task) -> tuple[Entries, FloatArray]:
    """The metric over the unknowns that exist: where, and its values."""
    active, lower = task.transcription.active, task.metric.lower
    count, n = active.shape
    band = len(lower) - 1
    wide = np.zeros((count, n, 2 * band + 1, n))
    for j in range(band + 1):
        blocks = lower[j][: count - j]
        wide[j:, :, band - j] = blocks
        wide[: count - j, :, band + j] = np.swapaxes(blocks, 1, 2)
    at = np.argwhere(wide != 0.0)
    row = at[:, 0] * n + at[:, 1]
    column = (at[:, 0] + at[:, 2] - band) * n + at[:, 3]
    inside = (column >= 0) & (column < count * n)
    inside[inside] &= active.ravel()[row[inside]] & active.ravel()[column[inside]]
    number = np.cumsum(active.ravel()) - 1
    entries, order = Entries.sorted(number[row[inside]], number[column[inside]])
    return entries, wide[tuple(at[inside].T)][order]
