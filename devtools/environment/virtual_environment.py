"""Virtual environments of dev.py: a folder per Python minor and Blender version.

Standard library only. A stamp holds the hash of every requirements file that was installed, so that
a second run starts at once and a changed pin is noticed.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from . import libraries
from .problem import SetUpError
from .progress import run_quietly
from .pythons import Blender

ROOT = Path(__file__).resolve().parents[2]
CACHE = ROOT / ".hangtime"
REQUIREMENTS = ROOT / "requirements"


@dataclass(frozen=True)
class Requirements:
    """A requirements file, its label while it is being installed, and options for pip.

    blender: whether Blender's module is in it, which needs libraries of the system's.
    """

    file: str
    label: str
    options: tuple[str, ...] = ()
    blender: bool = False


WHEELS = Requirements(
    "wheels.txt", "CasADi and OpenBLAS (100 MB)", ("--no-deps", "--require-hashes")
)
# Environments without Blender: its numpy is not the peers', and a farm's machines have none.
PEERS = Requirements("benchmark.txt", "the benchmark's peers (400 MB to fetch, 1.3 GB on disk)")
FARM = Requirements("farm.txt", "the farms' engines (50 MB to fetch, 200 MB on disk)")


@dataclass(frozen=True)
class VirtualEnvironment:
    """A folder with a Python of its own, made by venv."""

    folder: Path

    @property
    def python(self) -> str:
        inside = ("Scripts", "python.exe") if os.name == "nt" else ("bin", "python")
        return str(self.folder.joinpath(*inside))

    @property
    def log(self) -> Path:
        return self.folder / "install.log"

    @property
    def stamp(self) -> Path:
        return self.folder / "installed.json"

    def variables(self) -> dict[str, str]:
        """The process environment for programs that run here; nothing of the user's leaks in."""
        settings = self.folder / "blender_user"
        settings.mkdir(parents=True, exist_ok=True)
        leaks = ("PYTHONPATH", "PYTHONHOME", "PYTHONDONTWRITEBYTECODE", "__PYVENV_LAUNCHER__")
        kept = {name: value for name, value in os.environ.items() if name not in leaks}
        # Hundreds of short processes would each compile numpy and scipy anew where nothing is
        # written; here it lies beside nobody's files.
        bytecode = {"PYTHONPYCACHEPREFIX": str(self.folder / "bytecode")}
        own = {"PYTHONNOUSERSITE": "1", "BLENDER_USER_RESOURCES": str(settings)}
        return {**kept, **own, **bytecode}


def prepare(blender: Blender, python: str, tools: bool) -> VirtualEnvironment:
    """Make or complete the environment. Raises SetUpError with what the machine lacks.

    tools: also install what tests, lint and figures need.
    """
    env = VirtualEnvironment(CACHE / f"python{blender.python}-blender{blender.version}")
    complete(env, requirements_of(blender, tools), python)
    return env


def prepare_without_blender(
    blender: Blender, python: str, wanted: Requirements
) -> VirtualEnvironment:
    """An environment of its own for PEERS or FARM. Raises SetUpError."""
    env = VirtualEnvironment(CACHE / f"python{blender.python}-{Path(wanted.file).stem}")
    complete(env, [wanted, WHEELS], python)
    return env


def complete(env: VirtualEnvironment, wanted: list[Requirements], python: str) -> None:
    """Make the environment where it is missing, and install what it lacks."""
    installed = read_stamp(env)
    pending = [each for each in wanted if installed.get(each.file) != fingerprint(each)]
    if pending and not installed:
        make(env, python)
    for each in pending:
        command = [env.python, "-m", "pip", "install", "--no-input", *each.options]
        # Modules are compiled as they are loaded: all at once took half of the time, and most of
        # bpy's and MuJoCo's are never.
        command += ["--disable-pip-version-check", "--no-compile"]
        command += ["-r", str(REQUIREMENTS / each.file)]
        run_quietly(f"Installing {each.label}", command, env.log)
        if each.blender:
            libraries.ensure(env.python, env.log)
        installed[each.file] = fingerprint(each)
        env.stamp.write_text(json.dumps(installed, indent=1))


def requirements_of(blender: Blender, tools: bool) -> list[Requirements]:
    """Blender's module, our wheels, and with `tools` what tests and checks need."""
    own = f"blender-{blender.version}.txt"
    label = f"Blender {blender.version} as a Python module (about 400 MB to fetch, 1 GB on disk)"
    found = [Requirements(own, label, blender=True), WHEELS]
    if tools:
        keep = ("--constraint", str(REQUIREMENTS / own))
        found.append(Requirements("dev.txt", "the tools of tests and checks (90 MB)", keep))
    return found


def fingerprint(each: Requirements) -> str:
    return hashlib.sha256((REQUIREMENTS / each.file).read_bytes()).hexdigest()


def read_stamp(env: VirtualEnvironment) -> dict[str, str]:
    """Hash by requirements file; empty where the environment is missing or was left half made."""
    try:
        stamp = json.loads(env.stamp.read_text())
    except (OSError, ValueError):
        return {}
    return stamp if isinstance(stamp, dict) and os.path.exists(env.python) else {}


def make(env: VirtualEnvironment, python: str) -> None:
    """A new virtual environment in place of whatever lies there."""
    probe = subprocess.run([python, "-c", "import ensurepip, venv"], capture_output=True)
    CACHE.mkdir(exist_ok=True)
    if probe.returncode != 0:
        libraries.install_venv(python, CACHE / "apt.log")
    print(f"Making the environment {env.folder.relative_to(ROOT)} ...", flush=True)
    made = subprocess.run(
        [python, "-m", "venv", "--clear", str(env.folder)], capture_output=True, text=True
    )
    if made.returncode != 0:
        lines = (made.stderr or made.stdout).strip().splitlines() or ["no word why"]
        raise SetUpError(f"{python} could not make a virtual environment: {lines[-1]}")
