"""Which bone moves which part of the body, from everything that tells, and how sure that is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

from ..data.faults import BoneTaken, MissingPart, NoSpine, NotJoined
from ..data.recording import Bone
from .conventions import matched
from .names import PART_NAMES, by_words
from .parts import ARM, KEYS, LABELS, LEG, REQUIRED_KEYS, SIDES, Found, Key, Part, Side, label_of
from .shape import by_shape
from .tree import Tree, tree_of


class Evidence(Enum):
    """What tells that a bone moves a part, the surest first."""

    CHOSEN = "chosen"
    NAME_AND_SHAPE = "name and shape"
    NAME = "name"
    SHAPE = "shape"
    DISPUTED = "name against shape"


UNSURE = (Evidence.SHAPE, Evidence.DISPUTED)


@dataclass(frozen=True)
class Guess:
    """The bone of every part that one was found for, and what tells so.

    convention: by which the bones are named; "" for none that is known.
    """

    bones: Found
    evidence: Mapping[Key, Evidence]
    convention: str = ""


def guess_bones(tree: Tree) -> Guess:
    """Names first, then the skeleton's shape, which checks them and finds what they do not tell.

    A convention's names count, and what neither they nor words name is not there. Single words that
    contradict the skeleton (a forearm that is not below its upper arm) give way to its shape, limb
    by limb.
    """
    named, shape, words = matched(tree), by_shape(tree), by_words(tree)
    if named is None:
        found = _completed(tree, words, shape)
    else:
        found = words = _with_words(tree, named.bones, words)
    found = {key: bone for key, bone in found.items() if key[0] is not Part.PELVIS}
    if all(key in found for key in REQUIRED_KEYS):
        pelvis = _pelvis(tree, found)
        if pelvis is not None:
            found[Part.PELVIS, Side.MIDDLE] = pelvis
    known = {key: _evidence(tree, key, bone, words, shape) for key, bone in found.items()}
    return Guess(found, known, named.name if named is not None else "")


def guess_labels(bones: Sequence[Bone]) -> dict[str, tuple[str, Evidence] | None]:
    """`labels_of` what is guessed of bones."""
    return labels_of(guess_bones(tree_of(bones)), bones)


def labels_of(guess: Guess, bones: Sequence[Bone]) -> dict[str, tuple[str, Evidence] | None]:
    """Bone name and evidence, or None, for the label of every part but spine and neck.

    Raises nothing, so that an artist can fill in what is missing.
    """
    return {
        label_of(key): (bones[guess.bones[key]].name, guess.evidence[key])
        if key in guess.bones
        else None
        for key in KEYS
    }


def settled(tree: Tree, chosen: Mapping[str, str]) -> Found:
    """The bone of every part but spine and neck; the artist's choices, label -> bone, win.

    Raises MissingPart for a part that the physics needs or a choice that there is not, BoneTaken
    where its bone was chosen for another, NotJoined where legs and head hang on no common bone.
    """
    guessed = found = guess_bones(tree).bones
    index = {bone.name: i for i, bone in enumerate(tree.bones)}
    for label, name in chosen.items():
        if name not in index:
            raise MissingPart(label, (name,))
        if label not in LABELS:
            raise MissingPart(label)
        found = {key: bone for key, bone in found.items() if bone != index[name]}
        found[LABELS[label]] = index[name]
    for key in REQUIRED_KEYS:
        if key not in found:
            raise _missing(tree, key, guessed, chosen)
    if "pelvis" not in chosen:
        pelvis = _pelvis(tree, found)
        if pelvis is None:
            raise NotJoined(tuple(tree.bones[found[key]].name for key in _JOINED))
        found[Part.PELVIS, Side.MIDDLE] = pelvis
    return found


def _missing(tree: Tree, key: Key, guessed: Found, chosen: Mapping[str, str]) -> MissingPart:
    """Why a part has no bone: its own was chosen for another, or there is none."""
    part = label_of(key)
    bone = chosen.get(part, tree.bones[guessed[key]].name if key in guessed else None)
    by = next((other for other, name in chosen.items() if name == bone and other != part), None)
    if bone is None or by is None:
        return MissingPart(part, PART_NAMES[key[0]])
    return BoneTaken(part, bone=bone, by=by)


def trunk(tree: Tree, found: Found) -> tuple[list[int], list[int]]:
    """Spine and neck, from below: what lies between pelvis and head, parted where the arms branch.

    Of a generated rig's neck the first bone stands for all: one control turns them.
    Raises NoSpine.
    """
    pelvis, head = found[Part.PELVIS, Side.MIDDLE], found[Part.HEAD, Side.MIDDLE]
    line = tree.ancestors(head)[1:]
    arms: set[int] = set()
    for side in SIDES:
        shoulder = found.get((Part.CLAVICLE, side), found[Part.UPPER_ARM, side])
        arms.update(tree.ancestors(shoulder)[1:])
    middle = line[: line.index(pelvis)][::-1] if pelvis in line else []
    spine = [bone for bone in middle if bone in arms]
    if not spine or set(middle) & set(found.values()):  # else a limb's bones would be two bodies
        raise NoSpine(tree.bones[pelvis].name, tree.bones[head].name)
    neck = [bone for bone in middle if bone not in arms]
    return spine, neck[:1] if tree.generated else neck


_JOINED = ((Part.THIGH, Side.LEFT), (Part.THIGH, Side.RIGHT), (Part.HEAD, Side.MIDDLE))


def _pelvis(tree: Tree, found: Found) -> int | None:
    """The last bone that both thighs and the head descend from."""
    first, *others = (tree.ancestors(found[key])[1:] for key in _JOINED)
    return next((bone for bone in first if all(bone in line for line in others)), None)


def _is_line(tree: Tree, found: Found, limb: Sequence[Part], side: Side) -> bool:
    """Whether what was found of a limb hangs together, each bone below the one before."""
    bones = [found[part, side] for part in limb if (part, side) in found]
    return all(upper in tree.ancestors(lower)[1:] for upper, lower in pairwise(bones))


def _with_words(tree: Tree, named: Found, words: Found) -> Found:
    """What a convention names, and of the rest what single words do: in their mixtures a rig has
    Unreal's thighs and toes by another name."""
    found = dict(named)
    for key, bone in words.items():
        if key in found or bone in found.values():
            continue
        more = {**found, key: bone}
        if all(_is_line(tree, more, limb, key[1]) for limb in (ARM, LEG) if key[0] in limb):
            found = more
    return found


def _completed(tree: Tree, words: Found, shape: Found) -> Found:
    """What words tell, and of the rest what the shape does, as far as limbs hang together."""
    found = dict(words)
    for side in SIDES:
        for limb in (ARM, LEG):
            shoulder, clavicle = found.get((Part.UPPER_ARM, side)), shape.get((Part.CLAVICLE, side))
            if limb is ARM and shoulder is not None and shoulder == clavicle:
                del found[Part.UPPER_ARM, side]  # what is called a shoulder is the clavicle
            if shape and not _is_line(tree, found, limb, side):
                found = {k: b for k, b in found.items() if k[1] is not side or k[0] not in limb}
            for part in limb:
                bone = shape.get((part, side))
                if bone is None or (part, side) in found or bone in found.values():
                    continue
                if _is_line(tree, {**found, (part, side): bone}, limb, side):
                    found[part, side] = bone
    return {**{key: bone for key, bone in shape.items() if key[0] is Part.HEAD}, **found}


def _evidence(tree: Tree, key: Key, bone: int, words: Found, shape: Found) -> Evidence:
    """Shape tells joints to a bone: what is right above or below is no dispute."""
    if words.get(key) != bone:
        return Evidence.SHAPE
    if key[0] is Part.PELVIS:  # which legs and head tell
        return Evidence.NAME_AND_SHAPE
    seen = shape.get(key)
    if seen is None:
        return Evidence.NAME
    if seen == bone:
        return Evidence.NAME_AND_SHAPE
    related = seen in tree.ancestors(bone) or bone in tree.ancestors(seen)
    return Evidence.NAME if related else Evidence.DISPUTED
