"""Results that other machines wrote: file systems on a network may show them late."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from ..records.faults import FolderGone
from ..records.result import CELLS, read_result

LONGEST = 90.0  # s; NFS looks again at a folder after 60 at the latest
PAUSE = 0.5  # s


def await_results(
    folder: Path, cells: Iterable[str], tell: Callable[[str], None], longest: float = LONGEST
) -> None:
    """Until the results of cells that have ended are to be seen here as well. Raises FolderGone."""
    until = time.monotonic() + longest
    unseen, told = list(cells), False
    while unseen := [cell for cell in unseen if read_result(folder, cell) is None]:
        if time.monotonic() > until:
            raise FolderGone(
                f"The results of {len(unseen)} cells, such as {unseen[0]}, were written by other "
                f"machines but are not in {folder / CELLS}; see that these have the same folder "
                "there, then give the same command again."
            )
        if not told:
            tell(
                f"{len(unseen)} results are not yet to be seen in {folder}; file systems on a "
                "network may show them a minute late, and the batch waits for them."
            )
        told = True
        with suppress(OSError):  # told by `read_result`
            os.listdir(folder / CELLS)  # has some file systems look anew
        time.sleep(PAUSE)
