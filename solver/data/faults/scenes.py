"""Faults of the scene: an object by itself, or a pin that stands on it."""

from dataclasses import dataclass

from .base import Fault, RequestFault


@dataclass
class SceneFault(Fault):
    """Base of faults of one object of the scene, by the artist's name for it."""

    thing: str


class NoFaces(SceneFault):
    """The object's mesh has no faces, or none with an area."""


class NotFinite(SceneFault):
    """A vertex or a place of the object is NaN or infinite."""


class InsideOut(SceneFault):
    """The faces of a closed mesh look inwards."""


class NoThickness(SceneFault):
    """The faces of a closed mesh lie on each other, such as those of a box that is scaled flat."""


@dataclass
class TooManyFaces(SceneFault):
    """The object has more triangles than can be worked with."""

    count: int
    most: int


@dataclass
class StandsIn(SceneFault):
    """A contact that no pin put upon an object is in it, by metres: below its surface, or beside
    it, behind a steep face, through which the way out is shorter."""

    contact: str
    metres: float
    beside: bool = False


@dataclass
class StandsBelow(SceneFault):
    """Everything that the recording stands on is in an object, metres below its top."""

    metres: float


@dataclass
class NoRoom(SceneFault):
    """A foot stands where the object leaves no room for its shank: metres that are free above it,
    and that the leg needs at least."""

    contact: str
    free: float
    needed: float


class SameObjectName(SceneFault):
    """Two objects of the scene by one name."""


class ObjectGone(SceneFault):
    """An object, or a collection, that was chosen is not in the scene any more."""


@dataclass
class UnknownObject(RequestFault):
    """A pin or a request names an object that the scene does not have."""

    thing: str
    known: tuple[str, ...]


@dataclass
class NotGround(RequestFault):
    """A pin stands on an object that is an obstacle."""

    thing: str


@dataclass
class NoFaceThere(RequestFault):
    """No face of the object is above or below where a pin's contact would be.

    at: (x, y) m of that, world. reach: (least x, greatest x) and (least y, greatest y) of the
    object, m, world. Both None of an object that is put under the pin, at its own origin.
    """

    contact: str
    thing: str
    at: tuple[float, float] | None = None
    reach: tuple[tuple[float, float], tuple[float, float]] | None = None


@dataclass
class OverTheEdge(RequestFault):
    """A contact of a foot hangs over the edge of the face on which the foot stands, by metres."""

    contact: str
    thing: str
    metres: float


@dataclass
class TooSteep(RequestFault):
    """A contact stands on a face steeper than its friction holds; slope: degrees, friction: its
    coefficient."""

    contact: str
    thing: str
    slope: float
    friction: float


@dataclass
class GroundNotThere(Fault):
    """A pin stands on an object whose poses do not cover its phase; frames: first, last."""

    pin: str
    object: str
    phase: str
    known: tuple[float, float]
    needed: tuple[float, float]


@dataclass
class JerkyGround(Fault):
    """A pin stands on an object that jumps at a frame; m/s², of the point that it stands on."""

    pin: str
    object: str
    frame: float
    acceleration: float
