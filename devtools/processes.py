"""Modules of devtools in processes of their own: memory and any crash are each one's own."""

import os
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

from ..solver.one_thread import ONE_THREAD
from .environment.virtual_environment import ROOT

LAUNCHER = ROOT / "devtools" / "package.py"


def run_module(name: str, arguments: list[str], longest: float | None = None) -> str | None:
    """Runs a module, such as "devtools.pairs.solve", with one thread of linear algebra.

    longest: s, that it may take. Returns why it failed, or None.
    """
    try:
        done = subprocess.run(
            [sys.executable, str(LAUNCHER), name, *arguments],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=longest,
            env=os.environ | ONE_THREAD,
        )
    except subprocess.TimeoutExpired:
        return f"{name.rpartition('.')[2]} took longer than {longest:g} s"
    said = done.stderr.strip() or done.stdout.strip() or f"ended with code {done.returncode}"
    return said.splitlines()[-1] if done.returncode else None


def dump(content: object, path: Path) -> None:
    """A scratch file for the next process."""
    path.write_bytes(pickle.dumps(content))


def undump(path: Path) -> Any:
    """Reads what `dump` wrote; only ever of our own making."""
    return pickle.loads(path.read_bytes())
