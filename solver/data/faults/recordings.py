"""Faults of a recording: the armature, its action, its keys, and what cannot be a person's."""

from dataclasses import dataclass
from enum import Enum

from ..problem import AddedContact
from ..requests import PointRequest
from ..scene import SupportBox
from .base import Fault


@dataclass
class NoArmature(Fault):
    """Nothing to adapt: the object chosen is not an armature (or there is none)."""

    object_name: str | None = None


@dataclass
class NotInScene(Fault):
    """The armature that was chosen is in other scenes, not in the one that is shown."""

    armature: str
    scene: str


@dataclass
class NoAction(Fault):
    """The armature carries no action."""

    armature: str


@dataclass
class UnreadStrips(Fault):
    """Strips of the nonlinear animation play what cannot be read as a recording. why: a reason, to
    be said after the strips' names."""

    armature: str
    strips: tuple[str, ...]
    why: str


@dataclass
class StripsOff(Fault):
    """Strips would play, but the armature's nonlinear animation is switched off."""

    armature: str
    strips: tuple[str, ...]


@dataclass
class BlendedAction(Fault):
    """The action is blended with strips below it: the pose is no longer what its keys say."""

    action: str
    strips: tuple[str, ...]


@dataclass
class NoBones(Fault):
    """The armature has no bones."""

    armature: str


@dataclass
class LibraryMissing(Fault):
    """The library file from which a data-block is linked is not there."""

    file: str
    linked: str


@dataclass
class ClipTooShort(Fault):
    """The clip is shorter than the shortest that can hold a motion.

    frames: its first and last. chosen: whether the recording has more than these.
    """

    seconds: float
    minimum_s: float
    frames: tuple[float, float]
    chosen: bool


@dataclass
class FramesFarApart(Fault):
    """Frames too rare to tell a motion, as of a file with a wrong frame time."""

    seconds: float
    maximum_s: float


@dataclass
class NotBetweenFrames(Fault):
    """Frames are said to be missing after one that has none after it in the recording."""

    frame: float
    first: float
    last: float


@dataclass
class NothingLeft(Fault):
    """As many frames as the recording has, or more, are to be left out at its ends."""

    trim: int
    trim_end: int
    frames: int


@dataclass
class NotPutIn(Fault):
    """Missing frames cannot be put into an action. why: a reason, to be said after its name."""

    action: str
    why: str


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
class NotMirrored(Fault):
    """A bone has no partner on the body's other side.

    partner: the name that is missing; the bone's own where that tells no side. Both are empty where
    no bone's name tells one.
    """

    bone: str
    partner: str


@dataclass
class MirroredInBlender(Fault):
    """A clip that shall be mirrored, and whose armature is not."""


@dataclass
class BoneTaken(MissingPart):
    """A body part that the physics needs has no bone, as its own was chosen for another part."""

    bone: str = ""
    by: str = ""


@dataclass
class NotJoined(Fault):
    """Legs and head hang on no common bone. bones: both thighs and the head."""

    bones: tuple[str, ...]


@dataclass
class NoSpine(Fault):
    """No bone between pelvis and head carries the arms."""

    pelvis: str
    head: str


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
class UnreadableRepairs(Fault):
    """What a file holds of a recording's repairs is none."""


class TextCure(Enum):
    """What writes a text anew that is not Hangtime's. The value is the variant of the words."""

    EXAMINE = 0
    ANALYZE = 1
    ADAPT = 2


@dataclass
class UnreadableText(Fault):
    """A property of an object or an action, in which Hangtime keeps a text, holds another."""

    owner: str
    property: str
    cure: TextCure


@dataclass
class UnreadableClip(Fault):
    """A motion file that cannot be read; line is 1-based, None where the format has no lines."""

    path: str
    line: int | None
    problem: str


@dataclass
class ClipNotOpened(Fault):
    """A motion file that is not there, or cannot be opened."""

    path: str
    problem: str


@dataclass
class NotInFile(Fault):
    """What a motion file was asked for by name and does not hold. what: "armature" or "take"."""

    path: str
    what: str
    name: str
    known: tuple[str, ...]


@dataclass
class OptionNotTaken(Fault):
    """An option of the command line that does not count for files of this kind."""

    option: str
    path: str


@dataclass
class UnknownClipFormat(Fault):
    """A file of another format than those that are read."""

    path: str


@dataclass
class FramesReversed(Fault):
    """The chosen frames end before they begin."""

    first: float
    last: float


@dataclass
class UnseenSupport(Fault):
    """Nothing touches, yet the body does not fall: something unrecorded carries it (frames).

    boxes: what would, where feet rest above the floor. leaning: whether another part of the body is
    on the floor. hands: their contacts, where that is hands. holds: of hands that hold on to
    something above; beside boxes either may be what carries. rate: frames a second at which the
    body would fall as gravity has it, where the scene's, scene_rate, is another. exchanged: whether
    the legs are there, so that none of these is meant. skidding: whether feet are on the ground,
    and go from place to place. resting: whether they stay there, without a contact. lying: whether
    another axis than Z points from the feet to the head. walls: contacts of feet that rest on
    something steep, where none rests on what boxes are for.
    """

    first: float
    last: float
    boxes: tuple[SupportBox, ...] = ()
    hands: tuple[AddedContact, ...] = ()
    rate: float | None = None
    scene_rate: float = 0.0
    leaning: bool = False
    exchanged: bool = False
    skidding: bool = False
    lying: bool = False
    resting: bool = False
    walls: tuple[AddedContact, ...] = ()
    holds: tuple[PointRequest, ...] = ()


@dataclass
class ScaledStrip(Fault):
    """The body falls at another frame rate than the scene's (as of `UnseenSupport`), while a strip
    plays its action slower or faster. scale: the strip's; fitting_scale: with which it would fall
    as gravity has it."""

    first: float
    last: float
    rate: float
    scene_rate: float
    strip: str
    scale: float
    fitting_scale: float


@dataclass
class UnseenSupports(Fault):
    """The same in several spans (first, last frame), of which no more is known, or leaning."""

    spans: tuple[tuple[float, float], ...]
    leaning: bool = False


@dataclass
class OffBalance(Fault):
    """What touches has the weight beside it in spans (first, last frame), as of who sits or leans:
    a hint, as the fit tells what that takes. hands: the contacts of those on the floor, that would
    carry it. resting: the spans within these in which the pelvis is still. touching: the limbs that
    touch ("Right hand"), where these are not the feet alone. holds: of hands that hold on to
    something above."""

    spans: tuple[tuple[float, float], ...]
    hands: tuple[AddedContact, ...] = ()
    resting: tuple[tuple[float, float], ...] = ()
    touching: tuple[str, ...] = ()
    holds: tuple[PointRequest, ...] = ()


@dataclass
class FitNeedsSupport(Fault):
    """No motion comes near the recording but with something unseen that carries the body, in spans
    (first, last frame), which its problem refuses."""

    spans: tuple[tuple[float, float], ...]


@dataclass
class Treadmill(Fault):
    """The feet slide along the floor at one steady speed, m/s, so no place holds them."""

    speed: float


CarriedBy = UnseenSupport | Treadmill | OffBalance  # what is told of what carries a recording


@dataclass
class OddHeight(Fault):
    """The figure is too tall or too short for a person, so that nothing it does obeys gravity."""

    armature: str
    metres: float
    factor: float  # that makes a person of it


@dataclass
class OddScale(Fault):
    """The scale that a recording is read with makes nobody of its figure."""

    scale: float
    metres: float  # its stature then
    factor: float  # that makes a person of it


@dataclass
class OutsideKeys(Fault):
    """The chosen frames lie beside the recording's, where nothing moves."""

    armature: str
    first: float  # frame with keys
    last: float


@dataclass
class SourceOutsideKeys(Fault):
    """The same of what the result that is shown was made from, while the result has keys there."""

    result: str
    source: str
    first: float  # frame with keys
    last: float


@dataclass
class UnknownContactName(Fault):
    """A correction names a contact that was not found."""

    name: str
    known: tuple[str, ...]
