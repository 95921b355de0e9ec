"""Which cells wait, run and have ended on a farm; no word of Dask here, so that it is easily tested.

The first cell of a clip with a recipe goes alone and brings their fit back; the others with these
wait for it, so that no fit is solved twice.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from statistics import median

from ..records.manifest import CellPlan

MOST_TRIES = 4  # of a cell that fails, or whose worker ends meanwhile
SLOW = 3.0  # times the median; an idle worker then takes the cell as well
SLOW_LEAST = 30.0  # s


Pair = tuple[str, str]  # a clip's hash and a recipe: their cells share a fit


def pair_of(plan: CellPlan) -> Pair:
    return plan.clip_sha256, plan.recipe


@dataclass(frozen=True)
class Attempt:
    """A cell on a worker. began: s, of a monotonic clock."""

    plan: CellPlan
    worker: str
    began: float


@dataclass
class Attempts:
    """The cells of one run. waiting: in the manifest's order."""

    waiting: deque[CellPlan]
    running: list[Attempt] = field(default_factory=list)
    ended: set[str] = field(default_factory=set)
    tries: Counter[str] = field(default_factory=Counter)
    failed_on: dict[str, set[str]] = field(default_factory=dict)  # workers, by cells
    fitted: set[Pair] = field(default_factory=set)
    took: list[float] = field(default_factory=list)  # s, of the cells that ended

    @staticmethod
    def of(plans: Iterable[CellPlan], fitted: Iterable[Pair] = ()) -> Attempts:
        """fitted: pairs that have a fit already."""
        return Attempts(deque(plans), fitted=set(fitted))

    @property
    def over(self) -> bool:
        """Whether every cell has ended."""
        open_cells = {each.plan.cell for each in self.running} - self.ended
        return not self.waiting and not open_cells

    def load(self, worker: str) -> int:
        """Cells that run on a worker."""
        return sum(each.worker == worker for each in self.running)

    def next_for(self, worker: str, now: float, others: Collection[str] = ()) -> Attempt | None:
        """What a worker with nothing to do begins: a cell that waits and may run, else one that
        takes too long on another; None where there is none.

        others: workers, who take first what failed on this one.
        """
        plan = self._ready(worker, set(others) - {worker}) or self._slow(worker, now)
        if plan is None:
            return None
        attempt = Attempt(plan, worker, now)
        self.running.append(attempt)
        return attempt

    def _ready(self, worker: str, others: set[str]) -> CellPlan | None:
        leading = {pair_of(each.plan) for each in self.running} - self.fitted
        for place, plan in enumerate(self.waiting):
            failed_on = self.failed_on.get(plan.cell, set())
            elsewhere = worker in failed_on and others - failed_on
            if pair_of(plan) not in leading and not elsewhere:
                del self.waiting[place]
                return plan
        return None

    def _slow(self, worker: str, now: float) -> CellPlan | None:
        if self.waiting or not self.took:
            return None
        long = max(SLOW_LEAST, SLOW * median(self.took))
        times = Counter(each.plan.cell for each in self.running)
        for each in self.running:
            alone = times[each.plan.cell] == 1 and each.plan.cell not in self.ended
            if alone and each.worker != worker and now - each.began > long:
                return each.plan
        return None

    def end(self, attempt: Attempt, now: float) -> bool:
        """An attempt has brought a result. False where another one of the same cell did before."""
        self.running.remove(attempt)
        self.fitted.add(pair_of(attempt.plan))
        if attempt.plan.cell in self.ended:
            return False
        self.ended.add(attempt.plan.cell)
        self.took.append(now - attempt.began)
        return True

    def again(self, attempt: Attempt, *, blame: bool = True) -> bool:
        """An attempt came to nothing; the cell waits anew, before all others.

        blame: whether it may be the cell's fault. False where it was tried too often.
        """
        self.running.remove(attempt)
        cell = attempt.plan.cell
        self.tries[cell] += blame
        if blame:
            self.failed_on.setdefault(cell, set()).add(attempt.worker)
        if self.tries[cell] >= MOST_TRIES:
            return False
        elsewhere = any(each.plan.cell == cell for each in self.running)
        if cell not in self.ended and not elsewhere:
            self.waiting.appendleft(attempt.plan)
        return True

    def give_up(self, plan: CellPlan) -> bool:
        """A cell that was tried too often has ended as well; False where it had before."""
        new = plan.cell not in self.ended
        self.ended.add(plan.cell)
        return new
