"""The environment that dev.py works in: one folder per Python minor and Blender version.

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

__all__ = ["CACHE", "REQUIREMENTS", "ROOT", "Place", "SetUpError", "prepare", "prepare_peers"]


@dataclass(frozen=True)
class Layer:
    """One requirements file: what is being installed, in words, and how pip should read it.

    blender: whether Blender's module is in it, which needs libraries of the system's.
    """

    file: str
    words: str
    options: tuple[str, ...] = ()
    blender: bool = False


CASADI = Layer("casadi.txt", "CasADi (90 MB)", ("--no-deps", "--require-hashes"))


@dataclass(frozen=True)
class Place:
    """A virtual environment's folder."""

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
        settings.mkdir(exist_ok=True)
        leaks = ("PYTHONPATH", "PYTHONHOME", "__PYVENV_LAUNCHER__")
        kept = {name: value for name, value in os.environ.items() if name not in leaks}
        return {**kept, "PYTHONNOUSERSITE": "1", "BLENDER_USER_RESOURCES": str(settings)}


def prepare(blender: Blender, python: str, tools: bool) -> Place:
    """Make or complete the environment. Raises SetUpError with what the machine lacks.

    tools: also install what tests, lint and figures need.
    """
    place = Place(CACHE / f"python{blender.python}-blender{blender.version}")
    return complete(place, layers(blender, tools), python)


def prepare_peers(blender: Blender, python: str) -> Place:
    """The benchmark's environment: the solvers that we are compared with, and no Blender, whose
    numpy is not theirs. Raises SetUpError."""
    place = Place(CACHE / f"python{blender.python}-benchmark")
    peers = Layer("benchmark.txt", "the benchmark's peers (400 MB to fetch, 1.3 GB on disk)")
    return complete(place, [peers, CASADI], python)


def complete(place: Place, wanted: list[Layer], python: str) -> Place:
    """Make the environment where it is missing, and install what it lacks."""
    installed = read_stamp(place)
    pending = [layer for layer in wanted if installed.get(layer.file) != fingerprint(layer)]
    if not pending:
        return place
    if not installed:
        make(place, python)
    for layer in pending:
        command = [place.python, "-m", "pip", "install", "--no-input", *layer.options]
        command += ["--disable-pip-version-check", "-r", str(REQUIREMENTS / layer.file)]
        run_quietly(f"Installing {layer.words}", command, place.log)
        if layer.blender:
            libraries.ensure(place.python, place.log)
        installed[layer.file] = fingerprint(layer)
        place.stamp.write_text(json.dumps(installed, indent=1))
    return place


def layers(blender: Blender, tools: bool) -> list[Layer]:
    own = f"blender-{blender.version}.txt"
    words = f"Blender {blender.version} as a Python module (about 400 MB to fetch, 1 GB on disk)"
    found = [Layer(own, words, blender=True), CASADI]
    if tools:
        keep = ("--constraint", str(REQUIREMENTS / own))
        found.append(Layer("dev.txt", "the tools of tests and checks (90 MB)", keep))
    return found


def fingerprint(layer: Layer) -> str:
    return hashlib.sha256((REQUIREMENTS / layer.file).read_bytes()).hexdigest()


def read_stamp(place: Place) -> dict[str, str]:
    """Hash by requirements file; empty where the environment is missing or was left half made."""
    try:
        stamp = json.loads(place.stamp.read_text())
    except (OSError, ValueError):
        return {}
    return stamp if isinstance(stamp, dict) and os.path.exists(place.python) else {}


def make(place: Place, python: str) -> None:
    """A new virtual environment in place of whatever lies there."""
    probe = subprocess.run([python, "-c", "import ensurepip, venv"], capture_output=True)
    CACHE.mkdir(exist_ok=True)
    if probe.returncode != 0:
        libraries.install_venv(python, CACHE / "apt.log")
    print(f"Making the environment {place.folder.relative_to(ROOT)} ...", flush=True)
    made = subprocess.run(
        [python, "-m", "venv", "--clear", str(place.folder)], capture_output=True, text=True
    )
    if made.returncode != 0:
        lines = (made.stderr or made.stdout).strip().splitlines() or ["no word why"]
        raise SetUpError(f"{python} could not make a virtual environment: {lines[-1]}")
