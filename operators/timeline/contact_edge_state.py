"""State machine of retiming a contact or a phase by its edge: its range, and what goes along.

Knows nothing of Blender; frames are the scene's.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

SHORTEST = 1.0  # frames between the edges of a contact
FINE = 0.1  # frames; steps without snapping
SAME_EDGE = 1e-3  # frames; edges that are closer are one


class Edge(Enum):
    """An end of a bar."""

    START = "Start"
    END = "End"


@dataclass(frozen=True)
class Touch:
    """A contact that counts: its name, its point, and from when to when it touches."""

    name: str
    point: str
    start: float
    end: float

    def frame(self, edge: Edge) -> float:
        return self.start if edge is Edge.START else self.end


class EdgeDragState(Enum):
    """States of a drag."""

    READY = "ready"
    PULLED = "pulled"
    DONE = "done"
    CANCELLED = "cancelled"


@dataclass
class EdgeDrag:
    """A drag of one edge. begin, then move as often as needed, then release or cancel.

    origin: where the edge was. lowest, highest: how far it goes. leaders: the frames of the edges
    that go with it; others: those that only make way when it comes past them. slack: frames of
    the mouse's way until the edge follows, so that a click moves nothing.
    """

    edge: Edge
    origin: float
    lowest: float
    highest: float
    leaders: dict[str, float]
    others: dict[str, float]
    slack: float = 0.0
    stage: EdgeDragState = EdgeDragState.READY
    frame: float = 0.0
    _grabbed: float = 0.0
    _loose: bool = False

    @property
    def change(self) -> float:
        """By how many frames the edge has been moved."""
        return self.frame - self.origin

    def begin(self, mouse: float) -> None:
        """The button went down with the mouse over frame `mouse`."""
        self.stage, self.frame = EdgeDragState.PULLED, self.origin
        self._grabbed, self._loose = mouse, False

    def move(self, mouse: float, *, fine: bool = False) -> dict[str, float]:
        """The mouse is over another frame; where the edges are now. fine: not on whole frames."""
        assert self.stage is EdgeDragState.PULLED
        pulled = mouse - self._grabbed
        self._loose = self._loose or abs(pulled) > self.slack
        if self._loose:
            self.put(self.origin + pulled, fine=fine)
        return self.edges

    def put(self, frame: float, *, fine: bool = False) -> None:
        """Moves the edge as near to a frame as it goes."""
        step = FINE if fine else 1.0
        self.frame = min(max(step * round(frame / step), self.lowest), self.highest)

    @property
    def edges(self) -> dict[str, float]:
        """The frames of the contacts' edges, by their names."""
        if self.frame == self.origin:
            return self.restored
        makes_way = max if self.edge is Edge.START else min
        led = dict.fromkeys(self.leaders, self.frame)
        return led | {name: makes_way(was, self.frame) for name, was in self.others.items()}

    @property
    def restored(self) -> dict[str, float]:
        """As they were."""
        return self.leaders | self.others

    def release(self) -> bool:
        """The button went up. Whether anything has been moved."""
        self.stage = EdgeDragState.DONE
        return self.change != 0.0

    def cancel(self) -> dict[str, float]:
        """Gives up; where the edges were."""
        self.stage, self.frame = EdgeDragState.CANCELLED, self.origin
        return self.restored


def contact_drag(
    touches: Iterable[Touch], name: str, edge: Edge, clip: tuple[float, float]
) -> EdgeDrag:
    """Of a contact's edge, between its other edge and the point's next contact or the clip's end.

    Raises KeyError where no contact has the name.
    """
    every = {touch.name: touch for touch in touches}
    touch = every[name]
    fellows = [t for t in every.values() if t.point == touch.point and t is not touch]
    if edge is Edge.START:
        lowest = max([clip[0], *(t.end for t in fellows if t.end <= touch.start + SAME_EDGE)])
        highest = touch.end - SHORTEST
    else:
        lowest = touch.start + SHORTEST
        highest = min([clip[1], *(t.start for t in fellows if t.start >= touch.end - SAME_EDGE)])
    origin = touch.frame(edge)
    return EdgeDrag(edge, origin, min(lowest, origin), max(highest, origin), {name: origin}, {})


def phase_drag(
    touches: Iterable[Touch], stance: tuple[float, float], edge: Edge, clip: tuple[float, float]
) -> EdgeDrag:
    """Of the edge of a stance, which is a ground phase from frame to frame.

    The contacts that make the edge go with it; others of the stance are cut where it passes them.
    It leaves the flight beside it a frame at least.
    """
    every = list(touches)
    mine = [t for t in every if t.start < stance[1] and t.end > stance[0]]
    origin = stance[0] if edge is Edge.START else stance[1]
    if edge is Edge.START:
        before = [t.end + SHORTEST for t in every if t.end <= origin + SAME_EDGE]
        lowest, highest = max([clip[0], *before]), min(t.end for t in mine) - SHORTEST
    else:
        after = [t.start - SHORTEST for t in every if t.start >= origin - SAME_EDGE]
        lowest, highest = max(t.start for t in mine) + SHORTEST, min([clip[1], *after])
    frames = {t.name: t.frame(edge) for t in mine}
    leaders = {name: frame for name, frame in frames.items() if abs(frame - origin) <= SAME_EDGE}
    others = {name: frame for name, frame in frames.items() if name not in leaders}
    return EdgeDrag(edge, origin, min(lowest, origin), max(highest, origin), leaders, others)
