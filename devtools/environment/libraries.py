"""The system's libraries that Blender's module links to but does not carry (Linux).

Standard library only. Found missing by loading them; installed where we may, else named.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

from .problem import SetUpError
from .progress import run_quietly

# What `ldd` names for bpy 4.2 to 5.2 on a bare Debian, and EGL with a driver for drawing pictures.
PACKAGES = (
    "libegl1",
    "libgl1",
    "libgl1-mesa-dri",
    "libgomp1",
    "libice6",
    "libsm6",
    "libx11-6",
    "libxfixes3",
    "libxi6",
    "libxkbcommon0",
    "libxrender1",
    "libxxf86vm1",
)

LOCK = Path("/run/lock/hangtime-apt")  # held by the one of our processes that installs

PROBE = """
import ctypes, os, sys
if sys.platform == "linux":
    ctypes.CDLL("libEGL.so.1")
import bpy
sys.stdout.flush()
os._exit(0)
"""


def ensure(python: str, log: Path) -> None:
    """Make `import bpy` work. Raises SetUpError with the line to run when we may not."""
    problem = load(python)
    if problem is None:
        return
    library = re.search(r"(\S+\.so[.\d]*): cannot open shared object file", problem)
    if library is None:
        raise SetUpError(f"Blender's module does not load here: {problem}")
    why = f"Blender needs {library[1]}, which this machine lacks"
    install(why, PACKAGES, log)
    problem = load(python)
    if problem is not None:
        raise SetUpError(f"Blender's module still does not load: {problem}")


def load(python: str) -> str | None:
    """The last line of what went wrong in importing bpy, None if nothing did."""
    probe = subprocess.run([python, "-c", PROBE], capture_output=True, text=True, errors="replace")
    if probe.returncode == 0:
        return None
    lines = probe.stderr.strip().splitlines()
    return lines[-1] if lines else f"the process ended with code {probe.returncode}"


def install_venv(python: str, log: Path) -> None:
    """Debian splits venv off its Python."""
    name = os.path.basename(os.path.realpath(python))
    if not os.path.realpath(python).startswith("/usr/bin/"):
        raise SetUpError(f"{python} lacks its venv module; install a complete Python.")
    install(f"{python} lacks its venv module", (f"{name}-venv",), log)


def install(why: str, packages: tuple[str, ...], log: Path) -> None:
    """Install Debian packages when we are root; otherwise raise SetUpError with the line to run."""
    line = "apt-get install -y --no-install-recommends " + " ".join(packages)
    if shutil.which("apt-get") is None:
        names = " ".join(packages)
        raise SetUpError(f"{why}; install what Debian calls {names} and try again.")
    if os.geteuid() != 0:
        raise SetUpError(f"{why}; run this and try again: sudo {line}")
    import fcntl  # not on Windows, where nothing comes this far

    print(f"{why}.")
    variables = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    with LOCK.open("w") as lock:  # apt-get gives up where another holds its package lists
        fcntl.flock(lock, fcntl.LOCK_EX)
        run_quietly("Reading Debian's package lists", ["apt-get", "update"], log, variables)
        run_quietly("Installing it with apt-get", line.split(), log, variables)
