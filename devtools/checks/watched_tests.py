"""A process that runs tests, watched from outside: what hangs cannot tell so itself.

It writes the name of the test that it is at into a folder, where each process that can tell where
its threads are opens a file for it (solver/worker/program.py). Standard library only.
"""

import contextlib
import os
import signal
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

TEST = "test.txt"  # name of the test, in the folder
STACKS = "*.stacks"  # files there, by the number of the process
NO_TEST = "no test"
_LOOK_EVERY = 0.1  # s
_TELLING = 2.0  # s, which processes have for their stacks


@dataclass(frozen=True)
class Limits:
    """Most seconds of the whole process and of one test, with what is set up for it."""

    process: float
    test: float


def wait(process: "subprocess.Popen[bytes]", folder: Path, limits: Limits) -> str | None:
    """Why the process must be ended, with the stacks of all threads; None where it has ended."""
    begun = since = time.monotonic()
    test = test_at(folder)
    while True:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_LOOK_EVERY)
            return None
        now, before, test = time.monotonic(), test, test_at(folder)
        since = since if test == before else now
        if test != NO_TEST and now - since > limits.test:
            return "\n".join([f"{test} took more than {limits.test:g} s", *stacks(folder)])
        if now - begun > limits.process:
            whole = f"pytest's process took more than {limits.process:g} s; it was at {test}"
            return "\n".join([whole, *stacks(folder)])


def test_at(folder: Path) -> str:
    """The test that runs or ran last."""
    with contextlib.suppress(FileNotFoundError):
        return (folder / TEST).read_text() or NO_TEST
    return NO_TEST


def stacks(folder: Path) -> Iterator[str]:
    """Where the threads are of each process that can tell."""
    files = sorted(folder.glob(STACKS))
    for file in files:
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(file.stem), signal.SIGUSR1)
    time.sleep(_TELLING if files else 0.0)
    for file in files:
        if said := file.read_text(errors="replace"):
            yield f"process {file.stem}:\n{said}"
