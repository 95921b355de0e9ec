"""Requests to the worker: a pending one, and the stream of them while something is dragged."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from queue import Empty, SimpleQueue
from threading import Condition
from time import monotonic

from ..solver.data.problem import MotionProblem
from ..solver.data.recording import Recording
from ..solver.data.status import DragStatus
from ..solver.worker.protocol import Answer, Followed, Progress, Request, RequestKind


class PendingRequest:
    """Pending request; `answer` is set once polling has consumed the reply."""

    def __init__(self, request: Request) -> None:
        self.request = request
        self.answer: Answer | None = None
        self._arrived: SimpleQueue[Progress | Answer] = SimpleQueue()

    def requests(self) -> Iterator[Request]:
        """This one alone."""
        yield self.request

    def deliver(self, message: Progress | Answer) -> None:
        """Called by the thread that listens to the worker."""
        self._arrived.put(message)

    def news(self) -> Iterator[Progress | Answer]:
        """Messages that arrived since the last poll; never waits."""
        while self.answer is None:
            try:
                yield self._seen(self._arrived.get_nowait())
            except Empty:
                return

    def wait(self, told: Callable[[Progress], None] | None = None) -> Answer:
        """The answer, however long it takes; each progress is told on the way."""
        while self.answer is None:
            message = self._seen(self._arrived.get())
            if told is not None and isinstance(message, Progress):
                told(message)
        return self.answer

    def _seen(self, message: Progress | Answer) -> Progress | Answer:
        if not isinstance(message, Progress):
            self.answer = message
        return message


class DragStream:
    """Stream of requests during a drag, each about the latest problem. The next one leaves once the
    last one's answer is polled: the worker computes while Blender draws that, and no ghosts that
    nobody sees, which would take the processor from the drawing."""

    def __init__(self, recording: Recording, ids: Iterator[int]) -> None:
        self._recording: Recording | None = recording
        self._ids = ids
        self._changed = Condition()
        self._problem: MotionProblem | None = None
        self._ahead = self._asked_ahead = False  # of `_problem`, and of what was asked last
        self._ended = self._answered = False  # answered: by what has not been polled yet
        self._arrived: SimpleQueue[Progress | Answer] = SimpleQueue()

    def want(self, problem: MotionProblem, *, ahead: bool = False) -> None:
        """Sets the problem to follow from now on. ahead: nothing has moved yet; the worker makes
        ready, once, and the motion that it answers is no news."""
        with self._changed:
            self._problem, self._ahead = problem, ahead
            self._changed.notify()

    def end(self) -> None:
        """Ends the stream."""
        with self._changed:
            self._ended = True
            self._changed.notify()

    def news(self) -> Iterator[Progress | Answer]:
        """Messages that arrived since the last poll; never waits."""
        while True:
            try:
                message = self._arrived.get_nowait()
            except Empty:
                return
            unseen = self._asked_ahead and isinstance(message, Followed)
            if not isinstance(message, Progress):
                self._go_on(None if unseen else message)
            if not unseen:
                yield message

    def first_news(self, seconds: float) -> Iterator[Progress | Answer]:
        """The same, after a wait of at most so many seconds for a motion that is news: not for one
        while the worker tells of a fit, which takes longer."""
        until = monotonic() + seconds
        found: list[Progress | Answer] = []
        while not (found or self._ended) and (left := until - monotonic()) > 0.0:
            with self._changed:
                self._changed.wait_for(lambda: not self._arrived.empty() or self._ended, left)
            found = list(self.news())
        yield from found

    def _go_on(self, seen: Answer | None) -> None:
        """The next may leave: a motion that is seen, and still on its way, is asked again."""
        with self._changed:
            self._answered = False
            if isinstance(seen, Followed) and seen.status is DragStatus.CONVERGING:
                self._problem = self._problem or self._last
            self._changed.notify()

    def requests(self) -> Iterator[Request]:
        """The requests one after another; waits while there is nothing new. Runs on the thread that
        listens to the worker, which delivers what comes before it takes the next."""
        problem: MotionProblem | None = None
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ended or self._wanted)
                if self._ended:
                    return
                problem, self._problem = self._problem, None
                self._asked_ahead, self._ahead = self._ahead, False
            assert problem is not None
            self._last = problem
            yield Request(next(self._ids), RequestKind.FOLLOW, self._recording, problem)
            self._recording = None  # the worker knows it now

    @property
    def _wanted(self) -> bool:
        return self._problem is not None and not self._answered

    def deliver(self, message: Progress | Answer) -> None:
        """Called by the thread that listens."""
        with self._changed:
            self._answered = not isinstance(message, Progress)
            self._arrived.put(message)
            self._changed.notify_all()
