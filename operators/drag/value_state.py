"""State machine of dragging one number, such as an angle, without Blender."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

from .pin_state import PRECISE, DragState

ANGLE_STEP = radians(5.0)


@dataclass
class ValueDrag:
    """One drag of a value from `start` between `low` and `high`; snapping goes to whole `step`s.

    After its end nothing moves it, and asking for that raises ValueError.
    """

    start: float
    low: float
    high: float
    step: float
    state: DragState = DragState.DRAGGING
    _value: float | None = None
    _loose: float = 0.0  # how far it is pulled, before bounds and steps
    _mouse: float = 0.0

    @property
    def value(self) -> float:
        return self.start if self._value is None else self._value

    def move(self, mouse: float, *, precise: bool = False, snap: bool = False) -> float:
        """The mouse is `mouse` from where it began. Returns the value now."""
        self._require()
        self._loose += (PRECISE if precise else 1.0) * (mouse - self._mouse)
        self._mouse = mouse
        value = self.start + self._loose
        if snap:
            value = self.step * round(value / self.step)
        self._value = min(max(value, self.low), self.high)
        return self._value

    def let_go(self) -> bool:
        """Returns whether the value has changed."""
        self._require()
        self.state = DragState.LET_GO
        return self.value != self.start

    def put_back(self) -> float:
        """Returns the value that it had."""
        self._require()
        self.state, self._value = DragState.PUT_BACK, None
        return self.start

    def _require(self) -> None:
        if self.state is not DragState.DRAGGING:
            raise ValueError(f"the drag is {self.state.value}")
