"""State machine of dragging a pin, without Blender."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import hypot

Vector = tuple[float, float, float]

PRECISE = 0.1
SNAP = 0.05  # m
FURTHEST = 10.0  # m


class Axis(Enum):
    """Axis constraint of a drag."""

    X = 0
    Y = 1
    Z = 2


class DragState(Enum):
    """States of a drag."""

    DRAGGING = "dragging"
    LET_GO = "let go"
    PUT_BACK = "put back"


@dataclass
class PinDrag:
    """One drag of a pin that was at `start` (m, world). Slides over the ground unless held to an
    axis; after its end nothing moves it, and asking for that raises ValueError."""

    start: Vector
    axis: Axis | None = None
    state: DragState = DragState.DRAGGING
    _shift: Vector = (0.0, 0.0, 0.0)
    _loose: Vector = (0.0, 0.0, 0.0)  # how far it is pulled, before steps and axes
    _mouse: Vector = (0.0, 0.0, 0.0)

    def key(self, axis: Axis) -> None:
        """An axis's key: holds to it, or lets go of it again. The mouse's next move counts from
        where the drag began, on that axis."""
        self._require(DragState.DRAGGING)
        self.axis = None if self.axis is axis else axis
        self._shift = self._loose = self._mouse = (0.0, 0.0, 0.0)

    def move(self, shift: Vector, *, precise: bool = False, snap: bool = False) -> Vector:
        """The mouse is `shift` (m) from where it began, on the plane or axis of the drag. Returns
        where the pin is now. precise: goes a tenth of the mouse's way, from here on and without
        a jump at either end; snap: to whole steps."""
        self._require(DragState.DRAGGING)
        share = PRECISE if precise else 1.0
        x, y, z = (
            was + share * (now - before)
            for was, now, before in zip(self._loose, shift, self._mouse, strict=True)
        )
        self._loose, self._mouse = (x, y, z), shift
        moved = [SNAP * round(each / SNAP) if snap else each for each in self._loose]
        if self.axis is not None:
            moved = [each if i == self.axis.value else 0.0 for i, each in enumerate(moved)]
        far = max(hypot(*moved) / FURTHEST, 1.0)  # near the horizon a pixel is a mile
        self._shift = (moved[0] / far, moved[1] / far, moved[2] / far)
        return self.place

    @property
    def shift(self) -> Vector:
        """Displacement of the pin, m."""
        return self._shift

    @property
    def place(self) -> Vector:
        """Position of the pin, m, world."""
        x, y, z = (a + b for a, b in zip(self.start, self._shift, strict=True))
        return x, y, z

    def let_go(self) -> bool:
        """The artist lets go. Returns whether the pin has moved at all."""
        self._require(DragState.DRAGGING)
        self.state = DragState.LET_GO
        return any(self._shift)

    def put_back(self) -> Vector:
        """The artist thinks better of it. Returns where the pin was."""
        self._require(DragState.DRAGGING)
        self.state, self._shift = DragState.PUT_BACK, (0.0, 0.0, 0.0)
        return self.start

    def _require(self, state: DragState) -> None:
        if self.state is not state:
            raise ValueError(f"the drag is {self.state.value}")
