"""Runs a noisy command quietly, saying what goes on and for how long. Standard library only."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Mapping
from pathlib import Path

from .problem import SetUpError

HEARTBEAT = 15.0  # s between signs of life


def run_quietly(
    what: str, command: list[str], log: Path, environment: Mapping[str, str] | None = None
) -> None:
    """Run `command` with its output in `log`. Raises SetUpError with the log's end if it fails."""
    start = time.monotonic()
    print(f"{what} ...", flush=True)
    with log.open("ab") as output:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=environment,
        )
        while True:
            try:
                code = process.wait(timeout=HEARTBEAT)
                break
            except subprocess.TimeoutExpired:
                print(f"  {time.monotonic() - start:.0f} s", flush=True)
    if code != 0:
        tail = "\n".join(log.read_text(errors="replace").splitlines()[-15:])
        raise SetUpError(f"\n{tail}\n\n{what}: failed; see the lines above, or all of {log}.")
    print(f"  done in {time.monotonic() - start:.0f} s", flush=True)
