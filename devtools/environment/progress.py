"""Runs a noisy command quietly, saying what goes on and for how long. Standard library only."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

from .problem import SetUpError


def run_quietly(
    what: str, command: list[str], log: Path, environment: dict[str, str] | None = None
) -> None:
    """Run `command` with its output in `log`. Raises SetUpError with the log's end if it fails."""
    start = time.monotonic()
    live = sys.stdout.isatty()
    print(f"{what} ...", end="" if live else "\n", flush=True)
    with log.open("ab") as output:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=environment,
        )
        while process.poll() is None:
            try:
                process.wait(timeout=1 if live else 15)
            except subprocess.TimeoutExpired:
                elapsed = f"{time.monotonic() - start:.0f} s"
                print(f"\r{what} ... {elapsed}" if live else f"  {elapsed}", end="", flush=True)
                if not live:
                    print(flush=True)
    if process.returncode != 0:
        tail = "\n".join(log.read_text(errors="replace").splitlines()[-15:])
        print(flush=True)
        raise SetUpError(f"{tail}\n\n{what}: failed; see the lines above, or all of {log}.")
    elapsed = f"{time.monotonic() - start:.0f} s"
    print(f"\r{what} ... done in {elapsed}" if live else f"  done in {elapsed}", flush=True)
