"""The local runner: hands the cells of a batch to worker processes until each has its result."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from time import monotonic

from ..queue.attempts import Attempt, Attempts
from ..records.aside import remove_abandoned
from ..records.failure import write_failure
from ..records.faults import BatchFault, FolderGone
from ..records.manifest import Manifest
from ..records.result import CELLS, FITS, lasting_result, read_result
from .memory import MemoryWatch
from .progress import Progress
from .workers import Message, WorkerProcess

MOST_TRIES = 2  # of a cell whose worker ends
MOST_STILLBORN = 2  # workers in a row that end before they began
POLL_S = 0.5
CELL_LIMIT_S = 3600.0  # a cell takes seconds, or minutes where its clip does


@dataclass
class LocalRun:
    """One run of a batch's cells that have no final result.

    command: that starts a worker. jobs: how many work at once. cell_limit: s, after which a cell
    has failed. The caller holds the folder's lock.
    """

    folder: Path
    manifest: Manifest
    jobs: int
    command: Sequence[str]
    progress: Progress
    memory: MemoryWatch = field(default_factory=MemoryWatch)
    cell_limit: float = CELL_LIMIT_S

    def __post_init__(self) -> None:
        waiting = [c for c in self.manifest.cells if lasting_result(self.folder, c.cell) is None]
        self._attempts = Attempts(MOST_TRIES, eager=True).add(waiting)
        self._stillborn = 0
        self._workers: list[WorkerProcess] = []
        self._at: dict[WorkerProcess, Attempt] = {}
        self._news: SimpleQueue[tuple[WorkerProcess, Message | None]] = SimpleQueue()

    def run(self) -> None:
        """Until every cell has a result. Raises BatchFault; whatever ends it, no worker stays."""
        for name in (CELLS, FITS):
            remove_abandoned(self.folder / name)
        try:
            while not self._attempts.over:
                self._hand_out()
                self._hear()
                self._end_late()
        finally:
            for worker in self._workers:
                worker.end()
            for name in (CELLS, FITS):
                with suppress(OSError):
                    remove_abandoned(self.folder / name)

    def _hand_out(self) -> None:
        """Gives cells to who has none, as far as memory goes; one works whatever there is."""
        while self._attempts.waiting:
            idle = next((w for w in self._workers if w.ready and w not in self._at), None)
            if idle is None:
                starting = sum(1 for w in self._workers if not w.ready)
                if len(self._workers) >= self.jobs or starting >= self._attempts.n_waiting:
                    return
            others = any(w in self._at or not w.ready for w in self._workers)
            if others and not self.memory.fits(0 if idle is None else idle.rss):
                return  # it waits until another has ended
            if idle is None:
                self._workers.append(WorkerProcess(self.command, self.folder, self._news))
                continue
            attempt = self._attempts.next_for(str(idle.pid), monotonic())
            assert attempt is not None
            self._at[idle] = attempt
            idle.solve(attempt.plan.cell)

    def _hear(self) -> None:
        """One message of a worker, or none for a while."""
        try:
            worker, message = self._news.get(timeout=POLL_S)
        except Empty:
            self.progress.tick()
            return
        if worker not in self._workers:
            return  # last words of one that was late
        if message is None:
            self._died(worker)
            return
        self._stillborn = 0
        worker.rss = message.get("rss", worker.rss)
        if "stop" in message:
            raise FolderGone(message["stop"])
        if "ready" in message:
            worker.ready = True
            return
        self.memory.told(message["peak"])
        self._ended(self._at.pop(worker))

    def _ended(self, attempt: Attempt) -> None:
        cell = attempt.plan.cell
        result = read_result(self.folder, cell)
        if result is None:
            raise FolderGone(
                f"The result of cell {cell} is not in {self.folder / CELLS}, where it was put; see "
                "what becomes of that folder, then give the same command again."
            )
        self._attempts.end(attempt, monotonic())
        self.progress.ended(attempt.plan, result)

    def _died(self, worker: WorkerProcess) -> None:
        """A worker ended: its cell is done again, or told as failed where it is to blame."""
        self._workers.remove(worker)
        how, attempt = worker.how_it_ended(), self._at.pop(worker, None)
        if attempt is None:
            self._stillborn += not worker.ready
            if self._stillborn >= MOST_STILLBORN:
                raise BatchFault(f"No worker process can be started: one ended {how}.")
            return
        cell = attempt.plan.cell
        if lasting_result(self.folder, cell) is not None:
            self._ended(attempt)  # it had finished
        elif self._attempts.again(attempt):
            self.progress.note(f"A worker ended {how}; cell {cell} is done again.")
        else:
            sentence = (
                f"The worker that solved it ended {MOST_TRIES} times, the last time {how}; where "
                "the system has ended it for want of memory, use fewer --jobs."
            )
            self.progress.ended(attempt.plan, write_failure(self.folder, cell, sentence))

    def _end_late(self) -> None:
        """Ends who has been at a cell for longer than the limit; the next run tries it again."""
        now = monotonic()
        for worker, attempt in list(self._at.items()):
            if now - attempt.began <= self.cell_limit:
                continue
            del self._at[worker]
            self._workers.remove(worker)
            worker.end()
            cell = attempt.plan.cell
            if lasting_result(self.folder, cell) is not None:
                self._ended(attempt)  # it had finished
                continue
            sentence = (
                f"It took longer than {self.cell_limit:g} s and was ended; give it more by "
                "--cell-limit, or leave it out."
            )
            self._attempts.give_up(attempt)
            self.progress.ended(attempt.plan, write_failure(self.folder, cell, sentence))
