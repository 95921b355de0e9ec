"""Exceptions for faulty input and failed solves, as data; worded in operators/words only."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from difflib import get_close_matches

from .row_kinds import Violation
from .status import Status


@dataclass
class Fault(Exception):
    """Base of every fault that an artist can mend; each subclass carries where and by how much."""

    def __reduce__(self) -> tuple[Callable[..., "Fault"], tuple[object, ...]]:
        """Pickled by its fields: an exception's own way forgets those that were given by name."""
        return type(self), tuple(getattr(self, field.name) for field in fields(self))


@dataclass
class RequestFault(Fault):
    """Base of faults of one request, which goes by the name that the artist gave it."""

    request: str


@dataclass
class NoArmature(Fault):
    """Nothing to adapt: the object chosen is not an armature (or there is none)."""

    object_name: str | None = None


@dataclass
class NoAction(Fault):
    """The armature carries no action."""

    armature: str


@dataclass
class NoBones(Fault):
    """The armature has no bones."""

    armature: str


@dataclass
class ClipTooShort(Fault):
    """The clip is shorter than the shortest that can hold a jump."""

    seconds: float
    minimum_s: float


@dataclass
class ZeroLengthBone(Fault):
    """A bone that must carry mass has no length."""

    bone: str


@dataclass
class MissingPart(Fault):
    """A body part that the physics needs has no bone."""

    part: str
    tried: tuple[str, ...] = ()


@dataclass
class NonFiniteKey(Fault):
    """A key is NaN or infinite."""

    bone: str
    frame: float


@dataclass
class BadScale(Fault):
    """The object's scale is not uniform and positive."""

    object_name: str
    scale: tuple[float, float, float]


@dataclass
class UnreadableClip(Fault):
    """A motion file that cannot be read; line is 1-based, None where the format has no lines."""

    path: str
    line: int | None
    problem: str


@dataclass
class BadRecipe(Fault):
    """A recipe with an unknown key, bone or phase, or a value of the wrong kind."""

    path: str
    line: int | None
    problem: str


@dataclass
class OutputNotWritable(Fault):
    """The output folder cannot be made or written."""

    path: str
    problem: str


@dataclass
class ContradictoryPins(Fault):
    """Two pins that no pose can hold at once."""

    first: str
    second: str
    metres: float


@dataclass
class NoSolution(Fault):
    """The solver ended without meeting every constraint; worst first.

    reached: the share of the way that the best motion found goes.
    """

    reason: Status
    worst: tuple[Violation, ...] = ()
    reached: float = 0.0


@dataclass
class NoFit(NoSolution):
    """The same for the recording's own motion, before any pin has moved."""


@dataclass
class UnseenSupport(Fault):
    """Nothing touches, yet the body does not fall: something unrecorded carries it (frames)."""

    first: float
    last: float


@dataclass
class Treadmill(Fault):
    """The feet slide along the floor at one steady speed, m/s, so no place holds them."""

    speed: float


@dataclass
class OddHeight(Fault):
    """The figure is too tall or too short for a person, so that nothing it does obeys gravity."""

    armature: str
    metres: float
    factor: float  # that makes a person of it


@dataclass
class OutsideKeys(Fault):
    """The chosen frames lie beside the recording's, where nothing moves."""

    armature: str
    first: float  # frame with keys
    last: float


@dataclass
class UnknownContactName(Fault):
    """A correction names a contact that was not found."""

    name: str
    known: tuple[str, ...]


@dataclass
class UnknownBone(RequestFault):
    """A request names a bone that the armature does not have."""

    bone: str


@dataclass
class NotAboveZero(RequestFault):
    """A request's mass, or factor on a length or a mass, is zero, negative or not given."""

    amount: float


@dataclass
class WorkerDied(Fault):
    """The process that solves ended without an answer; detail: what it last said, or its code."""

    detail: str


@dataclass
class ChangedMeanwhile(Fault):
    """The armature, its action or its keys are no longer what was analysed or sent to be solved.

    while_solving: whether a result had to be thrown away for it.
    """

    armature: str
    while_solving: bool


@dataclass
class BadDimensions(Fault):
    """A model reduction to no dimension at all, or to more than the joints have."""

    given: int
    most: int


@dataclass
class UnknownReductionBone(Fault):
    """A row (1-based) of the reduction's matrix names a bone whose joint it cannot tie."""

    row: int
    bone: str
    known: tuple[str, ...]


@dataclass
class WrongWeights(Fault):
    """A row (1-based) of the reduction's matrix has more or fewer weights than a joint angles."""

    row: int
    bone: str
    given: int
    needed: int


@dataclass
class DependentRows(Fault):
    """Rows of the reduction's matrix that say the same, or nothing: fewer count than there are."""

    rows: int
    rank: int


@dataclass
class UnknownPhaseIn(RequestFault):
    """A request names a phase that the clip does not have."""

    phase: str
    known: tuple[str, ...]


@dataclass
class StillBone(RequestFault):
    """A request names a bone that the figure's bodies do not move."""

    bone: str
    known: tuple[str, ...]

    @property
    def likeliest(self) -> tuple[str, ...]:
        """Those names that are most like it: all of them would run off the screen."""
        return tuple(get_close_matches(self.bone, self.known, n=4, cutoff=0.0))


@dataclass
class BadTiming(RequestFault):
    """A request's time is empty, too short, or outside the clip; seconds: how long it would be."""

    seconds: float


@dataclass
class RootHasNoJoint(RequestFault):
    """A joint's limit or torque was asked of the root bone, which has no joint to a parent."""

    bone: str


class NeedsTorques(RequestFault):
    """A torque was limited, but the reduced dynamics that were chosen have none."""


@dataclass
class NothingTouches(RequestFault):
    """A request names contacts, points or bones of which none touches; none named means all."""

    touching: tuple[str, ...]


@dataclass
class WrongAngle(RequestFault):
    """A request names an angle that a joint does not have; count: how many it has."""

    bone: str
    count: int


class FreePoint(RequestFault):
    """A point that the world shall push at is held in no direction."""


class TakenName(RequestFault):
    """A point that the world shall push at is called like a contact that was found."""


@dataclass
class TimedTwice(RequestFault):
    """A second request for the duration of one phase."""

    phase: str


class NoBoneChosen(RequestFault):
    """A request of a kind that is about a bone names none."""


@dataclass
class NoPhaseChosen(RequestFault):
    """A request that is to hold in a phase names none."""

    known: tuple[str, ...]


@dataclass
class EmptyRange(RequestFault):
    """A request's last frame comes before its first."""

    first: float
    last: float


@dataclass
class CrossedBounds(RequestFault):
    """A request's least value is above its greatest; both in `unit`."""

    at_least: float
    at_most: float
    unit: str


class AsksNothing(RequestFault):
    """A request in which everything that it could ask for is switched off."""


class NoDirection(RequestFault):
    """An axis or a normal of a request that is zero, so that it points nowhere."""


class NamedTwice(RequestFault):
    """Two requests, or a request and a contact, of the same name; reports could not tell them."""


@dataclass
class NameMissing(Fault):
    """A request without a name; kind: what it is, in the artist's words."""

    kind: str


@dataclass
class UnknownPhase(Fault):
    """A pin names a phase that the clip does not have."""

    pin: str
    phase: str
    known: tuple[str, ...]


@dataclass
class UnknownContact(Fault):
    """A pin names a bone or point that does not touch in its phase."""

    pin: str
    what: str
    known: tuple[str, ...]


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


@dataclass
class TooManyFaces(SceneFault):
    """The object has more triangles than can be worked with."""

    count: int
    most: int


class SameObjectName(SceneFault):
    """Two objects of the scene by one name."""


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
    """No face of the object is above or below where a pin's contact would be."""

    contact: str
    thing: str


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


class ObjectGone(SceneFault):
    """An object, or a collection, that was chosen is not in the scene any more."""


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
