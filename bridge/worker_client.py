"""Client of the worker process: starts, asks and ends it. Its time and crashes are not Blender's.

A request is made and its messages gathered by a thread of its own; the thread that Blender runs on
only polls them (`PendingRequest.news`) or waits for the answer (`PendingRequest.wait`).
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from io import BufferedReader, FileIO
from itertools import count
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Lock, Thread
from time import monotonic
from typing import cast

from ..solver.data.faults import WorkerDied
from ..solver.data.problem import MotionProblem
from ..solver.data.recording import Recording, digest
from ..solver.doctor.repairs import Repairs
from ..solver.kept_memory import KEPT_MEMORY
from ..solver.one_thread import ONE_THREAD
from ..solver.worker.program import LOADING, TIMED_OUT
from ..solver.worker.protocol import (
    PROTOCOL,
    Answer,
    Ending,
    Failed,
    Halt,
    Halted,
    Hello,
    Message,
    Progress,
    ProtocolError,
    Ready,
    Request,
    RequestKind,
    receive,
    send,
)
from .worker_requests import DragStream, PendingRequest

_PROGRAM = Path(__file__).resolve().parents[1] / "solver" / "worker" / "program.py"
_MODULE = "solver.worker.main"  # what it runs
_KEPT_LINES = 20
_LAST_WORDS_S = 2.0
_PATIENCE_S = 2.0  # with a request that was dropped, before the worker is ended for it


class Worker:
    """The worker process: started when it is needed, kept for the fits that it remembers."""

    def __init__(self) -> None:
        self._process: _Process | None = None
        self._pending: PendingRequest | None = None
        self._stream: DragStream | None = None
        self._dropped: tuple[PendingRequest, float] | None = None  # and when
        self._prepared: PendingRequest | None = None  # nobody waits for it
        self._ids = count(1)

    @property
    def busy(self) -> bool:
        """True until polling has consumed the answer of every request that was not dropped."""
        waits = self._pending is not None and self._pending.answer is None
        return waits or self._stream is not None

    @property
    def pid(self) -> int | None:
        """The process's number while it lives."""
        return self._process.pid if self._process is not None and self._process.alive else None

    def ask(
        self,
        kind: RequestKind,
        recording: Recording | None,
        problem: MotionProblem,
        placed: Repairs | None = None,
    ) -> PendingRequest:
        """Makes a request, in a new process if there is none alive.

        recording, placed: as of `Request`. Raises WorkerDied where none can be started,
        RuntimeError while another is under way.
        """
        request = Request(next(self._ids), kind, recording, problem, placed)
        process = self._free_process()
        self._end_preparation(process, request)
        self._pending = PendingRequest(request)
        process.ask(self._pending)
        return self._pending

    def prepare(self, recording: Recording, problem: MotionProblem) -> PendingRequest:
        """Has the worker make what a drag begins with, so that the first ghost need not wait for
        the fit. Nobody need wait for it: a request about another fit, or about none, ends it.
        Raises as `ask` does.
        """
        request = Request(next(self._ids), RequestKind.FOLLOW, recording, problem)
        process = self._free_process()
        self._end_preparation(process, request)
        self._prepared = PendingRequest(request)
        process.ask(self._prepared)
        return self._prepared

    def _end_preparation(self, process: _Process, now: Request) -> None:
        prepared, self._prepared = self._prepared, None
        if prepared is None:
            return
        begun = prepared.request
        assert begun.recording is not None
        fits = now.kind not in (RequestKind.EXAMINE, RequestKind.ANALYSE)
        of_same = now.recording is None or digest(now.recording) == digest(begun.recording)
        if not (fits and of_same and now.problem.known_to_fit() == begun.problem.known_to_fit()):
            process.halt(prepared, Ending.CANCEL)

    def follow(self, recording: Recording) -> DragStream:
        """Begins a drag stream about a recording. Raises as `ask` does."""
        process = self._free_process()
        self._stream = DragStream(recording, self._ids)
        process.ask(self._stream)
        return self._stream

    def _free_process(self) -> _Process:
        if self.busy:
            raise RuntimeError("one request at a time")
        if self._process is None or not self._process.alive or self._stuck():
            self.close()
            self._process = _Process()
        return self._process

    def drop(self) -> None:
        """Nobody waits for the request under way any more; the worker ends it at its next step."""
        if self._stream is not None:
            self._stream.end()
            self._stream = None
        if self.busy and self._process is not None:
            assert self._pending is not None
            self._dropped = (self._pending, monotonic())
            self._process.halt(self._pending, Ending.CANCEL)
        self._pending = None

    def as_it_stands(self) -> None:
        """The request under way shall be answered with the motion as it stands."""
        if self._pending is not None and self._pending.answer is None and self._process is not None:
            self._process.halt(self._pending, Ending.AS_IT_STANDS)

    def close(self) -> None:
        """Ends the process, whatever it is doing; the next request starts another."""
        if self._stream is not None:
            self._stream.end()
        process, self._process, self._pending, self._dropped = self._process, None, None, None
        self._stream = None
        if process is not None:
            process.end()

    def _stuck(self) -> bool:
        """True where a request that was dropped a while ago still goes on, or nobody heard so."""
        if self._dropped is None:
            return False
        dropped, since = self._dropped
        for _ in dropped.news():
            pass  # nobody waits for it
        assert self._process is not None
        heard = self._process.has_halted(dropped)  # by a process that was stopped once it answered
        return not (heard and dropped.answer) and monotonic() - since > _PATIENCE_S


@cache
def shared() -> Worker:
    """The one worker of this Blender."""
    return Worker()


class _Process:
    """One run of the worker program and the pipes to it."""

    def __init__(self) -> None:
        try:
            self._popen = subprocess.Popen(
                [sys.executable, "-I", str(_PROGRAM), _MODULE],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                bufsize=0,  # nothing is left for closing to write
                env={**os.environ, **ONE_THREAD, **KEPT_MEMORY},
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as problem:
            raise WorkerDied(f"{sys.executable} cannot be started: {problem}") from problem
        assert self._popen.stdin is not None
        assert self._popen.stdout is not None
        self._to_worker = self._popen.stdin
        # Without a buffer (above) the pipe is a raw FileIO, which the stubs do not know.
        self._from_worker = BufferedReader(cast(FileIO, self._popen.stdout))
        self._greeted = Event()
        self._silent = Event()  # since nothing more is heard of it
        self._sending = Lock()
        self._asked: SimpleQueue[PendingRequest | DragStream | None] = SimpleQueue()
        self._heard: SimpleQueue[Message | Exception] = SimpleQueue()
        self._halted: set[int] = set()
        self._last_lines: deque[str] = deque(maxlen=_KEPT_LINES)
        self._listener = Thread(target=self._keep_errors, daemon=True)
        self._listener.start()
        Thread(target=self._listen, daemon=True).start()
        Thread(target=self._converse, daemon=True).start()

    @property
    def pid(self) -> int:
        return self._popen.pid

    @property
    def alive(self) -> bool:
        # Of a process that another thread waits for, `poll` says that it lives.
        return not self._silent.is_set() and self._popen.poll() is None

    def ask(self, asked: PendingRequest | DragStream) -> None:
        """Has the requests made once those before them are answered; never waits."""
        self._asked.put(asked)

    def halt(self, pending: PendingRequest, how: Ending) -> None:
        """Tells the worker to end a request; never waits."""
        Thread(target=self._halt, args=(Halt(pending.request.id, how),), daemon=True).start()

    def has_halted(self, pending: PendingRequest) -> bool:
        """True where the worker has heard that a request is halted."""
        return pending.request.id in self._halted

    def _halt(self, halt: Halt) -> None:
        _survive_broken_pipes()
        self._greeted.wait()  # of who is not greeted first a worker wants nothing
        with suppress(OSError, ValueError):  # a worker that has gone has ended it
            self._send(halt)

    def _converse(self) -> None:
        """Makes requests one after another, on a thread of its own."""
        _survive_broken_pipes()
        while (asked := self._asked.get()) is not None:
            for request in asked.requests():
                self._meet(request, asked.deliver)
                if not self.alive:
                    break

    def _meet(self, request: Request, deliver: Callable[[Progress | Answer], None]) -> None:
        try:
            for message in self._talk(request):
                deliver(message)
        except (OSError, ValueError, EOFError):  # ValueError: the pipe was closed by end()
            deliver(Failed(request.id, WorkerDied(self._last_words())))
        except ProtocolError as problem:
            self._popen.kill()
            self._popen.wait()
            deliver(Failed(request.id, WorkerDied(str(problem))))
        except BaseException as problem:
            # A mistake of ours; somebody waits for an answer all the same.
            deliver(Failed(request.id, WorkerDied(repr(problem))))
            raise

    def end(self) -> None:
        """Kills the process and lets go of it."""
        self._popen.kill()
        self._popen.wait()
        self._greeted.set()  # for who waits to halt something
        self._asked.put(None)
        with self._sending:  # else what is being sent may go into a pipe that takes this number
            self._to_worker.close()
        self._listener.join(_LAST_WORDS_S)
        for pipe in (self._from_worker, self._popen.stderr):
            assert pipe is not None
            pipe.close()

    def _talk(self, request: Request) -> Iterator[Progress | Answer]:
        if not self._greeted.is_set():
            self._greet()
        self._send(request)
        while True:
            message = self._hear()
            if (
                isinstance(message, Hello | Ready | Request | Halt | Halted)
                or message.id != request.id
            ):
                raise ProtocolError(f"{type(message).__name__} was not asked for")
            yield message
            if not isinstance(message, Progress):
                return

    def _send(self, message: Message) -> None:
        with self._sending:
            send(self._to_worker, message)

    def _greet(self) -> None:
        self._send(Hello(PROTOCOL, tuple(p for p in sys.path if p)))
        ready = self._hear()
        if not isinstance(ready, Ready) or ready.protocol != PROTOCOL:
            raise ProtocolError(f"{ready} is no greeting of version {PROTOCOL}")
        self._greeted.set()

    def _hear(self) -> Message:
        heard = self._heard.get()
        if isinstance(heard, Exception):
            self._heard.put(heard)  # for who asks next
            raise heard
        return heard

    def _listen(self) -> None:
        """Hears the worker out, on a thread of its own. Who talks nonsense or no more is ended, for
        one that does not listen either would be written to for ever."""
        try:
            while (message := receive(self._from_worker)) is not None:
                if isinstance(message, Halted):
                    self._halted.add(message.id)
                else:
                    self._heard.put(message)
            self._silent.set()
            self._heard.put(EOFError())
        except (OSError, ValueError, ProtocolError) as problem:  # ValueError: closed by end()
            self._silent.set()
            self._heard.put(problem)
        except BaseException as problem:
            # A mistake of ours; who waits for an answer must hear that nobody listens any more, and
            # who is sending, whose pipe is broken then, why.
            self._last_lines.append(repr(problem))
            self._heard.put(ProtocolError(repr(problem)))
            self._popen.kill()
            raise
        with suppress(subprocess.TimeoutExpired):
            self._popen.wait(_LAST_WORDS_S)
        self._popen.kill()

    def _keep_errors(self) -> None:
        assert self._popen.stderr is not None
        for line in self._popen.stderr:
            self._last_lines.append(line.decode(errors="replace").strip())

    def _last_words(self) -> str:
        """Cause of its end: the last line of its error stream, and its exit code."""
        with suppress(subprocess.TimeoutExpired):
            self._popen.wait(_LAST_WORDS_S)
        self._popen.kill()  # one that has closed its pipe and stays would be waited for in vain
        code = self._popen.wait()
        self._listener.join(_LAST_WORDS_S)
        said = [line for line in self._last_lines if line]
        if any(line.startswith(TIMED_OUT) for line in said):
            return f"it could not load in {LOADING:g} s; there may be too little memory"
        return f"{said[-1]} (exit code {code})" if said else f"exit code {code}"


def _survive_broken_pipes() -> None:
    """Have this thread get an error where the worker no longer listens.

    Blender, unlike Python by itself, leaves the signal for it as it is, which ends the program.
    """
    if hasattr(signal, "pthread_sigmask"):  # Windows has no such signal
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
