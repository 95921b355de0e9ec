"""A worker process: solves the cells that its parent names, until the parent is gone.

Run as a program; `workers.py` starts it and holds the other end. Messages are lines of JSON.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any, BinaryIO

NAME = "hangtime"
Run = Callable[[Path], Callable[[str], Any]]  # of a batch's folder: what solves a cell of it


def solver(folder: Path) -> Callable[[str], Any]:
    """What solves a cell of a batch: fits are remembered from one to the next."""
    from ..cells.cell import run_cell
    from ..cells.fits import SharedFits

    fits = SharedFits(folder)
    return lambda cell: run_cell(folder, cell, fits)


def serve(run: Run = solver) -> None:
    """Answers until the parent is gone."""
    requests, answers = sys.stdin.buffer, _private_stdout()
    hello = json.loads(requests.readline() or "null")
    if hello is None:
        return
    sys.path[:] = hello["path"]
    from ..records.faults import BatchFault
    from .memory import used

    solve = run(Path(hello["folder"]))
    cells: SimpleQueue[str] = SimpleQueue()
    Thread(target=_listen, args=(requests, cells), daemon=True).start()
    _send(answers, {"ready": True, **used()})
    while True:
        cell = cells.get()
        try:
            result = solve(cell)
        except BatchFault as fault:
            _send(answers, {"cell": cell, "stop": str(fault)})
        else:
            _send(answers, {"cell": cell, "state": result.state.value, **used()})


def _listen(requests: BinaryIO, cells: SimpleQueue[str]) -> None:
    for line in requests:
        cells.put(json.loads(line))
    os._exit(0)  # nobody waits for what is being solved; its folder has no name yet


def _send(answers: BinaryIO, message: dict[str, Any]) -> None:
    try:
        answers.write(json.dumps(message).encode() + b"\n")
        answers.flush()
    except OSError:
        os._exit(0)


def _private_stdout() -> BinaryIO:
    """The pipe to the parent; whatever a library prints goes to the error stream instead."""
    private = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return private


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
    load_package(Path(__file__).resolve().parents[2])
    importlib.import_module(f"{NAME}.batch.running.worker").serve()
