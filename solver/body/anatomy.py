"""Anatomical labelling of bones, from names and hierarchy.

Names come in two styles: of segments (LeftArm, lfemur, thigh.L) and of joints (LeftShoulder,
LeftHip, LeftKnee). The style of a side is decided by what else is there: a *shoulder* beside a
*collar* is the upper arm, a *shoulder* beside an *arm* is the clavicle.
"""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

from ..data.faults import MissingPart
from ..data.recording import Bone


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


@dataclass(frozen=True)
class Segment:
    """Body segment: its part, side and bone (an index into the bones)."""

    part: Part
    side: Side
    bone: int

    @property
    def label(self) -> str:
        """Such as "left foot"; no side in the middle."""
        return f"{self.side.value} {self.part.value}".strip()


# In order of preference: an exact "hand" is the hand even where a "wrist" stands before it.
PART_NAMES: Mapping[Part, tuple[str, ...]] = {
    Part.HEAD: ("head",),
    Part.CLAVICLE: ("clavicle", "collar", "collarbone", "shoulder"),
    Part.UPPER_ARM: ("upperarm", "uparm", "humerus", "arm", "shoulder"),
    Part.FOREARM: ("forearm", "lowerarm", "lowarm", "radius", "ulna", "elbow"),
    Part.HAND: ("hand", "wrist"),
    Part.THIGH: ("thigh", "upleg", "upperleg", "femur", "hip"),
    Part.SHANK: ("shank", "shin", "calf", "tibia", "lowerleg", "lowleg", "leg", "knee"),
    Part.FOOT: ("foot", "ankle"),
    Part.TOE: ("toe", "toes", "toebase", "ball", "toe0", "toe1"),
}
SIDED_PARTS = tuple(part for part in PART_NAMES if part is not Part.HEAD)
REQUIRED_PARTS = (Part.UPPER_ARM, Part.FOREARM, Part.THIGH, Part.SHANK, Part.FOOT)
KNOWN_WORDS = {name for names in PART_NAMES.values() for name in names}


def split_side(name: str) -> tuple[Side, str]:
    """Side and bare lower-case word of a bone's name: 'mixamorig:LeftUpLeg' -> (LEFT, 'upleg')."""
    bare = re.split(r"[:|]", name)[-1]
    bare = re.sub(r"^(bip\d*|def|org|rig|b)[ _.\-]+", "", bare, flags=re.IGNORECASE)
    for side in (Side.LEFT, Side.RIGHT):
        letter = side.value[0]
        patterns = (
            rf"^{side.value}[ _.\-]?(?P<word>.+)$",
            rf"^(?P<word>.+?)[ _.\-]?{side.value}$",
            rf"^{letter}[ _.\-](?P<word>.+)$",
            rf"^(?P<word>.+)[ _.\-]{letter}$",
        )
        for pattern in patterns:
            match = re.match(pattern, bare, flags=re.IGNORECASE)
            if match:
                return side, _plain(match["word"])
        if bare[:1].lower() == letter and _plain(bare[1:]) in KNOWN_WORDS:
            return side, _plain(bare[1:])
    return Side.MIDDLE, _plain(bare)


def _plain(word: str) -> str:
    return re.sub(r"[ _.\-]", "", word).lower()


def map_anatomy(
    bones: Sequence[Bone], chosen: Mapping[str, str] | None = None
) -> tuple[Segment, ...]:
    """Segments of a skeleton, parents first; the pelvis is the first.

    bones: parents first. chosen: the artist's own choices, segment label -> bone name
    ("left foot" -> "Fuss.L"); they win over the guess. Clavicles, hands, toes and necks may be
    absent. Raises MissingPart for a part that the physics needs, or a chosen bone that is absent.
    """
    index = {bone.name: i for i, bone in enumerate(bones)}
    found = _by_name(bones)
    for label, bone_name in (chosen or {}).items():
        if bone_name not in index:
            raise MissingPart(label, (bone_name,))
        mine = index[bone_name]
        found = {key: bone for key, bone in found.items() if bone != mine}
        found[_key(label)] = mine
    for part in REQUIRED_PARTS:
        for side in (Side.LEFT, Side.RIGHT):
            if (part, side) not in found:
                raise MissingPart(f"{side.value} {part.value}", PART_NAMES[part])
    if (Part.HEAD, Side.MIDDLE) not in found:
        raise MissingPart("head", PART_NAMES[Part.HEAD])
    _add_trunk(bones, found)
    segments = [Segment(part, side, bone) for (part, side), bone in found.items()]
    segments += _chain(bones, found)
    return tuple(sorted(segments, key=lambda s: s.bone))


def guess_anatomy(bones: Sequence[Bone]) -> dict[str, str | None]:
    """Bone name, or None, for the label of every part but spine and neck; sided parts in pairs.

    Raises nothing, so that an artist can fill in what is missing.
    """
    found = _by_name(bones)
    keys = [(Part.PELVIS, Side.MIDDLE), (Part.HEAD, Side.MIDDLE)]
    keys += [(part, side) for part in SIDED_PARTS for side in (Side.LEFT, Side.RIGHT)]
    if all(key in found for key in keys if is_required(key[0])):
        with suppress(MissingPart):
            _add_trunk(bones, found)
    return {
        f"{side.value} {part.value}".strip(): bones[found[part, side]].name
        if (part, side) in found
        else None
        for part, side in keys
    }


def is_required(part: Part) -> bool:
    """Whether the dynamics need the part; the pelvis follows from the others."""
    return part in REQUIRED_PARTS or part is Part.HEAD


def _key(label: str) -> tuple[Part, Side]:
    """Part and side of a label. Raises MissingPart."""
    side, word = split_side(label)
    for part in Part:
        if _plain(part.value) == word:
            return part, side
    raise MissingPart(label)


def _by_name(bones: Sequence[Bone]) -> dict[tuple[Part, Side], int]:
    """Bone index of every part that a name tells."""
    words: dict[tuple[str, Side], int] = {}
    for i, bone in enumerate(bones):
        side, word = split_side(bone.name)
        words.setdefault((word, side), i)  # the shallowest wins: parents come first
    found: dict[tuple[Part, Side], int] = {}
    for side in (Side.LEFT, Side.RIGHT):
        for part in SIDED_PARTS:
            for word in PART_NAMES[part]:
                bone_index = words.get((word, side))
                if bone_index is not None and bone_index not in _of_side(found, side):
                    found[part, side] = bone_index
                    break
        _settle_shoulder(found, words, side)
    if ("head", Side.MIDDLE) in words:
        found[Part.HEAD, Side.MIDDLE] = words["head", Side.MIDDLE]
    return found


def _of_side(found: Mapping[tuple[Part, Side], int], side: Side) -> set[int]:
    return {bone for (_, s), bone in found.items() if s is side}


def _settle_shoulder(
    found: dict[tuple[Part, Side], int], words: Mapping[tuple[str, Side], int], side: Side
) -> None:
    """A 'shoulder' taken as clavicle is the upper arm where no other upper arm was found."""
    if (Part.UPPER_ARM, side) not in found and ("shoulder", side) in words:
        found[Part.UPPER_ARM, side] = words["shoulder", side]
        if found.get((Part.CLAVICLE, side)) == words["shoulder", side]:
            del found[Part.CLAVICLE, side]


def _ancestors(bones: Sequence[Bone], bone: int) -> list[int]:
    """The bone and its ancestors, nearest first."""
    line = []
    while bone >= 0:
        line.append(bone)
        bone = bones[bone].parent
    return line


def _add_trunk(bones: Sequence[Bone], found: dict[tuple[Part, Side], int]) -> None:
    """The pelvis is the last bone that both thighs descend from."""
    if (Part.PELVIS, Side.MIDDLE) in found:
        return
    left = _ancestors(bones, found[Part.THIGH, Side.LEFT])[1:]
    right = set(_ancestors(bones, found[Part.THIGH, Side.RIGHT])[1:])
    for bone in left:
        if bone in right:
            found[Part.PELVIS, Side.MIDDLE] = bone
            return
    raise MissingPart("pelvis", ("a bone that both thighs descend from",))


def _chain(bones: Sequence[Bone], found: Mapping[tuple[Part, Side], int]) -> list[Segment]:
    """Spine and neck: what lies between pelvis and head, parted where the arms branch off."""
    pelvis = found[Part.PELVIS, Side.MIDDLE]
    head = found[Part.HEAD, Side.MIDDLE]
    line = _ancestors(bones, head)[1:]
    if pelvis not in line:
        raise MissingPart("spine", ("bones between the pelvis and the head",))
    middle = line[: line.index(pelvis)][::-1]
    arms: set[int] = set()
    for side in (Side.LEFT, Side.RIGHT):
        shoulder = found.get((Part.CLAVICLE, side), found[Part.UPPER_ARM, side])
        arms.update(_ancestors(bones, shoulder)[1:])
    spine = [bone for bone in middle if bone in arms]
    if not spine:
        raise MissingPart("spine", ("a bone between the pelvis and the arms",))
    neck = [bone for bone in middle if bone not in arms]
    return [Segment(Part.SPINE, Side.MIDDLE, bone) for bone in spine] + [
        Segment(Part.NECK, Side.MIDDLE, bone) for bone in neck
    ]
