"""Changed lengths, masses and gravity of a character (requests.BodyChange; thesis 6.2).

Joints, their axes and their angles stay those of the recording's figure, so that every spline of
angles stays valid; lengths, masses and gravity change. A bone is stretched along itself: a point
of it moves by its share of the way from head to tail, what hangs on it moves with the place where
it hangs.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Bone, Recording
from ..data.requests import AddedMass, BodyChange
from .anatomy import Segment
from .body_shapes import stretched, with_ball
from .character import Body, Character, standing_height
from .kinematics import BodyPoint
from .proportions import axial_fraction, bone_index, limb_factors, require_positive

COINCIDENCE_TOLERANCE = 1e-9  # m
WHOLE_BODY = "body"  # what a fault calls the change of the total mass


# ---------------------------------------------------------------- the rigid bodies


def changed_character(
    character: Character, change: BodyChange, recording: Recording, changed: Recording
) -> Character:
    """The character with the change's lengths, masses and gravity, and the same joint axes.

    recording: what the character was built from. changed: `changed_recording` of it.
    A stretched body keeps its thickness and its mass. A limb's mass factor changes the whole
    body's mass too, unless `change.mass` sets it; bones that carry no body have no mass to change.
    What is carried is a ball as dense as the body, joined rigidly: to the body of its bone, else
    to the nearest ancestor's, else to the root. Raises UnknownBone, NotAboveZero.
    """
    offsets = _changed_offsets(character, recording, changed)
    bodies = [
        stretched(body, tip)
        for body, tip in zip(
            character.bodies, _changed_tips(character, offsets, recording, changed), strict=True
        )
    ]
    bodies = _with_masses(bodies, change, recording)
    total = sum(body.mass for body in bodies)
    for added in change.added:
        bodies = _with_added_mass(bodies, added, total, changed)
    joints = [
        replace(joint, offset=offset)
        for joint, offset in zip(character.joints, offsets, strict=True)
    ]
    height = character.height + _height_change(character, offsets, recording)
    return Character(tuple(bodies), tuple(joints), height, change.gravity)


def _changed_offsets(
    character: Character, recording: Recording, changed: Recording
) -> list[FloatArray]:
    """Each joint's centre in its parent's frame: the old one moved by the median over the clip."""
    bones = [recording.index(body.bone) for body in character.bodies]
    moved = changed.heads[:, bones] - recording.heads[:, bones]
    offsets = []
    for i, joint in enumerate(character.joints):
        if joint.parent < 0:
            offsets.append(joint.offset)
            continue
        home = bones[joint.parent]
        turn = recording.rotations[:, home] @ recording.bones[home].rotation.T
        apart = np.einsum("tji,tj->ti", turn, moved[:, i] - moved[:, joint.parent])
        offsets.append(joint.offset + np.median(apart, axis=0))
    return offsets


def _changed_tips(
    character: Character,
    offsets: Sequence[FloatArray],
    recording: Recording,
    changed: Recording,
) -> list[FloatArray]:
    """Each body's far end in its frame: still a joint beyond it, or else stretched as its bone."""
    before = _rest_centres(character, [joint.offset for joint in character.joints])
    after = _rest_centres(character, offsets)
    tips = []
    for i, body in enumerate(character.bodies):
        beyond = [k for k in range(len(before)) if k != i and i in character.ancestors(k)]
        end = before[i] + body.tip
        at = next(
            (k for k in beyond if np.linalg.norm(before[k] - end) < COINCIDENCE_TOLERANCE), None
        )
        if at is not None:
            tips.append(body.tip + (after[at] - before[at]) - (after[i] - before[i]))
            continue
        bone, new = (each.bones[each.index(body.bone)] for each in (recording, changed))
        longer = (new.tail - new.head) - (bone.tail - bone.head)
        tips.append(body.tip + axial_fraction(bone, bone.head + body.tip) * longer)
    return tips


def _rest_centres(character: Character, offsets: Sequence[FloatArray]) -> list[FloatArray]:
    """Joint centres at rest from the root's, m: there all bodies' frames are the world's."""
    centres: list[FloatArray] = []
    for joint, offset in zip(character.joints, offsets, strict=True):
        centres.append(offset + centres[joint.parent] if joint.parent >= 0 else np.zeros(3))
    return centres


def _with_masses(bodies: Sequence[Body], change: BodyChange, recording: Recording) -> list[Body]:
    """The bodies with their masses changed; other density, same shape."""
    by_bone = limb_factors(recording, change.limbs, lambda limb: limb.mass)
    factors = np.array([by_bone[recording.index(body.bone)] for body in bodies])
    if change.mass is not None:
        together = factors @ np.array([body.mass for body in bodies])
        factors *= require_positive(WHOLE_BODY, change.mass) / together
    return [
        replace(body, mass=float(factor) * body.mass, inertia=factor * body.inertia)
        for body, factor in zip(bodies, factors, strict=True)
    ]


def _with_added_mass(
    bodies: Sequence[Body], added: AddedMass, total: float, changed: Recording
) -> list[Body]:
    """The bodies with a ball joined to one of them; total: the body's mass that shares are of."""
    bone = changed.bones[bone_index(changed, added.name, added.bone)]
    home = _carrying_body(bodies, bone, changed)
    mass = (added.mass or 0.0) + (added.share or 0.0) * total
    reach = bone.tail - bone.head
    if added.offset is not None:
        reach = bone.rotation @ np.array(added.offset)
    start = changed.bones[changed.index(bodies[home].bone)].head
    loaded = list(bodies)
    ball = require_positive(added.name, mass)
    loaded[home] = with_ball(bodies[home], ball, bone.head + reach - start)
    return loaded


def _carrying_body(bodies: Sequence[Body], bone: Bone, recording: Recording) -> int:
    """Index of the body of a bone, else of its nearest ancestor's, else of the root."""
    by_bone = {body.bone: i for i, body in enumerate(bodies)}
    while bone.name not in by_bone and bone.parent >= 0:
        bone = recording.bones[bone.parent]
    return by_bone.get(bone.name, 0)


def _height_change(
    character: Character, offsets: Sequence[FloatArray], recording: Recording
) -> float:
    """Change of the standing height, m."""
    segments = [Segment(b.part, b.side, recording.index(b.bone)) for b in character.bodies]
    before = [joint.offset for joint in character.joints]
    return standing_height(segments, offsets) - standing_height(segments, before)


# ---------------------------------------------------------------- the motion


def changed_points(
    points: Sequence[BodyPoint], before: Character, after: Character
) -> tuple[BodyPoint, ...]:
    """Body points moved with the stretch of their bodies (a longer foot's toe)."""
    moved = []
    for point in points:
        old, new = before.bodies[point.body], after.bodies[point.body]
        limb = Bone(old.bone, -1, np.zeros(3), old.tip, np.eye(3))
        moved.append(
            replace(
                point, place=point.place + axial_fraction(limb, point.place) * (new.tip - old.tip)
            )
        )
    return tuple(moved)
