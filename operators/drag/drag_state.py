"""State machines of dragging a pin, or one number such as an angle; without Blender."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from math import hypot, radians

Vector = tuple[float, float, float]

PRECISE = 0.1
SNAP = 0.05  # m
FURTHEST = 10.0  # m
ANGLE_STEP = radians(5.0)


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
class _Drag:
    """Base: after its end nothing moves a drag, and asking for that raises ValueError."""

    state: DragState = field(default=DragState.DRAGGING, init=False)

    def _require_dragging(self) -> None:
        if self.state is not DragState.DRAGGING:
            raise ValueError(f"the drag is {self.state.value}")

    def _end(self, state: DragState) -> None:
        self._require_dragging()
        self.state = state


@dataclass(frozen=True)
class Landing:
    """A face that a pin lands on: its height (m, world) there, and the name of its object."""

    height: float
    ground: str


@dataclass
class PinDrag(_Drag):
    """One drag of a pin that was at `start` (m, world). Slides over the ground unless held to an
    axis.

    lands: the face at x and y (m, world), if any; None where pins do not snap to surfaces. floor:
    the height, m, beside all faces of a pin that began on one; None leaves it where it is dragged.
    """

    start: Vector
    axis: Axis | None = None
    lands: Callable[[float, float], Landing | None] | None = None
    floor: float | None = None
    landing: Landing | None = field(default=None, init=False)
    _shift: Vector = (0.0, 0.0, 0.0)
    _loose: Vector = (0.0, 0.0, 0.0)  # how far it is pulled, before steps and axes
    _mouse: Vector = (0.0, 0.0, 0.0)

    def key(self, axis: Axis) -> None:
        """An axis's key: holds to it, or lets go of it again. The mouse's next move counts from
        where the drag began, on that axis."""
        self._require_dragging()
        self.axis = None if self.axis is axis else axis
        self.landing = None
        self._shift = self._loose = self._mouse = (0.0, 0.0, 0.0)

    def move(self, shift: Vector, *, precise: bool = False, snap: bool = False) -> Vector:
        """The mouse is `shift` (m) from where it began, on the plane or axis of the drag. Returns
        where the pin is now. precise: goes a tenth of the mouse's way, from here on and without
        a jump at either end; snap: to whole steps, and not to faces."""
        self._require_dragging()
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
        return self._go((moved[0] / far, moved[1] / far, moved[2] / far), lands=not snap)

    def set(self, shift: Vector) -> Vector:
        """The same by numbers, wherever the mouse is, which leads again as if nothing was typed."""
        self._require_dragging()
        return self._go(shift, lands=True)

    def _go(self, shift: Vector, *, lands: bool) -> Vector:
        self._shift = shift
        self._land(holds=lands and self.axis is not Axis.Z)
        return self.place

    def _land(self, *, holds: bool) -> None:
        """Takes the height of the face that the pin is above or below. holds: False lets go."""
        self.landing = None
        if self.lands is None or not holds:
            return
        x, y, _ = self.place
        self.landing = self.lands(x, y)
        height = self.floor if self.landing is None else self.landing.height
        if height is not None:
            self._shift = (*self._shift[:2], height - self.start[2])

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
        self._end(DragState.LET_GO)
        return any(self._shift)

    def put_back(self) -> Vector:
        """The artist thinks better of it. Returns where the pin was."""
        self._end(DragState.PUT_BACK)
        self._shift, self.landing = (0.0, 0.0, 0.0), None
        return self.start


@dataclass
class ValueDrag(_Drag):
    """One drag of a value from `start` between `low` and `high`; snapping goes to whole `step`s."""

    start: float
    low: float
    high: float
    step: float
    _value: float | None = None
    _loose: float = 0.0  # how far it is pulled, before bounds and steps
    _mouse: float = 0.0

    @property
    def value(self) -> float:
        return self.start if self._value is None else self._value

    def move(self, mouse: float, *, precise: bool = False, snap: bool = False) -> float:
        """The mouse is `mouse` from where it began. Returns the value now."""
        self._require_dragging()
        self._loose += (PRECISE if precise else 1.0) * (mouse - self._mouse)
        self._mouse = mouse
        value = self.start + self._loose
        return self._go(self.step * round(value / self.step) if snap else value)

    def set(self, by: float) -> float:
        """The same by a number, wherever the mouse is, which leads again as if none was typed."""
        self._require_dragging()
        return self._go(self.start + by)

    def _go(self, value: float) -> float:
        self._value = min(max(value, self.low), self.high)
        return self._value

    def let_go(self) -> bool:
        """Returns whether the value has changed."""
        self._end(DragState.LET_GO)
        return self.value != self.start

    def put_back(self) -> float:
        """Returns the value that it had."""
        self._end(DragState.PUT_BACK)
        self._value = None
        return self.start
