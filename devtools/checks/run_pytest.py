"""One pytest run that ends at once with pytest's verdict, whatever bpy does in an ordinary exit.

Into the folder by which it is watched (watched_tests.py) it writes the name of each test.
"""

import os
import sys
from pathlib import Path
from runpy import run_path

import pytest


class Watched:
    """A plugin that names the test that begins."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._file.write_text(nodeid)


if __name__ == "__main__":
    root = Path(__file__).resolve().parents[2]
    del sys.path[0]  # this folder must not shadow packages of the same names as its modules
    program = run_path(str(root / "solver" / "worker" / "program.py"))
    program["tell_stacks"]()
    folder = os.environ.get(program["STACKS_FOLDER"])
    plugins = [Watched(Path(folder) / "test.txt")] if folder else []
    code = int(pytest.main(sys.argv[1:], plugins=plugins))
    run_path(str(root / "devtools" / "package.py"))["leave"](code)
