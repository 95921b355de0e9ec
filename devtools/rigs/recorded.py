"""The actor's jump on a rig as a recording, without Blender."""

from __future__ import annotations

import numpy as np

from ...solver.data.recording import Recording
from ..figures.clips import RATE
from .actor import JOINTS, Actor
from .layout import GROUND, Layout
from .rest import rest_bones, rest_heads, rest_pose


def recorded(layout: Layout, actor: Actor) -> Recording:
    """The jump at the actor's frames; world, m. Bones on the ground stay there."""
    bones, at_rest = rest_bones(layout, actor), rest_heads(layout, actor)
    centres, turned = rest_pose(layout, actor)
    count = len(actor.frames)
    heads = np.tile(at_rest, (count, 1, 1))
    rotations = np.tile(np.stack([bone.rotation for bone in bones]), (count, 1, 1, 1))
    for i, bone in enumerate(layout.bones):
        if bone.joint != GROUND:
            j = JOINTS.index(bone.joint)
            turns = actor.turns[:, j] @ turned[j].T
            heads[:, i] = actor.heads[:, j] + turns @ (at_rest[i] - centres[j])
            rotations[:, i] = turns @ bones[i].rotation
    times = (actor.frames - actor.frames[0]) / RATE
    return Recording(layout.name, bones, actor.frames, times, heads, rotations)
