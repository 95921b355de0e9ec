"""A task of a farm's engine: some cells, one after the other, by one process."""

from pathlib import Path
from typing import TextIO

from ..cells.cell import run_cell
from ..cells.fits import SharedFits
from ..records.result import State
from .cell_range import cells_in


def run_task(folder: Path, cells: str, out: TextIO) -> int:
    """Run a range of a batch's cells, and tell each end in a line; the exit code.

    Engines stop a job at a task that does not end with 0. So 0 means that every cell has its result,
    even one that says that there is no solution; 1 that some failed and are worth another try.
    Raises BatchFault.
    """
    failed, fits = 0, SharedFits(folder)
    for cell in cells_in(folder, cells):
        result = run_cell(folder, cell, fits)
        failed += result.state is State.FAILED
        words = f"{cell}  {result.state.value}  {result.seconds.get('total', 0.0):.1f} s"
        print(words, result.sentence, sep="  ", file=out, flush=True)
    return int(failed > 0)
