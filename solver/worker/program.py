"""The program of a worker process: `python -I program.py MODULE`, or by Blender's --python.

MODULE is the package's own that has the worker's `main`, such as solver.worker.main. Whoever
starts it holds the other end of its standard streams.
"""

from __future__ import annotations

import faulthandler
import importlib
import importlib.util
import os
import signal
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, NoReturn

NAME = "hangtime"
LOADING = 60.0  # s, in which libraries load from the slowest disk
TIMED_OUT = "Timeout ("  # as faulthandler begins to tell
STACKS_FOLDER = "HANGTIME_STACKS"  # where tests have processes tell what they are doing


def private_stdout() -> BinaryIO:
    """The pipe to the parent; whatever a library prints goes to the error stream instead."""
    private = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return private


@contextmanager
def bounded_loading() -> Iterator[None]:
    """Ends the process where libraries do not load in time, by a thread that needs no Python:
    where memory is scarce OpenBLAS asks for it for ever, as it loads and at its first use."""
    faulthandler.dump_traceback_later(LOADING, exit=True)
    try:
        yield
        import numpy as np

        from ..numerics.openblas import product

        product(np.eye(128), np.eye(128))  # small ones need no memory on some processors
    finally:
        faulthandler.cancel_dump_traceback_later()


def end_by_exception(code: int) -> NoReturn:
    """Ends the process with an exception as its last words. Python's own shutdown would abort with
    others where a thread is still reading the standard input."""
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(code)


def tell_stacks() -> None:
    """Where a folder is named for it, the signal USR1 has all threads' stacks written there."""
    folder = os.environ.get(STACKS_FOLDER)
    if folder and hasattr(signal, "SIGUSR1"):
        said = Path(folder, f"{os.getpid()}.stacks").open("w")  # noqa: SIM115 - as long as it lives
        faulthandler.register(signal.SIGUSR1, said, all_threads=True)


def load_package(root: Path) -> None:
    """Makes a folder importable as the package, whatever it is called."""
    spec = importlib.util.spec_from_file_location(
        NAME, root / "__init__.py", submodule_search_locations=[str(root)]
    )
    assert spec is not None
    assert spec.loader is not None
    package = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    tell_stacks()
    load_package(Path(__file__).resolve().parents[2])
    sys.exit(importlib.import_module(f"{NAME}.{sys.argv[-1]}").main())
