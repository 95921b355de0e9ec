"""Which body moves which point of the skin."""

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..body.joint_choice import MIN_BONE_LENGTH
from ..data.recording import Bone, Recording, Skin
from ..skeleton.tree import tree_of

INSIDE = 0.1  # of its length, from a body's axis, within which a bone lies in it


def skin_of_bodies(skin: Skin, recording: Recording, character: Character) -> list[FloatArray]:
    """(N, 3) m for each body: the points that it moves, in its frame.

    recording: what the character was built from; its rest pose is the skin's.
    """
    carriers = _carriers(recording, character)
    bodies = np.array([*(carriers.get(bone, -1) for bone in skin.bones), -1])
    owners = bodies[skin.owners]  # the last is nobody's
    heads = [recording.bones[recording.index(body.bone)].head for body in character.bodies]
    return [skin.points[owners == i] - head for i, head in enumerate(heads)]


def _carriers(recording: Recording, character: Character) -> dict[str, int]:
    """The body that each bone goes with, by names: its own, or the nearest one above.

    So twist bones, fingers, hair and skirts go with the body that they hang on. What hangs on none,
    as limbs that deform hang on the root's control in Auto-Rig Pro's rig, goes with the body in
    which it lies.
    """
    tree, joined = tree_of(recording.bones), dict(character.joined)
    index = {body.bone: i for i, body in enumerate(character.bodies)}
    names = [bone.name for bone in recording.bones]
    own = [index.get(joined.get(name, name)) for name in names]
    found = {}
    for bone, name in enumerate(names):
        line = (own[each] for each in tree.ancestors(bone))
        carrier = next((body for body in line if body is not None), None)
        if carrier is None:
            carrier = _within(recording.bones[bone], recording, character)
        if carrier is not None:
            found[name] = carrier
    return found


def _within(bone: Bone, recording: Recording, character: Character) -> int | None:
    """The body along whose axis a bone's middle lies, at rest; None where it lies in none."""
    middle = 0.5 * (bone.head + bone.tail)
    nearest, best = None, INSIDE
    for i, body in enumerate(character.bodies):
        length = float(np.linalg.norm(body.tip))
        if length < MIN_BONE_LENGTH:
            continue
        from_joint = middle - recording.bones[recording.index(body.bone)].head
        along = float(np.clip(from_joint @ body.tip / length**2, 0.0, 1.0))
        aside = float(np.linalg.norm(from_joint - along * body.tip)) / length
        if aside < best:
            nearest, best = i, aside
    return nearest
