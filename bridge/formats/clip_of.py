"""A recording as a motion clip, so that an armature can be built from it."""

from __future__ import annotations

import numpy as np

from ...solver.data.recording import Recording
from .skeleton import Joint, MotionClip


def clip_of(recording: Recording) -> MotionClip:
    """The recording in metres, Z up: for `build_armature(clip, 1.0, "Z")`.

    Rest frames along the world, as a clip has them, so bones lose their roll: read the armature
    that is built before poses are written to it. Its first frame is scene frame 1.
    """
    heads = recording.heads.copy()
    rest = np.stack([bone.rotation for bone in recording.bones])
    turns = recording.rotations @ np.swapaxes(rest, -1, -2)
    rotations, joints = turns.copy(), []
    for b, bone in enumerate(recording.bones):
        offset = bone.head
        if bone.parent >= 0:
            up = np.swapaxes(turns[:, bone.parent], -1, -2)
            apart = recording.heads[:, b] - recording.heads[:, bone.parent]
            heads[:, b] = np.einsum("tij,tj->ti", up, apart)
            rotations[:, b] = up @ turns[:, b]
            offset = bone.head - recording.bones[bone.parent].head
        joints.append(Joint(bone.name, bone.parent, offset, bone.tail - bone.head))
    step = float(np.median(np.diff(recording.times)))
    return MotionClip(recording.name, tuple(joints), heads, rotations, step, 1.0)
