"""The worker process killed, stopped, starved, and its pipe cut or fed garbage, at random moments.

Whoever asked gets an answer or hears that the worker died; the next question is answered.
"""

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ....bridge import worker_client
from ....bridge.worker_client import Worker
from ....bridge.worker_requests import PendingRequest
from ....solver.data.problem import MotionProblem, Pin
from ....solver.worker.program import LOADING
from ....solver.worker.protocol import PROTOCOL, Analysed, Failed, Hello, Request, RequestKind, send
from ...processes import LAUNCHER
from ...recordings import HELD, JUMP, read
from ..protocol.case import Family, HostileCase, LeftBehind

SPAN = (150.0, 260.0)
PATIENCE = 2.1  # s, after which a worker that does not hear is replaced
PROBLEM = MotionProblem(frames=SPAN, pins=(Pin("up", "ground 2", offset=(0.0, 0.0, 0.05)),))

# Greets as it should where told so, then says what it is given, and goes or stays.
FALSE = """
import os, runpy, sys, time
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker.protocol import PROTOCOL, Ready, receive, send
receive(sys.stdin.buffer)
if {greets}:
    send(sys.stdout.buffer, Ready(PROTOCOL))
sys.stdout.buffer.write(bytes.fromhex({said!r}))
sys.stdout.buffer.flush()
if {closes}:
    os.close(1)
if {stays}:
    time.sleep(1000)
"""


def killed(case: HostileCase) -> None:
    """SIGKILL, at any moment."""
    _abused(case, _kill)


def stopped(case: HostileCase) -> None:
    """SIGSTOP; the artist then cancels, and asks anew."""
    with _Asked.about(case) as asked:
        time.sleep(case.rng.uniform(0.0, 2.0))
        os.kill(asked.pid, signal.SIGSTOP)
        time.sleep(0.1)
        asked.worker.drop()
        time.sleep(PATIENCE)
        asked.again()


def starved(case: HostileCase) -> None:
    """A limit on its memory."""
    size = int(10 ** case.rng.uniform(7.0, 9.3))

    def starve(pid: int) -> None:
        resource.prlimit(pid, resource.RLIMIT_AS, (size, size))

    _abused(case, starve)


def dropped(case: HostileCase) -> None:
    """Requests dropped and made again at once; the worker is told to halt one it has answered."""
    with _Asked.about(case) as asked:
        for _ in range(int(case.rng.integers(1, 5))):
            time.sleep(case.rng.uniform(0.0, 0.3))
            asked.worker.drop()
            asked.ask(case)
        asked.worker.as_it_stands()
        asked.answer()
        asked.again()


def false_worker(case: HostileCase) -> None:
    """A worker that answers with garbage, or closes its pipe."""
    said = case.rng.bytes(int(case.rng.integers(0, 60)))
    if case.chance(0.3):
        said = int(case.rng.integers(0, 2**40)).to_bytes(8, "little") + said
    program = case.folder / "worker.py"
    how = {flag: case.chance(0.5) for flag in ("greets", "closes", "stays")}
    how["closes"] = how["closes"] or how["stays"]
    program.write_text(FALSE.format(loader=str(LAUNCHER), said=said.hex(), **how))
    usual, worker_client._PROGRAM = worker_client._PROGRAM, program
    try:
        with _Asked.about(case) as asked:
            worker_client._PROGRAM = usual
            asked.answer()
            asked.again()
    finally:
        worker_client._PROGRAM = usual


def fed_garbage(case: HostileCase) -> None:
    """The worker's own pipe: cut, or with garbage in it. It ends by itself."""
    program = [sys.executable, "-I", str(worker_client._PROGRAM)]
    worker = subprocess.Popen(program, stdin=-1, stdout=-3, stderr=-3, bufsize=0)
    assert worker.stdin is not None
    try:
        message = case.folder / "message"
        with message.open("wb") as file:
            send(file, Hello(PROTOCOL, tuple(p for p in sys.path if p)))
            hello = file.tell()
            send(file, Request(1, RequestKind.ANALYSE, read(HELD / JUMP), PROBLEM))
        data = bytearray(message.read_bytes())
        first = case.pick((0, hello))
        at = int(case.rng.integers(first, min(len(data), first + 400)))
        junk = case.rng.bytes(int(case.rng.integers(1, 40)))
        data[at : at + len(junk)] = junk
        if case.chance(0.4):
            del data[at:]
        worker.stdin.write(data)
        case.taken_on = True
        time.sleep(case.rng.uniform(0.0, 0.5))
        worker.stdin.close()
        worker.wait()
    except BrokenPipeError:
        worker.wait()
    finally:
        worker.kill()
        worker.wait()


@dataclass
class _Asked:
    """A worker of its own, and the request that is under way."""

    worker: Worker
    pending: PendingRequest

    @staticmethod
    def about(case: HostileCase) -> "_Asked":
        worker = Worker()
        return _Asked(worker, _ask(worker, case))

    def __enter__(self) -> "_Asked":
        self._pid = self.worker.pid
        return self

    def __exit__(self, *_: object) -> None:
        pid = self.worker.pid
        self.worker.close()
        for each in (self._pid, pid):
            if each is not None and Path(f"/proc/{each}").exists():
                raise LeftBehind(f"process {each}")

    @property
    def pid(self) -> int:
        assert self.worker.pid is not None
        return self.worker.pid

    def ask(self, case: HostileCase) -> None:
        self.pending = _ask(self.worker, case)

    def answer(self) -> object:
        return self.pending.wait()

    def again(self) -> None:
        """The next question is answered."""
        if self.worker.busy:
            self.worker.drop()
        problem = MotionProblem(frames=SPAN)
        answer = self.worker.ask(RequestKind.ANALYSE, read(HELD / JUMP), problem).wait()
        if not isinstance(answer, Analysed):
            raise TypeError(f"the next question was answered by {answer}")


def _ask(worker: Worker, case: HostileCase) -> PendingRequest:
    case.taken_on = True
    kind = case.pick((RequestKind.ANALYSE, RequestKind.FIT, RequestKind.ADAPT))
    return worker.ask(kind, read(HELD / JUMP), PROBLEM)


def _kill(pid: int) -> None:
    os.kill(pid, signal.SIGKILL)


def _wait_for_end(pid: int) -> None:
    """Until a killed child is at its end with all its threads, which on a busy machine takes a
    while; it is left for the worker's client to be waited for."""
    end = time.monotonic() + LOADING
    try:
        while os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            if time.monotonic() > end:
                raise TimeoutError(f"process {pid} was killed and goes on")
            time.sleep(0.01)
    except ChildProcessError:
        return  # it has been waited for


def _abused(case: HostileCase, abuse: Callable[[int], None]) -> None:
    with _Asked.about(case) as asked:
        time.sleep(case.rng.uniform(0.0, 2.5))
        abuse(asked.pid)
        answer = asked.answer()
        if asked.worker.pid is not None:
            _kill(asked.worker.pid)  # it lives on with little memory
            _wait_for_end(asked.worker.pid)
        asked.again()
    if isinstance(answer, Failed):
        raise answer.fault


FAMILIES = tuple(
    Family(f"worker {run.__name__.replace('_', ' ')}", share, LOADING + 60.0, run)
    for run, share in (
        (killed, 0.3),
        (stopped, 0.15),
        (starved, 0.4),
        (dropped, 0.2),
        (false_worker, 0.5),
        (fed_garbage, 0.5),
    )
)
