"""Runs cases in processes that are watched: one that crashes or hangs costs its case alone."""

import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Lock, Thread

from ...solver.one_thread import ONE_THREAD
from ..environment.virtual_environment import ROOT
from .families.all_families import family_of
from .protocol.case import CaseOutcome, Ending

LAUNCHER = ROOT / "devtools" / "package.py"
START = 120.0  # s that a process may take to begin its first case
KEPT = 4000  # characters of a crash's last words


class Child:
    """One process that does cases."""

    def __init__(self, seed: int, folder: Path) -> None:
        (folder / "user").mkdir(parents=True, exist_ok=True)
        errors, name = tempfile.mkstemp(".log", dir=folder)
        self._errors = Path(name)
        with os.fdopen(errors, "wb") as log:
            self._process = subprocess.Popen(
                [sys.executable, str(LAUNCHER), "devtools.campaign.child", str(seed), str(folder)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=os.environ | ONE_THREAD | {"BLENDER_USER_RESOURCES": str(folder / "user")},
                start_new_session=True,
            )
        self._late = START

    def run(self, number: int, bound: float) -> tuple[Ending, str, float]:
        """How a case ended; after a crash or a hang the process is gone."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(f"{number}\n".encode())
        self._process.stdin.flush()
        limit, self._late = bound + self._late, 0.0
        ready, _, _ = select.select([self._process.stdout], [], [], limit)
        if not ready:
            return Ending.HANG, f"longer than {bound:g} s\n{self.end()}", bound
        line = self._process.stdout.readline()
        if not line:
            return Ending.CRASH, self.end(), 0.0
        ending, detail, seconds = json.loads(line)
        return Ending(ending), detail, seconds

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def end(self) -> str:
        """Ends it; its last words."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)  # with the workers that it has started
        code = self._process.wait()
        said = self._errors.read_text(errors="replace")[-KEPT:]
        self._errors.unlink()
        return f"{said}\nexit code {code}"


def run_cases(
    numbers: Sequence[int], seed: int, folder: Path, jobs: int, told: Callable[[CaseOutcome], None]
) -> list[CaseOutcome]:
    """Runs cases, those of a family one after another. told: each as it ends, one at a time."""
    waiting: SimpleQueue[int] = SimpleQueue()
    for number in sorted(numbers, key=lambda n: (family_of(n, seed).name, n)):
        waiting.put(number)
    done: list[CaseOutcome] = []
    telling = Lock()

    def work() -> None:
        child = Child(seed, folder)
        while True:
            try:
                number = waiting.get_nowait()
            except Empty:
                break
            if not child.alive:
                child = Child(seed, folder)
            family = family_of(number, seed)
            ended = child.run(number, family.bound)
            if ended[0] in (Ending.CRASH, Ending.HANG):
                child = Child(seed, folder)
            outcome = CaseOutcome(number, family.name, *ended)
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
