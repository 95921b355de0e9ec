"""Loads the checkout as the package `hangtime`, and runs one of its modules as a program.

The repository root is the extension (relative imports throughout), so it is loaded under the
package's name the way Blender loads it, whatever the checkout's folder is called.

As a program: python devtools/package.py MODULE [arguments], where MODULE is relative to the package
and has a `main(argv) -> int`.
"""

import importlib
import importlib.util
import os
import shutil
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import NoReturn

NAME = "hangtime"
ROOT = Path(__file__).resolve().parents[1]


def load() -> ModuleType:
    """The package, loaded from the checkout once a process."""
    if NAME in sys.modules:
        return sys.modules[NAME]
    spec = importlib.util.spec_from_file_location(
        NAME, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = module
    spec.loader.exec_module(module)
    return module


def leave(code: int) -> NoReturn:
    """End the process at once: some versions of bpy crash or hang in an ordinary exit."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:  # as one that was closed from the start is
            with suppress(OSError):
                stream.flush()
    bpy = sys.modules.get("bpy")
    if bpy is not None:
        shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
    os._exit(code)


def main(argv: list[str]) -> int:
    load()
    return int(importlib.import_module(f"{NAME}.{argv[0]}").main(argv[1:]))


def told(argv: list[str]) -> int:
    """The exit code of `main`, 1 after the traceback of what it lets through: left to Python, this
    would end in the ordinary exit that `leave` is there to avoid."""
    try:
        return main(argv)
    except KeyboardInterrupt:
        return 130
    except Exception:  # noqa: BLE001 - whatever it is
        traceback.print_exc()
    return 1


if __name__ == "__main__":
    # This folder must not shadow packages of the same names as its modules.
    sys.path[:] = [p for p in sys.path if Path(p or ".").resolve() != ROOT / "devtools"]
    leave(told(sys.argv[1:]))
