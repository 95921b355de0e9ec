"""What is another than it was analysed, or changed while it was solved."""

from dataclasses import dataclass

from .base import Fault


@dataclass
class RateChanged(Fault):
    """The scene plays the recording at another frame rate than when it was analysed, or sent to be
    solved: another motion.

    while_solving: whether a result had to be thrown away for it.
    """

    before: float  # frames/s
    now: float
    while_solving: bool


@dataclass
class TimeStretched(Fault):
    """The scene shows its frames at other times than they are keyed: `new` of them are shown for
    each `old` (Blender's Time Stretching)."""

    old: int
    new: int


@dataclass
class LostEdits(Fault):
    """Contacts that the artist had changed are not found any more, by their names before."""

    contacts: tuple[str, ...]


@dataclass
class SpanChanged(Fault):
    """Other frames are to be adapted than were analysed; first and last scene frame."""

    before: tuple[float, float]
    now: tuple[float, float]


@dataclass
class ChangedMeanwhile(Fault):
    """The armature, its action or its keys are no longer what was analysed or sent to be solved.

    while_solving: whether a result had to be thrown away for it. changed: its parts that did, in
    words; nothing where that is not known.
    """

    armature: str
    while_solving: bool
    changed: tuple[str, ...] = ()


@dataclass
class ArmatureGone(Fault):
    """The armature was removed while it was solved."""

    armature: str


@dataclass
class EditedMeanwhile(Fault):
    """The armature is in edit mode as its result is to be written, when no bone can be posed."""

    armature: str


@dataclass
class UndoneMeanwhile(Fault):
    """Something was undone or redone, or another file opened, while the scene was read or written
    in parts."""


@dataclass
class ActionGone(Fault):
    """An action was removed while a result was written: the recording's, or the result itself."""

    action: str


@dataclass
class ChangedWhileRead(Fault):
    """The armature changed while it was read in parts, of which the first are others than the last.

    changed: what of it, in words.
    """

    armature: str
    changed: tuple[str, ...]
