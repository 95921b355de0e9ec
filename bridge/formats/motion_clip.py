"""Motion clip: a file's skeleton and motion as plain arrays; conversion to a `Recording` and back.

Every joint's rest frame has the file's axes, so a joint's rotation matrix is the rotation of the
figure's part itself, whatever the file calls its channels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.recording import Bone, Recording
from ...solver.numerics.rotations import axis_rotation

UpAxis = Literal["Y", "Z"]

# Blender's BVH importer lengthens bones shorter than a thousandth of a unit to a tenth: so do we,
# that both readings of a file have the same bones.
SHORTEST_BONE = 0.001
SUBSTITUTE_BONE = 0.1

_TO_Z_UP: dict[UpAxis, FloatArray] = {
    "Y": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    "Z": np.eye(3),
}


@dataclass(frozen=True)
class Joint:
    """Joint of the rest skeleton, in the file's units and axes.

    parent: index in `MotionClip.joints`, -1 for a root; parents come first.
    offset: (3,) from the parent's head to this head at rest (a root's: from the origin).
    tip: (3,) from this head to the part's own end at rest, where the file gives one.
    """

    name: str
    parent: int
    offset: FloatArray
    tip: FloatArray | None = None


@dataclass(frozen=True)
class MotionClip:
    """Skeleton and motion of a file, in its own units and axes.

    positions: (T, J, 3) each head in its parent's frame. rotations: (T, J, 3, 3) each joint's
    frame in its parent's. frame_time: s. unit: m per unit of length, None where the file is silent.
    miscount: frames that the file announces, and that it holds, where these are more.
    unmoved: joints that the skeleton lets move, and that the motion says nothing of.
    """

    name: str
    joints: tuple[Joint, ...]
    positions: FloatArray
    rotations: FloatArray
    frame_time: float
    unit: float | None = None
    miscount: tuple[int, int] | None = None
    unmoved: tuple[str, ...] = ()


def to_z_up(up: UpAxis) -> FloatArray:
    """(3, 3) rotation from the file's axes to Z up, the one Blender's BVH importer uses."""
    return _TO_Z_UP[up]


def euler_matrices(axes: Sequence[int], angles: FloatArray) -> FloatArray:
    """(T, 3, 3): R(axes[0]) R(axes[1]) ..., by the columns of angles (T, len(axes)), rad."""
    out = np.broadcast_to(np.eye(3), (len(angles), 3, 3)).copy()
    for column, axis in enumerate(axes):
        out = out @ axis_rotation(axis, angles[:, column])
    return out


def forward_kinematics(
    clip: MotionClip, frames: slice | IntArray = slice(None)
) -> tuple[FloatArray, FloatArray]:
    """Heads (T, J, 3) and rotations (T, J, 3, 3) in the file's world, at the frames chosen."""
    heads, rotations = clip.positions[frames].copy(), clip.rotations[frames].copy()
    for j, joint in enumerate(clip.joints):
        if joint.parent >= 0:
            up = rotations[:, joint.parent]
            heads[:, j] = heads[:, joint.parent] + np.einsum("tij,tj->ti", up, heads[:, j])
            rotations[:, j] = up @ rotations[:, j]
    return heads, rotations


def rest_heads(clip: MotionClip) -> FloatArray:
    """(J, 3) heads of the rest pose, in the file's world."""
    heads = np.array([joint.offset for joint in clip.joints], dtype=float)
    for j, joint in enumerate(clip.joints):
        if joint.parent >= 0:
            heads[j] += heads[joint.parent]
    return heads


def rest_axes(clip: MotionClip) -> FloatArray:
    """(J, 3) from head to tail at rest: the part's own tip, else the mean of its children's heads.

    Never zero: a part without length gets a tenth of a unit along y, as Blender's importer does.
    """
    children: dict[int, list[FloatArray]] = {}
    for joint in clip.joints:
        children.setdefault(joint.parent, []).append(joint.offset)
    axes = np.zeros((len(clip.joints), 3))
    for j, joint in enumerate(clip.joints):
        if joint.tip is not None:
            axes[j] = joint.tip
        elif j in children:
            axes[j] = np.mean(children[j], axis=0)
        if np.linalg.norm(axes[j]) <= SHORTEST_BONE:
            axes[j, 1] += SUBSTITUTE_BONE
    return axes


def to_recording(clip: MotionClip, unit: float, up: UpAxis) -> Recording:
    """Convert to a recording: metres, Z up, frames counted from 1, rest frames along the world.

    unit: m per unit of the file.
    """
    turn = to_z_up(up)
    heads, rotations = forward_kinematics(clip)
    rest = unit * rest_heads(clip) @ turn.T
    tails = rest + unit * rest_axes(clip) @ turn.T
    bones = tuple(
        Bone(joint.name, joint.parent, rest[j], tails[j], np.eye(3))
        for j, joint in enumerate(clip.joints)
    )
    count = np.arange(len(heads), dtype=float)
    return Recording(
        clip.name,
        bones,
        count + 1.0,
        count * clip.frame_time,
        unit * heads @ turn.T,
        turn @ rotations @ turn.T,
    )


def from_recording(recording: Recording) -> MotionClip:
    """Inverse of `to_recording`: a clip in metres, Z up, for `build_armature(clip, 1.0, "Z")`.

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
