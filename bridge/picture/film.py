"""A film of motions: the rows of the picture, each with one figure that moves."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import OutputNotWritable
from .layout import Figure, Layout, canvas_of, lay_out
from .sheet import SheetRow, View

RATE = 24  # frames per second


def draw_film(
    rows: Sequence[SheetRow], path: Path, view: View | None = None, *, width: int = 480
) -> None:
    """Render the rows, first on top, to the MPEG-4 file `path` (H.264), `width` pixels wide
    (less where it would be higher than wide).

    All rows begin at the same time; who ends first stays as it is. Objects stand as they are at the
    end. Blocks until done (some 0.3 s a frame). Works without a display, and
    leaves the user's scenes as they were. Raises OutputNotWritable.
    """
    try:
        path.open("ab").close()
    except OSError as error:
        raise OutputNotWritable(str(path), error.strerror or "") from error
    from .cycles import render_film  # loads Blender, which processes that only solve do not need

    view = replace(view or View(), in_place=True)
    render_film(lay_out_film(rows, view), view, path, width, RATE)


def lay_out_film(rows: Sequence[SheetRow], view: View) -> Layout:
    """The layout of the picture in place, with a figure for every frame of the film in each row."""
    layout, canvas = lay_out(rows, view), canvas_of(rows, view)
    longest = max(float(np.ptp(row.times)) for row in rows)
    frames = np.arange(round(longest * RATE) + 1) / RATE
    tiers = tuple(
        replace(tier, figures=tuple(_figures(canvas.row(row), frames)))
        for tier, row in zip(layout.tiers, rows, strict=True)
    )
    reach = np.concatenate([tier.corners() for tier in tiers])
    return Layout(tiers, layout.floor, reach.min(axis=0), reach.max(axis=0))


def _figures(row: SheetRow, frames: FloatArray) -> list[Figure]:
    """The body at the row's instants nearest to the frames (s from its start)."""
    centre = np.stack([limb.centre for limb in row.limbs], axis=1)
    rotation = np.stack([limb.rotation for limb in row.limbs], axis=1)
    step = np.median(np.diff(row.times)) if len(row.times) > 1 else 1.0
    shown = np.searchsorted(row.times, row.times[0] + frames - step / 2).clip(
        max=len(row.times) - 1
    )
    return [
        Figure(float(row.times[i]), centre[i], rotation[i], row.com[i], {}) for i in shown.tolist()
    ]
