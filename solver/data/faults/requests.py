"""Faults of one request or pin, by the name that the artist gave it."""

from dataclasses import dataclass
from difflib import get_close_matches

from .base import Fault, RequestFault


@dataclass
class UnknownBone(RequestFault):
    """A request names a bone that the armature does not have."""

    bone: str


@dataclass
class NotAboveZero(RequestFault):
    """A request's mass, or factor on a length, thickness or mass, is zero, negative or missing."""

    amount: float


@dataclass
class BeyondReason(RequestFault):
    """A request's factor is so large that nobody means it, and no memory has room for it."""

    amount: float
    most: float


@dataclass
class ReturnTooEarly(Fault):
    """A take is to be back where it was by a frame of the recording that is adapted itself."""

    frame: float
    last: float


@dataclass
class ReturnTooLate(Fault):
    """A take is to be back where it was by a frame that it does not have. end: the take's last."""

    frame: float
    end: float


@dataclass
class NoNewSlot(Fault):
    """A result is to be a new slot of an action that can have none. why: to be said after that."""

    action: str
    why: str


@dataclass
class SeveralTakes(Fault):
    """Several takes are to go into a file that can hold one."""

    takes: tuple[str, ...]


@dataclass
class SameUsdNames(Fault):
    """Two bones would have one name in a USD file."""

    first_bone: str
    second_bone: str


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
class JoinedPhase(RequestFault):
    """A request is about a whole phase that the fit joined with others or divided, as something
    unseen carries the body there; kept: the phases of its kind that are still their own."""

    phase: str
    kept: tuple[str, ...]


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
    """A request's time is empty or too short; seconds: how long it would be."""

    seconds: float


@dataclass
class BesideFrames(RequestFault):
    """A request is about frames beside those that are adapted; at: the frame nearest to these."""

    at: float
    first: float
    last: float


@dataclass
class BesidePhase(RequestFault):
    """A request is about frames and a phase that have none in common."""

    phase: str
    first: float
    last: float


@dataclass
class NoSuchPoseFrame(RequestFault):
    """A request takes a pose from a frame beside those that are adapted."""

    frame: float
    first: float
    last: float


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


class NamedAsPhase(RequestFault):
    """A held frame is called as a phase is; what another request says of that name could be about
    either."""


@dataclass
class TimedTwice(RequestFault):
    """A second request for the duration of one phase."""

    phase: str


@dataclass
class TooMuchTime(RequestFault):
    """Requests make the motion longer by so many seconds than it was recorded; this one by most of
    them. most: s that may be added."""

    seconds: float
    most: float


@dataclass
class BeyondPrecision(RequestFault):
    """A pin moves what touches by so many metres that places there are not told closely enough."""

    metres: float
    most: float


@dataclass
class OutOfReach(RequestFault):
    """A request's place is `metres` from that of `other`, `seconds` earlier or later: nobody can
    go so far in that time."""

    other: str
    metres: float
    seconds: float


@dataclass
class PeakTooLow(RequestFault):
    """A request's peak of contact forces, under which no body could keep up; least: it could not
    with less than this. Both in standard weights (constants.py)."""

    peak: float
    least: float


@dataclass
class PoseHeld(RequestFault):
    """A pose holds the whole body through stances that a pin moves against each other, by
    metres."""

    pin: str
    metres: float


class NoBoneChosen(RequestFault):
    """A request of a kind that is about a bone names none."""


@dataclass
class AimedBone(RequestFault):
    """A request names a bone that constraints or drivers aim, or one that hangs on such a bone."""

    bone: str


@dataclass
class NoPhaseChosen(RequestFault):
    """A request that is to hold in a phase names none."""

    known: tuple[str, ...]


@dataclass
class EmptyRange(RequestFault):
    """A request's last frame comes before its first."""

    first: float
    last: float


class PlacedNowhere(RequestFault):
    """A contact whose place or frames are NaN or infinite, as a script can set them."""


@dataclass
class NoNumber(Fault):
    """A setting that is NaN, as a script can set it; called as its field is."""

    setting: str


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
