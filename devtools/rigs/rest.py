"""A rig at rest: where its bones are, in its own rest pose, and how they are turned."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import Bone
from ...solver.numerics.rotations import axis_rotation, unit
from .actor import JOINTS, Actor
from .layout import GROUND, Axes, Layout, Placed

ROLL = 2.4  # rad from a bone to the next one, so that rolls are all about
SHORT = 0.05  # m; the least length of a bone


def rest_bones(layout: Layout, actor: Actor) -> tuple[Bone, ...]:
    """The rig's bones, parents first; world, m."""
    heads, index = rest_heads(layout, actor), {b.name: i for i, b in enumerate(layout.bones)}
    bones = []
    for i, bone in enumerate(layout.bones):
        rotation, length = axes(layout, i, heads, actor)
        parent = index[bone.parent] if bone.parent is not None else -1
        bones.append(
            Bone(bone.name, parent, heads[i], heads[i] + length * rotation[:, 1], rotation)
        )
    return tuple(bones)


def rest_heads(layout: Layout, actor: Actor) -> FloatArray:
    """(B, 3) m, in the rig's own rest pose."""
    rest, turns = rest_pose(layout, actor)
    return heads_on(layout.bones, actor, rest, turns)


def heads_on(
    bones: Sequence[Placed], actor: Actor, rest: FloatArray, turns: FloatArray
) -> FloatArray:
    """(B, 3) m, of bones on joints at (J, 3) that are turned by (J, 3, 3) from the actor's rest."""
    ahead = unit(actor.end("foot.l") - actor.at("foot.l")) * [1.0, 1.0, 0.0]
    heads = np.zeros((len(bones), 3))
    for i, bone in enumerate(bones):
        if bone.joint != GROUND:
            j = JOINTS.index(bone.joint)
            off = bone.share * (actor.end(bone.joint) - actor.rest[j]) + bone.ahead * ahead
            heads[i] = rest[j] + turns[j] @ off
    return heads


def rest_pose(layout: Layout, actor: Actor) -> tuple[FloatArray, FloatArray]:
    """Joint centres (J, 3) and turns from the actor's rest (J, 3, 3) in the rig's rest pose."""
    turns = actor.lowered() if layout.lowered else np.tile(np.eye(3), (len(JOINTS), 1, 1))
    return centres_of(actor, turns), turns


def centres_of(actor: Actor, turns: FloatArray) -> FloatArray:
    """(J, 3) joint centres, the bodies turned by (J, 3, 3) from the actor's rest."""
    rest = actor.rest.copy()
    for j, parent in enumerate(actor.parents):
        if parent >= 0:
            rest[j] = rest[parent] + turns[parent] @ (actor.rest[j] - actor.rest[parent])
    return rest


def axes(layout: Layout, i: int, heads: FloatArray, actor: Actor) -> tuple[FloatArray, float]:
    """A bone's rest rotation (3, 3), bone to world, and its length, m."""
    bone = layout.bones[i]
    if layout.axes is Axes.UP or bone.joint == GROUND:
        return axis_rotation(0, np.array([np.pi / 2.0]))[0], SHORT
    _, turns = rest_pose(layout, actor)
    span = turns[JOINTS.index(bone.joint)] @ (actor.end(bone.joint) - actor.at(bone.joint))
    following = _next_part(layout, bone)
    if following is not None:
        span = heads[following] - heads[i]
    length = max(float(np.linalg.norm(span)), SHORT)
    along = unit(span) if np.linalg.norm(span) > 0.0 else np.array([0.0, 0.0, 1.0])
    other = np.array([0.0, 1.0, 0.0]) if abs(along[1]) < 0.8 else np.array([1.0, 0.0, 0.0])
    across = unit(np.cross(along, other))
    frame = np.stack([across, along, np.cross(across, along)], axis=1)
    frame = frame @ axis_rotation(1, np.array([ROLL * i]))[0]
    if layout.axes is Axes.ASIDE:
        frame = frame[:, [1, 0, 2]] * [1.0, -1.0, 1.0]
    return frame, length


def _next_part(layout: Layout, bone: Placed) -> int | None:
    """The bone of the next part, where it alone is below a bone."""
    parts = [i for i, b in enumerate(layout.bones) if b.parent == bone.name and b.part]
    return parts[0] if len(parts) == 1 else None
