"""The picture of a result: strobe figures of each motion, one row above the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..solver.faults import OutputNotWritable
from ..solver.recording import FloatArray


@dataclass(frozen=True)
class Limb:
    """One rigid body, drawn as a solid.

    size: (3,) extents m of its box: width, depth, length along the axes of the body's frame. The
    trunk's depth axis points to where the body faces.
    centre: (T, 3) m, world. rotation: (T, 3, 3), body to world.
    """

    name: str
    size: FloatArray
    centre: FloatArray
    rotation: FloatArray


@dataclass(frozen=True)
class SheetRow:
    """One motion of the picture; world frame, m, Z up.

    times: (T,) s, increasing. com: (T, 3) centre of mass. pins: (P, 3) contact points.
    key_times: instants (s) that must be shown, such as take-off, apex and landing.
    pin_times: for each pin the first and last instant (s) it holds; where left out, a pin holds
    whenever the body touches it.
    """

    title: str
    times: FloatArray
    limbs: tuple[Limb, ...]
    com: FloatArray
    pins: FloatArray
    key_times: tuple[float, ...] = ()
    pin_times: tuple[tuple[float, float], ...] = ()


def draw_sheet(rows: Sequence[SheetRow], path: Path, *, width: int = 1800) -> None:
    """Render the rows, first on top, to the PNG file `path`, `width` pixels wide.

    All rows share scale, framing and sideways spread (see `sheet_layout`). Works without a
    display; the user's scenes and data are left as they were. Blocks until done (seconds).
    Raises OutputNotWritable.
    """
    from . import sheet_layout, sheet_render

    try:
        path.open("ab").close()
    except OSError as error:
        raise OutputNotWritable(str(path), error.strerror or "") from error
    sheet_render.render(sheet_layout.lay_out(rows), path, width)
