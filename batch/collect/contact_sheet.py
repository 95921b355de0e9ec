"""The contact sheet: small pictures of the cells, side by side in one PNG file, without Blender."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from ..records.faults import gone
from ..records.names import short_names
from ..records.result import State, cell_folder
from .files import file_aside
from .gathering import PICTURE, GatheredBatch, short_keys
from .letters import HIGH, write
from .png import Pixels, UnreadablePicture, read_png, shrunk, write_png

MOST = 60  # pictures; the page has them all
ACROSS = 5
SHOT = (340, 240)  # pixels
GAP, WORDS = 12, 2 * HIGH + 8  # pixels between tiles, and for the words below a picture
PAPER, EMPTY = (247, 248, 250), (228, 231, 236)
INK, QUIET, ALARM = (29, 37, 48), (90, 102, 117), (179, 38, 30)


def write_contact_sheet(batch: GatheredBatch, path: Path) -> None:
    """Every cell's picture, or of more than MOST cells every so manieth; who has none says so.

    Where no cell has a picture there is no sheet either, and one from before is removed. Raises
    FolderGone.
    """
    count = len(batch.plans)
    if not any(PICTURE in batch.files(i) for i in range(count)):
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise gone(path, error) from error
        return
    chosen = np.unique(np.linspace(0, count - 1, min(count, MOST)).astype(int)).tolist()
    title = batch.folder.resolve().name
    if len(chosen) < count:
        title += f": {len(chosen)} of {count} cells, evenly spread; index.html shows them all"
    wide, high = SHOT[0] + GAP, SHOT[1] + WORDS + GAP
    lines = -(-len(chosen) // ACROSS)
    head = HIGH + 2 * GAP
    across = min(ACROSS, len(chosen))
    sheet = np.empty((head + lines * high, GAP + across * wide, 3), np.uint8)
    sheet[:] = PAPER
    write(sheet, GAP, GAP, title, INK, sheet.shape[1] - 2 * GAP)
    names = short_names(plan.clip for plan in batch.plans)
    for k, i in enumerate(chosen):
        line, column = divmod(k, across)
        y, x = head + line * high, GAP + column * wide
        tile = sheet[y : y + high - GAP, x : x + SHOT[0]]
        _fill(tile, batch, i, names[batch.plans[i].clip])
    with file_aside(path) as aside:
        write_png(aside, sheet)


def _fill(tile: Pixels, batch: GatheredBatch, i: int, clip: str) -> None:
    """Picture and words of cell i."""
    shot = tile[: SHOT[1]]
    shot[:] = EMPTY
    picture = _picture(batch, i)
    if isinstance(picture, str):
        write(shot, 8, SHOT[1] // 2 - HIGH // 2, picture, QUIET, SHOT[0] - 16)
    else:
        small = shrunk(picture, *SHOT)
        y, x = (SHOT[1] - small.shape[0]) // 2, (SHOT[0] - small.shape[1]) // 2
        shot[y : y + small.shape[0], x : x + small.shape[1]] = small
    state, values = batch.states[i], batch.plans[i].values
    short = short_keys(batch.values)
    varied = (
        f"{short[name]} {json.dumps(x, ensure_ascii=False)}"
        for name, x in values.items()
        if len(set(batch.values[name])) > 1
    )
    write(tile, 0, SHOT[1] + 4, f"{i + 1}. {clip}", INK, SHOT[0])
    if state in (State.DONE, State.PLANNED):
        write(tile, 0, SHOT[1] + 4 + HIGH, ", ".join(varied), QUIET, SHOT[0])
    else:
        write(tile, 0, SHOT[1] + 4 + HIGH, f"{state.value}: {_why(batch, i)}", ALARM, SHOT[0])


def _picture(batch: GatheredBatch, i: int) -> Pixels | str:
    """A cell's picture, or why there is none."""
    if PICTURE not in batch.files(i):
        return "not run yet" if batch.results[i] is None else "no picture"
    try:
        return read_png(cell_folder(batch.folder, batch.plans[i].cell) / PICTURE)
    except UnreadablePicture:
        return "its picture cannot be read"


def _why(batch: GatheredBatch, i: int) -> str:
    result = batch.results[i]
    return "" if result is None else result.sentence
