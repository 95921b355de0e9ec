"""Which cells wait, run and have ended; no word of processes or Dask here, so that it is easily
tested.

The cells of a clip with a recipe share a fit. The first of them goes alone and makes it, so that no
fit is solved twice; a worker goes on with the clip whose fit it remembers.
"""

from __future__ import annotations

from collections import Counter, OrderedDict, deque
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from statistics import median

from ..records.manifest import CellPlan

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
    """The cells of one run.

    most_tries: of a cell that fails, or whose worker ends meanwhile. eager: whether a worker that
    has nothing else begins a cell whose fit is being solved, for which it then waits itself.
    waiting: in the manifest's order. on: cells that run, by workers and by pairs.
    """

    most_tries: int
    eager: bool = False
    waiting: OrderedDict[Pair, deque[CellPlan]] = field(default_factory=OrderedDict)
    running: list[Attempt] = field(default_factory=list)
    on: Counter[str | Pair] = field(default_factory=Counter)
    last: dict[str, Pair] = field(default_factory=dict)  # of each worker
    ended: set[str] = field(default_factory=set)
    tries: Counter[str] = field(default_factory=Counter)
    failed_on: dict[str, set[str]] = field(default_factory=dict)  # workers, by cells
    fitted: set[Pair] = field(default_factory=set)
    took: list[float] = field(default_factory=list)  # s, of the cells that ended

    def add(self, plans: Iterable[CellPlan]) -> Attempts:
        """Cells that wait; the same queue."""
        for plan in plans:
            self.waiting.setdefault(pair_of(plan), deque()).append(plan)
        return self

    @property
    def over(self) -> bool:
        """Whether every cell has ended."""
        return not self.waiting and all(each.plan.cell in self.ended for each in self.running)

    @property
    def n_waiting(self) -> int:
        return sum(map(len, self.waiting.values()))

    def load(self, worker: str) -> int:
        """Cells that run on a worker."""
        return self.on[worker]

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
        self.on.update((worker, pair_of(plan)))
        self.last[worker] = pair_of(plan)
        return attempt

    def _ready(self, worker: str, others: set[str]) -> CellPlan | None:
        last = self.last.get(worker)
        pairs = list(self.waiting)
        if last is not None and last in self.waiting:
            pairs.insert(0, last)
        free = [pair for pair in pairs if pair in self.fitted or not self.on[pair]]
        found = (self._of_pair(pair, worker, others) for pair in (free or pairs[: self.eager]))
        return next((plan for plan in found if plan is not None), None)

    def _of_pair(self, pair: Pair, worker: str, others: set[str]) -> CellPlan | None:
        plans = self.waiting[pair]
        for place, plan in enumerate(plans):
            failed_on = self.failed_on.get(plan.cell, set())
            if worker not in failed_on or not others - failed_on:
                del plans[place]
                if not plans:
                    del self.waiting[pair]
                return plan
        return None

    def _slow(self, worker: str, now: float) -> CellPlan | None:
        if self.waiting or not self.took:
            return None
        long = max(SLOW_LEAST, SLOW * median(self.took))
        times = Counter(each.plan.cell for each in self.running)
        for each in self.running:
            cell = each.plan.cell
            alone = times[cell] == 1 and cell not in self.ended
            helpful = each.worker != worker and self.tries[cell] < self.most_tries
            if alone and helpful and now - each.began > long:
                return each.plan
        return None

    def end(self, attempt: Attempt, now: float) -> bool:
        """An attempt has brought a result. False where another one of the same cell did before."""
        self._stop(attempt)
        self.fitted.add(pair_of(attempt.plan))
        if attempt.plan.cell in self.ended:
            return False
        self.ended.add(attempt.plan.cell)
        self.took.append(now - attempt.began)
        return True

    def again(self, attempt: Attempt, *, blame: bool = True) -> bool:
        """An attempt came to nothing: the cell waits anew, before all others, but where another
        attempt of it has ended or still runs, which then decides.

        blame: whether it may be the cell's fault. False where it was tried too often, so that it
        has ended with this.
        """
        self._stop(attempt)
        cell = attempt.plan.cell
        if blame:
            self.tries[cell] += 1
            self.failed_on.setdefault(cell, set()).add(attempt.worker)
        if cell in self.ended or any(each.plan.cell == cell for each in self.running):
            return True
        if self.tries[cell] >= self.most_tries:
            self.ended.add(cell)
            return False
        pair = pair_of(attempt.plan)
        self.waiting.setdefault(pair, deque()).appendleft(attempt.plan)
        self.waiting.move_to_end(pair, last=False)
        return True

    def give_up(self, attempt: Attempt) -> None:
        """An attempt is not made again, and its cell has ended with it."""
        self._stop(attempt)
        self.ended.add(attempt.plan.cell)

    def _stop(self, attempt: Attempt) -> None:
        self.running.remove(attempt)
        self.on.subtract((attempt.worker, pair_of(attempt.plan)))
