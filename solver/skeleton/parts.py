"""Parts of the body, and which bone moves each."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum


class Part(Enum):
    """Kind of body segment. Sided parts occur twice, spine and neck once or several times."""

    PELVIS = "pelvis"
    SPINE = "spine"
    NECK = "neck"
    HEAD = "head"
    CLAVICLE = "clavicle"
    UPPER_ARM = "upper arm"
    FOREARM = "forearm"
    HAND = "hand"
    THIGH = "thigh"
    SHANK = "shank"
    FOOT = "foot"
    TOE = "toe"


class Side(Enum):
    """Side of the body."""

    MIDDLE = ""
    LEFT = "left"
    RIGHT = "right"


Key = tuple[Part, Side]
Found = dict[Key, int]  # the bone of a part, an index into the bones

SIDES = (Side.LEFT, Side.RIGHT)
ARM = (Part.CLAVICLE, Part.UPPER_ARM, Part.FOREARM, Part.HAND)
LEG = (Part.THIGH, Part.SHANK, Part.FOOT, Part.TOE)
SIDED_PARTS = (*ARM, *LEG)
REQUIRED_PARTS = (Part.UPPER_ARM, Part.FOREARM, Part.THIGH, Part.SHANK, Part.FOOT)
KEYS: tuple[Key, ...] = (
    (Part.PELVIS, Side.MIDDLE),
    (Part.HEAD, Side.MIDDLE),
    *((part, side) for part in SIDED_PARTS for side in SIDES),
)  # of all parts but spine and neck, of which there may be several
REQUIRED_KEYS = (
    (Part.HEAD, Side.MIDDLE),
    *((part, side) for part in REQUIRED_PARTS for side in SIDES),
)


def label_of(key: Key) -> str:
    """Such as "left foot"; no side in the middle."""
    part, side = key
    return f"{side.value} {part.value}".strip()


LABELS: Mapping[str, Key] = {label_of(key): key for key in KEYS}


@dataclass(frozen=True)
class Segment:
    """Body segment: its part, side and bone (an index into the bones)."""

    part: Part
    side: Side
    bone: int

    @property
    def label(self) -> str:
        """Such as "left foot"; no side in the middle."""
        return label_of((self.part, self.side))
