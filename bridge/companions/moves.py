"""Where bones that go along with a body are in a result, as pose bases."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_scene
from ..armature.pose_basis import basis_under
from ..armature.poses import Poses, metres_per_unit
from .root_motion import way, without_turns

_SAME = 1e-4  # of a basis: of its turns, and of its shifts in the bone's length


def root_basis(
    armature: bpy.types.Object, root: str, poses: Poses, track: PoseTrack, *, turns: bool
) -> FloatArray:
    """(T, 4, 4) basis with which a root is to a track's pelvis, over the floor, as in poses.

    Its height, and its tilt, stay the take's; turns: whether it turns with the pelvis about the
    vertical. The track's frames are those of the poses, its first bone is the pelvis.
    """
    pelvis = track.bones[0]
    rest = poses.object_to_world[0] @ np.array(armature_data(armature).bones[pelvis].matrix_local)
    was = poses.object_to_world @ _of(poses, pelvis)
    now = np.tile(np.eye(4), (len(was), 1, 1))
    now[:, :3, :3] = track.rotations[:, 0]
    now[:, :3, 3] = track.root_head / metres_per_unit(current_scene())
    ways = [way(each, rest, steady=False) for each in (now, was)]
    if not turns:
        ways = [without_turns(each, rest) for each in ways]
    move = ways[0] @ np.linalg.inv(ways[1])
    world = poses.object_to_world
    own = np.linalg.inv(world) @ move @ world @ _of(poses, root)
    return _basis(armature, root, _parent(armature, root, poses, {}), own)


def following_bases(
    armature: bpy.types.Object, followers: Iterable[tuple[str, str]], was: Poses, now: Poses
) -> dict[str, FloatArray]:
    """(T, 4, 4) bases by follower with which each is on its bone as it was, parents first; of none
    that a scale of 0 hides, or what it follows or hangs on.

    was: poses of the take; now: of the result, in which followers are not yet there.
    """
    placed: dict[str, FloatArray] = {}
    found: dict[str, FloatArray] = {}
    for name, body in followers:
        parent = _parent(armature, name, now, placed)
        if is_hidden(_of(was, body), _of(was, name), *(() if parent is None else (parent,))):
            continue
        placed[name] = _of(now, body) @ np.linalg.inv(_of(was, body)) @ _of(was, name)
        found[name] = _basis(armature, name, parent, placed[name])
    return found


def is_hidden(*poses: FloatArray) -> bool:
    """Whether a scale of 0, which nothing undoes, is in any of transformations (T, 4, 4)."""
    return not all(np.linalg.det(each[:, :3, :3]).all() for each in poses)


def differs(armature: bpy.types.Object, poses: Poses, name: str, basis: FloatArray) -> bool:
    """Whether a basis (T, 4, 4) is another than a bone has in poses."""
    shown = _basis(armature, name, _parent(armature, name, poses, {}), _of(poses, name))
    off = np.abs(basis - shown)
    off[:, :3, 3] /= armature_data(armature).bones[name].length
    return bool(off.max() > _SAME)


def _of(poses: Poses, name: str) -> FloatArray:
    return poses.matrices[:, poses.bones.index(name)]


def _parent(
    armature: bpy.types.Object, name: str, poses: Poses, placed: Mapping[str, FloatArray]
) -> FloatArray | None:
    """(T, 4, 4) of a bone's parent, None without one, where some bones above are placed otherwise
    than in the poses."""
    bone = armature_data(armature).bones[name]
    if bone.parent is None:
        return None
    parent = _of(poses, bone.parent.name)
    for above in bone.parent_recursive:
        if above.name in placed and not is_hidden(_of(poses, above.name)):
            return np.asarray(placed[above.name] @ np.linalg.inv(_of(poses, above.name)) @ parent)
    return parent


def _basis(
    armature: bpy.types.Object, name: str, parent: FloatArray | None, pose: FloatArray
) -> FloatArray:
    return basis_under(armature_data(armature).bones[name], parent, pose)
