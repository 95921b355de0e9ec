"""A worker process: solves the cells that its parent names, until the parent is gone.

solver/worker/program.py runs it; `workers.py` starts that and holds the other end. Messages are
lines of JSON.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any, BinaryIO

from ...solver.worker.program import bounded_loading, end_by_exception, private_stdout

FAILED = 1  # exit code
Run = Callable[[Path], Callable[[str], Any]]  # of a batch's folder: what solves a cell of it


def solver(folder: Path) -> Callable[[str], Any]:
    """What solves a cell of a batch: fits are remembered from one to the next."""
    with bounded_loading():
        from ..cells.cell import run_cell
        from ..cells.fits import SharedFits

    fits = SharedFits(folder)
    return lambda cell: run_cell(folder, cell, fits)


def main(run: Run = solver) -> None:
    """Answers until the parent is gone."""
    requests, answers = sys.stdin.buffer, private_stdout()
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
    try:
        while True:
            cell = cells.get()
            try:
                result = solve(cell)
            except BatchFault as fault:
                _send(answers, {"cell": cell, "stop": str(fault)})
            else:
                _send(answers, {"cell": cell, "state": result.state.value, **used()})
    finally:  # by an exception
        end_by_exception(FAILED)


def _listen(requests: BinaryIO, cells: SimpleQueue[str]) -> None:
    try:
        for line in requests:
            cells.put(json.loads(line))
        os._exit(0)  # nobody waits for what is being solved; its folder has no name yet
    finally:  # by an exception: cells would be waited for, for ever
        end_by_exception(FAILED)


def _send(answers: BinaryIO, message: dict[str, Any]) -> None:
    try:
        answers.write(json.dumps(message).encode() + b"\n")
        answers.flush()
    except OSError:
        os._exit(0)
