"""Contacts and phases as bars over time: where they are in an editor, and what the mouse is at.

Knows nothing of Blender. Frames are the scene's; places px from the region's lower left corner.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from ...bridge.plots.screen import Axis, Rect
from .contact_edge_state import Edge

# px at an interface scale of 1
SCRUBBING = 24.0  # at the top of the editor, where the playhead is dragged
SCROLLER = 16.0  # at its foot
MARKERS = 42.0  # at its foot where there are any
TALLEST, LOWEST = 17.0, 5.0  # of a row
REACH = 8.0  # how far from an edge it can be grabbed


@dataclass(frozen=True)
class Bar:
    """A contact, a phase or frames that the doctor doubts; used: whether it counts; chosen: in the
    list of contacts."""

    name: str
    start: float
    end: float
    used: bool = True
    chosen: bool = False
    is_phase: bool = False
    firm: bool = False  # has no edges of its own that can be pulled: a flight, a doubt
    is_doubt: bool = False


@dataclass(frozen=True)
class Row:
    """Bars of the same point, or the phases."""

    name: str
    bars: tuple[Bar, ...]


@dataclass(frozen=True)
class Grip:
    """An edge that can be pulled."""

    bar: Bar
    edge: Edge


@dataclass(frozen=True)
class Bars:
    """Rows in an editor, the first at the top. axis: from frames to px."""

    rows: tuple[Row, ...]
    axis: Axis
    bottom: float
    row_height: float
    scale: float

    @property
    def room(self) -> Rect:
        """All the rows."""
        top = self.bottom + len(self.rows) * self.row_height
        return Rect(self.axis.start, self.bottom, self.axis.end, top)

    def row(self, index: int) -> Rect:
        """A row's room across the editor."""
        top = self.room.top - index * self.row_height
        return Rect(self.axis.start, top - self.row_height, self.axis.end, top)

    def placed(self) -> Iterator[tuple[Bar, Rect]]:
        """Every bar with its room, of which parts may be out of sight."""
        for index, row in enumerate(self.rows):
            room = self.row(index)
            for bar in row.bars:
                left, right = self.axis.at(bar.start), self.axis.at(bar.end)
                yield bar, Rect(left, room.bottom, right, room.top)

    def bar_at(self, x: float, y: float) -> Bar | None:
        """The bar under the mouse."""
        return next((bar for bar, rect in self.placed() if rect.holds(x, y)), None)

    def grip_at(self, x: float, y: float) -> Grip | None:
        """The edge nearest to the mouse within reach, in its row."""
        reach = REACH * self.scale
        near: list[tuple[float, bool, int, Grip]] = []
        for bar, rect in self.placed():
            if bar.firm or not bar.used or not rect.bottom <= y <= rect.top:
                continue
            outside = not rect.left <= x <= rect.right  # of two edges at one place, its own bar's
            for edge, at in ((Edge.START, rect.left), (Edge.END, rect.right)):
                if abs(x - at) <= reach:
                    near.append((abs(x - at), outside, len(near), Grip(bar, edge)))
        return min(near)[-1] if near else None


def lay_out(
    rows: tuple[Row, ...], axis: Axis, height: float, scale: float, *, markers: bool = False
) -> Bars | None:
    """Rows at the foot of an editor; the last alone, with the doubts over it, where it is low; None
    where it is too low.

    In Blender's usual layout nothing is free: there the last row lies over the strip with the
    frames' numbers, at whose foot there are none, or where even that is not free at its top.
    """
    bottom = (MARKERS if markers else SCROLLER) * scale
    free = height - SCRUBBING * scale - bottom
    if not rows or height < SCRUBBING * scale:
        return None
    each = min(TALLEST * scale, free / len(rows))
    if each >= LOWEST * scale:
        return Bars(rows, axis, bottom, each, scale)
    alone = min(max(free, LOWEST * scale), TALLEST * scale)
    if free <= -LOWEST * scale:
        bottom = height - alone
    return Bars((_in_one(rows),), axis, bottom, alone, scale)


def _in_one(rows: tuple[Row, ...]) -> Row:
    """The last row, with what is wrong with the recording drawn over it."""
    doubts = [bar for row in rows[:-1] for bar in row.bars if bar.is_doubt]
    return Row(rows[-1].name, (*rows[-1].bars, *doubts))
