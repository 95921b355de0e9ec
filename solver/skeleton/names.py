"""What single words in bones' names say: the side, and in English the part.

Names come in two styles: of segments (LeftArm, lfemur, thigh.L) and of joints (LeftShoulder,
LeftHip, LeftKnee). The style of a side is decided by what else is there: a *shoulder* beside a
*collar* is the upper arm, a *shoulder* beside an *arm* is the clavicle.
"""

import re
from collections.abc import Mapping
from functools import lru_cache

from .parts import SIDED_PARTS, SIDES, Found, Key, Part, Side
from .tree import Tree

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
KNOWN_WORDS = {name for names in PART_NAMES.values() for name in names}
# Beginnings of words in other languages: German, French, Spanish, Portuguese, Italian, Japanese,
# Chinese, Korean, Russian.
SIDE_WORDS: Mapping[Side, tuple[str, ...]] = {
    Side.LEFT: ("left", "link", "gauche", "izq", "esq", "sinistr", "左", "왼", "лев"),
    Side.RIGHT: ("right", "recht", "droit", "derech", "direit", "destr", "右", "오른", "прав"),
}
HEAD_WORDS = (
    *("head", "kopf", "tete", "tête", "cabeza", "cabeça", "testa"),
    *("atama", "頭", "頭部", "头", "头部", "머리", "голова"),
)


@lru_cache(maxsize=10_000)
def split_side(name: str) -> tuple[Side, str]:
    """Side and bare lower-case word of a bone's name: 'mixamorig:LeftUpLeg' -> (LEFT, 'upleg')."""
    bare = re.split(r"[:|]", name)[-1]
    bare = re.sub(r"^(bip\d*|def|org|rig|b)[ _.\-]+", "", bare, flags=re.IGNORECASE)
    for side in SIDES:
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
                return side, plain(match["word"])
        if bare[:1].lower() == letter and plain(bare[1:]) in KNOWN_WORDS:
            return side, plain(bare[1:])
    return Side.MIDDLE, plain(bare)


def plain(word: str) -> str:
    """Lower case without separators."""
    return re.sub(r"[ _.\-]", "", word).lower()


def names_head(name: str) -> bool:
    """Whether a name calls a bone the head in any of the languages: by one word alone, for there
    are hats and hair of the head, too."""
    words = _words(name)
    return len(words) == 1 and words[0] in HEAD_WORDS


def names_part(name: str, key: Key) -> bool:
    """Whether an English word calls a bone a part of the body, by itself: a shoulder may be two."""
    part, side = key
    named, word = split_side(name)
    return named is side and word in PART_NAMES.get(part, ())


def _words(name: str) -> list[str]:
    """The words of a name, lower case: 'Hals_Kopf2' -> ['hals', 'kopf']."""
    return [word.lower() for word in re.findall(r"[A-Z]?[^\W\d_A-Z]+|[A-Z]+", name)]


def side_of(name: str) -> Side:
    """The side that a name tells in any of the languages; MIDDLE where it tells none."""
    side, _ = split_side(name)
    if side is not Side.MIDDLE:
        return side
    words = _words(name)
    told = {s for s in SIDES if any(word.startswith(SIDE_WORDS[s]) for word in words)}
    return told.pop() if len(told) == 1 else Side.MIDDLE


def by_words(tree: Tree) -> Found:
    """The bone of every part that an English word tells."""
    words: dict[tuple[str, Side], int] = {}
    for i in tree.inside:
        side, word = split_side(tree.name(i))
        words.setdefault((word, side), i)  # the shallowest wins: parents come first
    found: Found = {}
    for side in SIDES:
        for part in SIDED_PARTS:
            taken = {bone for (_, s), bone in found.items() if s is side}
            named = (words.get((word, side)) for word in PART_NAMES[part])
            bone = next((b for b in named if b is not None and b not in taken), None)
            if bone is not None:
                found[part, side] = bone
        _settle_shoulder(found, words, side)
        _settle_ankle(tree, found, words, side)
    if ("head", Side.MIDDLE) in words:
        found[Part.HEAD, Side.MIDDLE] = words["head", Side.MIDDLE]
    return found


def _settle_shoulder(found: Found, words: Mapping[tuple[str, Side], int], side: Side) -> None:
    """A 'shoulder' taken as clavicle is the upper arm where no other upper arm was found."""
    if (Part.UPPER_ARM, side) not in found and ("shoulder", side) in words:
        found[Part.UPPER_ARM, side] = words["shoulder", side]
        if found.get((Part.CLAVICLE, side)) == words["shoulder", side]:
            del found[Part.CLAVICLE, side]


def _settle_ankle(
    tree: Tree, found: Found, words: Mapping[tuple[str, Side], int], side: Side
) -> None:
    """A 'foot' below an 'ankle' is named as a joint, too: it is what bends at the ball."""
    foot, ankle = found.get((Part.FOOT, side)), words.get(("ankle", side))
    if foot is None or ankle is None or (Part.TOE, side) in found:
        return
    if ankle in tree.ancestors(foot)[1:]:
        found[Part.FOOT, side], found[Part.TOE, side] = ankle, foot
