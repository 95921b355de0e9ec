"""Collecting: from the cells' folders to table.csv, sheet.png and index.html."""

from __future__ import annotations

from pathlib import Path

from .contact_sheet import write_contact_sheet
from .gathering import PICTURE, GatheredBatch, gather
from .page_file import write_page
from .table import write_table


def collect(folder: Path) -> GatheredBatch:
    """Write table.csv, index.html and, where cells have pictures, sheet.png into a batch's folder;
    what they tell of.

    Cells that have not run yet are told as such, so it may be called at any time. Raises
    WrongManifest, FolderGone.
    """
    batch = gather(folder)
    write_table(batch, folder / "table.csv")
    write_page(batch, folder / "index.html")
    write_contact_sheet(batch, folder / PICTURE)
    return batch
