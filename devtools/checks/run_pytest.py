"""One pytest run that ends at once with pytest's verdict, whatever bpy does in an ordinary exit."""

import sys
from pathlib import Path
from runpy import run_path

import pytest

if __name__ == "__main__":
    folder = Path(__file__).resolve().parent
    del sys.path[0]  # this folder must not shadow packages of the same names as its modules
    run_path(str(folder.parent / "package.py"))["leave"](int(pytest.main(sys.argv[1:])))
