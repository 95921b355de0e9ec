"""What the doctor finds in a recording: what, where, how much, and the remedy."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .repairs import Repairs


class FindingKind(Enum):
    """Kinds of findings. The value is the word in files."""

    UP_AXIS = "up axis"
    BIND_POSE = "bind pose"
    FULL_TURN = "full turn"
    EXCHANGED_LEGS = "exchanged legs"
    EXCHANGED_ARMS = "exchanged arms"
    FLIP = "flip"
    SPIKE = "spike"
    CONVERTED_RATE = "converted rate"
    HELD_FRAMES = "held frames"
    REPEATED_FRAMES = "repeated frames"
    DROPPED_FRAMES = "dropped frames"
    BONE_LENGTH = "bone length"
    NOISE = "noise"
    LEVEL_HIPS = "level hips"
    TIME_SCALE = "time scale"
    RETIMED = "retimed part"
    SIZE = "size"
    TOO_SHORT = "too short"
    MASS = "mass"
    JUMP = "jump"
    LEAP = "leap"
    FLOOR = "floor"
    TILTED = "tilted floor"
    RISING = "rising"
    SLIDING = "sliding"
    IN_PLACE = "in place"
    FLOATING = "floating"
    SINKING = "sinking"
    SLIDING_FEET = "sliding feet"
    FLICKER = "flicker"
    UNSEEN_SUPPORT = "unseen support"
    SKIDDING = "skidding"
    OFF_BALANCE = "off balance"
    BEGINS_IN_AIR = "begins in the air"
    ENDS_IN_AIR = "ends in the air"

    @property
    def note(self) -> bool:
        """Whether it is worth knowing and no damage: an honest recording may have it."""
        return self in _NOTES


_NOTES = (
    FindingKind.SLIDING_FEET,
    FindingKind.UNSEEN_SUPPORT,
    FindingKind.SKIDDING,
    FindingKind.OFF_BALANCE,
    FindingKind.BEGINS_IN_AIR,
    FindingKind.ENDS_IN_AIR,
)


@dataclass(frozen=True)
class Finding:
    """One finding.

    frames: (first, last) scene frames of each place, in order; none where it is the whole clip.
    part: the bone that shows it most, or the contact point; "" where it is the whole body. amount:
    in `unit`, at its worst. alternative: another remedy, where the recording cannot tell which.
    end: the bone that leaves its place on the part, where its length changes.
    """

    kind: FindingKind
    amount: float
    unit: str
    frames: tuple[tuple[float, float], ...] = ()
    part: str = ""
    remedy: Repairs | None = None
    alternative: Repairs | None = None
    end: str = ""

    def touches(self, first: float, last: float) -> bool:
        """Whether a place of it is among scene frames."""
        return any(a <= last and first <= b for a, b in self.frames)
