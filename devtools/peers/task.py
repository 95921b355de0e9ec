"""One adaptation as plain mathematics, the same for every solver that is compared.

    min 1/2 (x - x0) . W (x - x0)   subject to   lower <= C(x) <= upper

with our rows C, and bounds widened by the violation that our own solver lets stand.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.problem import MotionProblem
from ...solver.fitting.fit import Fit
from ...solver.numerics.block_banded import BlockBanded
from ...solver.numerics.splines import ORDER
from ...solver.optimisation.sqp import worst_violation
from ...solver.stages.setup import set_up
from ...solver.stages.warm_start import stance_moves, warm_start
from ...solver.transcription.rows import Rows
from ...solver.transcription.transcription import Transcription

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
        still = setup.fitted.with_places(setup.start.places)
        moves = stance_moves(setup.schedule, still, setup.target, setup.turns)
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


class Equations:
    """The task's rows as a function of the packed unknowns (n,), with a sparse Jacobian.

    pattern: the Jacobian's entries (count, size), each with its number from one on."""

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
        self._used = self._nonzero() & (columns >= 0)
        row = np.broadcast_to(np.arange(self.count)[:, None, None], columns.shape)[self._used]
        entries = (1 + np.arange(len(row)), (row, columns[self._used]))
        self.pattern = csc_matrix(entries, (self.count, self.size))

    def _nonzero(self) -> BoolArray:
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

    def jacobian(self, packed: FloatArray) -> tuple[FloatArray, csc_matrix]:
        """Values (count,) and the Jacobian (count, size), its entries those of the pattern."""
        rows, pattern = self.task.rows(self.task.unpack(packed)), self.pattern
        entries = rows.jacobian[self._used][pattern.data - 1]
        return rows.value, csc_matrix((entries, pattern.indices, pattern.indptr), pattern.shape)


def metric_matrix(task: Task) -> csc_matrix:
    """The metric over the unknowns that exist, (n, n)."""
    active = task.transcription.active
    count = len(active)
    number = np.arange(active.size).reshape(active.shape)
    matrix = csc_matrix((active.size, active.size))
    for j, blocks in enumerate(task.metric.lower):
        row, column = np.broadcast_arrays(number[j:, :, None], number[: count - j, None, :])
        where = row.ravel(), column.ravel()
        part = csc_matrix((blocks[: count - j].ravel(), where), matrix.shape)
        matrix += part + part.T if j else part
    kept = np.flatnonzero(active)
    found = matrix[kept][:, kept]
    found.eliminate_zeros()
    return found
