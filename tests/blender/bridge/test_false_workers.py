"""Programs in the worker's place that are none: whoever asks hears why, and is not kept waiting."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest
from hangtime.bridge.worker_client import RequestKind, Worker
from hangtime.solver.data.faults import WorkerDied
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.worker.protocol import Failed
from hangtime.tests.blender.helpers.scripts import LOADER, output_of
from hangtime.tests.helpers.clips import load_recording

JUMP = "forward_jump_116cm.bvh"

GREETS_ALONE = """
import os, runpy, sys, time
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker.protocol import PROTOCOL, Ready, receive, send
receive(sys.stdin.buffer)
send(sys.stdout.buffer, Ready(PROTOCOL))
os.close(1)
time.sleep(100)
"""

DOES_NOT_LOAD = """
import runpy, time
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker import program
program.LOADING = 0.2
with program.bounded_loading():
    time.sleep(100)
"""

STARVED = """
import resource, runpy
from pathlib import Path
runpy.run_path({loader!r})["load"]()
from hangtime.solver.numerics.openblas import openblas
from hangtime.solver.worker import program
openblas()
program.LOADING = 0.2
pages = int(Path("/proc/self/statm").read_text().split()[0])
size = pages * resource.getpagesize() + 20_000_000  # OpenBLAS's buffer is 32 MiB
resource.setrlimit(resource.RLIMIT_AS, (size, size))
with program.bounded_loading():
    pass
raise SystemExit("it had its memory")
"""

# As in Blender's own program, where writing to a pipe that nobody reads ends the process.
PIPES_KILL = """
import runpy, signal, sys
from pathlib import Path
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
runpy.run_path(sys.argv[1])["load"]()
from hangtime.bridge import worker_client
from hangtime.tests.helpers.clips import load_recording
from hangtime.solver.data.problem import MotionProblem
worker_client._PROGRAM = Path(sys.argv[3])
one, recording = worker_client.Worker(), load_recording(sys.argv[2])
answer = one.ask(worker_client.RequestKind.ANALYSE, recording, MotionProblem()).wait()
one.close()
print(answer.fault)
"""

# Greets and goes without reading what it is asked.
DEAF = """
import runpy, sys
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker.protocol import PROTOCOL, Ready, receive, send
receive(sys.stdin.buffer)
send(sys.stdout.buffer, Ready(PROTOCOL))
raise SystemExit("cannot hear you")
"""

# As a worker does whose listening fails by a mistake in it, once it was asked.
LISTENS_NO_MORE = """
import runpy, sys, time
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker import main, protocol
heard = protocol.receive
def receive(stream):
    message = heard(stream)
    if isinstance(message, protocol.Request):
        raise ZeroDivisionError("of the listener")
    return message
protocol.receive = receive
sys.exit(main.main())
"""

# As a worker does that fails by a mistake as it solves; its listener waits for what comes next.
FAILS = """
import runpy, sys
runpy.run_path({loader!r})["load"]()
from hangtime.solver.worker import main, service
def answer(self, request, tell):
    raise ZeroDivisionError("of the solver")
service.Service.answer = answer
sys.exit(main.main())
"""

Told = Callable[[str], str]


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Told]:
    """Of a program's text: why there is no answer, where it is in the worker's place."""
    worker, program = Worker(), tmp_path / "false.py"
    monkeypatch.setattr("hangtime.bridge.worker_client._PROGRAM", program)
    monkeypatch.setattr("hangtime.bridge.worker_client._LAST_WORDS_S", 0.5)

    def why(text: str) -> str:
        program.write_text(text)
        answer = worker.ask(RequestKind.ANALYSE, load_recording(JUMP), MotionProblem()).wait()
        assert isinstance(answer, Failed)
        assert isinstance(answer.fault, WorkerDied)
        return answer.fault.detail

    yield why
    worker.close()


def test_what_it_said_last_is_told(told: Told) -> None:
    said = told("raise SystemExit('the disk is upside down')")
    assert said == "the disk is upside down (exit code 1)"


@pytest.mark.parametrize("program", [DOES_NOT_LOAD, STARVED])
@pytest.mark.skipif(not Path("/proc").is_dir(), reason="looks processes up in /proc")
def test_one_that_does_not_load_says_why(told: Told, program: str) -> None:
    """As OpenBLAS does not where memory is scarce, unless it gives up first."""
    said = told(program.format(loader=LOADER))
    told_so = {"it could not load in 60 s; there may be too little memory"}
    if program == STARVED:
        gives_up = "OpenBLAS error: Memory allocation still failed after 10 retries, giving up."
        told_so.add(f"{gives_up} (exit code 1)")
    assert said in told_so


def test_one_that_talks_nonsense_is_not_believed(told: Told) -> None:
    said = told("print('Hello, this is more than a length', flush=True); input()")
    assert "bytes is announced" in said


def test_one_that_closes_its_pipe_and_stays_is_not_waited_for(told: Told) -> None:
    assert told("import os, time; os.close(1); time.sleep(100)") == "exit code -9"


@pytest.mark.slow
def test_one_that_was_greeted_and_neither_speaks_nor_listens_is_not_waited_for(told: Told) -> None:
    """What it is sent is more than a pipe holds."""
    assert told(GREETS_ALONE.format(loader=LOADER)) == "exit code -9"


@pytest.mark.slow
def test_one_whose_listener_fails_ends_and_says_so(told: Told) -> None:
    said = told(LISTENS_NO_MORE.format(loader=LOADER))
    assert said == "ZeroDivisionError: of the listener (exit code 5)"


@pytest.mark.slow
def test_one_that_fails_by_a_mistake_says_by_which(told: Told) -> None:
    """And not that Python could not shut down beside a thread that reads."""
    said = told(FAILS.format(loader=LOADER))
    assert said == "ZeroDivisionError: of the solver (exit code 1)"


def test_where_our_own_listener_fails_nobody_waits(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    def receive(_: object) -> None:
        raise ZeroDivisionError("of ours")

    shown: SimpleQueue[threading.ExceptHookArgs] = SimpleQueue()
    monkeypatch.setattr(threading, "excepthook", shown.put)
    monkeypatch.setattr("hangtime.bridge.worker_client.receive", receive)
    assert "ZeroDivisionError('of ours')" in told(GREETS_ALONE.format(loader=LOADER))
    assert shown.get(timeout=30.0).exc_type is ZeroDivisionError


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signal")
@pytest.mark.slow
def test_one_that_does_not_listen_does_not_take_blender_along(tmp_path: Path) -> None:
    program = tmp_path / "deaf.py"
    program.write_text(DEAF.format(loader=LOADER))
    assert output_of(PIPES_KILL, JUMP, str(program)) == "cannot hear you (exit code 1)"
