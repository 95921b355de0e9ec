"""Choice of a Blender, and search for a Python that can run it. Standard library only."""

from __future__ import annotations

import glob
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from .problem import SetUpError


@dataclass(frozen=True)
class Blender:
    """A Blender and the one Python minor that its module runs on."""

    version: str
    python: str


# Those with long-term support first, the newest first: what nobody names is one of them.
BLENDERS = (
    Blender("5.2.3", "3.13"),
    Blender("4.5.15", "3.11"),
    Blender("4.2.23", "3.11"),
    Blender("5.0.1", "3.11"),
)

# Where pyenv, uv and the installers of macOS and Windows put a Python without telling PATH.
INSTALLED = (
    "$PYENV_ROOT/versions/{minor}*/bin/python",
    "~/.pyenv/versions/{minor}*/bin/python",
    "~/.pyenv/pyenv-win/versions/{minor}*/python.exe",
    "~/.local/share/uv/python/cpython-{minor}*/bin/python{minor}",
    "/opt/homebrew/bin/python{minor}",
    "/Library/Frameworks/Python.framework/Versions/{minor}/bin/python{minor}",
    "$LOCALAPPDATA/Programs/Python/Python{digits}/python.exe",
    "$ProgramFiles/Python{digits}/python.exe",
)


def choose(wanted: str | None) -> tuple[Blender, str]:
    """The Blender to use and the path of a Python for it; `wanted` is a version or its beginning.

    Without a wish: the newest that the running Python can load, or else the newest for which a
    Python is found on this machine. Raises SetUpError when there is none.
    """
    own = [b for b in BLENDERS if b.python == running()]
    suitable = named(wanted) if wanted else own or list(BLENDERS)
    for blender in suitable:
        for path in candidates(blender.python):
            if minor_of(path) == blender.python:
                return blender, path
    needed = " or ".join(sorted({b.python for b in suitable}))
    asked = f"Blender {suitable[0].version}" if wanted else "Blender's module"
    raise SetUpError(
        f"{asked} needs Python {needed}, and none was found (this is {running()}); "
        "install one and run the command again."
    )


def named(wanted: str) -> list[Blender]:
    """The newest supported Blender whose version begins with `wanted` ('5.2', '5.2.x', '5.2.3')."""
    parts = [p for p in wanted.split(".") if p != "x"]
    found = [b for b in BLENDERS if b.version.split(".")[: len(parts)] == parts]
    if not found:
        known = ", ".join(b.version for b in BLENDERS)
        raise SetUpError(f"Blender {wanted} is not one that Hangtime is tested with: {known}.")
    return found[:1]


def running() -> str:
    return f"{sys.version_info[0]}.{sys.version_info[1]}"


def candidates(minor: str) -> Iterator[str]:
    """Paths where a Python of that minor may lie, the running one first; they may not exist."""
    if minor == running():
        yield sys.executable
    for folder in os.get_exec_path():
        yield os.path.join(folder, f"python{minor}")
    for pattern in INSTALLED:
        path = pattern.format(minor=minor, digits=minor.replace(".", ""))
        yield from sorted(glob.glob(os.path.expandvars(os.path.expanduser(path))))


def minor_of(path: str) -> str | None:
    """Minor version of the Python at `path`; None where it does not run, as a shim."""
    if not os.path.isfile(path):
        return None
    question = "import sys; print('%d.%d' % sys.version_info[:2])"
    try:
        answer = subprocess.run(
            [path, "-c", question], capture_output=True, text=True, timeout=30, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return answer.stdout.strip() if answer.returncode == 0 else None
