"""The picture of motions as a file; layouts and marks are made without Blender."""

from collections.abc import Sequence
from pathlib import Path

from ...solver.data.faults import OutputNotWritable
from .layout import lay_out
from .sheet import SheetRow, View


def draw_sheet(
    rows: Sequence[SheetRow], path: Path, view: View | None = None, *, width: int = 1600
) -> None:
    """Render the rows, first on top, to the PNG file `path`, `width` pixels wide.

    All rows share scale, framing and sideways spread (see `instants`). Works without a display;
    the user's scenes and data are left as they were. Blocks until done (seconds).
    Raises OutputNotWritable.
    """
    try:
        path.open("ab").close()
    except OSError as error:
        raise OutputNotWritable(str(path), error.strerror or "") from error
    from .cycles import render  # loads Blender, which processes that only solve do not need

    view = view or View()
    render(lay_out(rows, view), view, path, width)
