"""Two Blenders on one file: both work on it, and open and save it in turns.

In turns, for Blender itself spoils a file that two of them write at once.
"""

import fcntl
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ....solver.one_thread import ONE_THREAD
from ...processes import LAUNCHER
from ...recordings import HELD, JUMP
from ..protocol.blender_file import MARK, enable, marked, must_be_same, recorded_file
from ..protocol.case import Changed, Family, HostileCase
from .sessions import FRAMES, OPERATORS, operator

ROUNDS = 3


def shared_file(case: HostileCase) -> None:
    """The file can be opened afterwards, and holds the recording as it was."""
    path = str(case.folder / "shared.blend")
    recorded_file(HELD / JUMP, *FRAMES)
    before = marked()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    pause = f"{case.rng.uniform(0.0, 1.0):g}"
    command = [sys.executable, str(LAUNCHER), __name__.partition(".")[2], path, pause]
    other = subprocess.Popen(command, env=os.environ | ONE_THREAD, stdout=2)
    try:
        while other.poll() is None:
            case.taken_on |= operator(case, "hangtime.analyze")
            with _turn(path):
                bpy.ops.wm.save_as_mainfile(filepath=path)
            time.sleep(case.rng.uniform(0.0, 1.0))
    finally:
        other.kill()
        other.wait()
    if other.returncode:
        raise RuntimeError(f"the other Blender ended with {other.returncode}")
    bpy.ops.wm.open_mainfile(filepath=path)
    if set(marked()) != set(before):
        raise Changed(f"the file has {sorted(marked())}")
    must_be_same(before, marked())


@contextmanager
def _turn(path: str) -> Iterator[None]:
    """Context in which the other does not have its turn."""
    with open(f"{path}.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def main(argv: list[str]) -> int:
    """The other Blender. Raises Changed where the recording is not the same."""
    path, pause = argv
    enable()
    for _ in range(ROUNDS):
        with _turn(path):
            bpy.ops.wm.open_mainfile(filepath=path)
        before = marked()
        if "recording" not in before:
            raise Changed(f"no action has the mark '{MARK}'")
        OPERATORS.hangtime.analyze()
        must_be_same(before, marked())
        time.sleep(float(pause))
        with _turn(path):
            bpy.ops.wm.save_as_mainfile(filepath=path)
    return 0


FAMILIES = (Family("two Blenders", 0.15, 120.0, shared_file),)
