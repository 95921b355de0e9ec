"""A process of a peer that never outlasts its limits, whatever it does."""

import contextlib
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

PAUSE = 0.02  # s, between looks at whether it has begun


@dataclass(frozen=True)
class Limits:
    """Most seconds from its start until it begins to solve, and from then on."""

    set_up: float
    solving: float


def run(command: list[str], log: Path, limits: Limits, begun: Callable[[], bool]) -> bool:
    """Runs a command; whether it ended by itself, and was not ended as its time was up.

    log: takes what it says. begun: whether it has begun to solve. Raises RuntimeError with what it
    said last if it failed.
    """
    with log.open("wb") as said, subprocess.Popen(command, stdout=said, stderr=said) as process:
        try:
            until = time.monotonic() + limits.set_up
            while process.poll() is None and not begun() and time.monotonic() < until:
                time.sleep(PAUSE)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(limits.solving if begun() else 0.0)
            code = process.poll()
        finally:
            process.kill()
    if code:
        lines = log.read_text(errors="replace").splitlines()
        raise RuntimeError(lines[-1] if lines else f"ended with code {code}")
    return code is not None
