"""Runs cases in processes that are watched: one that crashes or hangs costs its case alone."""

import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Lock, Thread

from ...solver.one_thread import ONE_THREAD
from ..environment.virtual_environment import ROOT
from .families.all_families import family_of
from .protocol.case import CaseOutcome, Ending, Family

LAUNCHER = ROOT / "devtools" / "package.py"
CHILD = ("devtools.campaign.child",)
LOOK = 1.0  # s, after which it is looked how long a case stood in line for a core
START = 120.0  # s that a process may take to begin its first case
KEPT = 4000  # characters of a crash's last words


class Child:
    """One process that does cases. program: of it, as `run_cases` takes it."""

    def __init__(self, seed: int, folder: Path, program: Sequence[str]) -> None:
        (folder / "user").mkdir(parents=True, exist_ok=True)
        errors, name = tempfile.mkstemp(".log", dir=folder)
        self._errors = Path(name)
        with os.fdopen(errors, "wb") as log:
            self._process = subprocess.Popen(
                [sys.executable, str(LAUNCHER), *program, str(seed), str(folder)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=os.environ | ONE_THREAD | {"BLENDER_USER_RESOURCES": str(folder / "user")},
                start_new_session=True,
            )
        self._late = START

    def run(self, number: int, family: Family) -> CaseOutcome:
        """How a case ended; after a crash or a hang the process is gone."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(f"{number}\n".encode())
        self._process.stdin.flush()
        limit, self._late = family.bound + self._late, 0.0
        if not self._answers(limit):
            detail = f"longer than {family.bound:g} s\n{self.end()}"
            return CaseOutcome(number, family.name, Ending.HANG, detail, family.bound)
        line = self._process.stdout.readline()
        if not line:
            return CaseOutcome(number, family.name, Ending.CRASH, self.end())
        answer = json.loads(line)
        return CaseOutcome(**answer | {"ending": Ending(answer["ending"])})

    def _answers(self, bound: float) -> bool:
        """Whether something comes within so many s, those left out that any thread of its
        processes stood in line for a core: on a busy machine a slow case is no hang.
        """
        answers = self._process.stdout
        assert answers is not None
        while bound > 0.0:
            began, before = time.monotonic(), _queued(self._process.pid)
            if select.select([answers], [], [], min(bound, LOOK))[0]:
                return True
            after = _queued(self._process.pid)
            longest = max((s - before.get(t, 0.0) for t, s in after.items()), default=0.0)
            bound -= max(time.monotonic() - began - longest, 0.0)
        return False

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def end(self) -> str:
        """Ends it; its last words."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)  # with the workers that it has started
        with self._process:  # which closes its pipes
            code = self._process.wait()
        said = self._errors.read_text(errors="replace")[-KEPT:]
        self._errors.unlink()
        return f"{said}\nexit code {code}"


def _queued(session: int) -> dict[str, float]:
    """s that each thread of a session's processes has stood in line for a core so far."""
    queued = {}
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # one that ends meanwhile
            if os.getsid(int(process.name)) == session:
                for thread in process.glob("task/*"):
                    line = (thread / "schedstat").read_text()
                    queued[thread.name] = int(line.split()[1]) * 1e-9
    return queued


def run_cases(
    numbers: Sequence[int],
    seed: int,
    folder: Path,
    jobs: int,
    told: Callable[[CaseOutcome], None],
    program: Sequence[str] = CHILD,
) -> list[CaseOutcome]:
    """Runs cases, those of a family one after another. told: each as it ends, one at a time.
    program: module, and arguments that it takes before those of `child`.
    """
    waiting: SimpleQueue[int] = SimpleQueue()
    for number in sorted(numbers, key=lambda n: (family_of(n, seed).name, n)):
        waiting.put(number)
    done: list[CaseOutcome] = []
    telling = Lock()

    def work() -> None:
        child = Child(seed, folder, program)
        while True:
            try:
                number = waiting.get_nowait()
            except Empty:
                break
            if not child.alive:
                child = Child(seed, folder, program)
            outcome = child.run(number, family_of(number, seed))
            if outcome.ending in (Ending.CRASH, Ending.HANG):
                child = Child(seed, folder, program)
            with telling:
                done.append(outcome)
                told(outcome)
        child.end()

    threads = [Thread(target=work) for _ in range(jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return sorted(done, key=lambda outcome: outcome.number)
