"""Whether a rig's bodies are moved by controls, and which bones may be those."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from ..accessors import armature_data, pose_of
from ..armature import fcurves

_INNER = ("ORG-", "DEF-", "MCH-", "VIS_", "WGT-")  # Rigify's, which are no controls
_FEWEST_SHAPES = 5  # bones with shapes of their own, by which a rig shows what its controls are
_PASSIVE = ("LIMIT_", "MAINTAIN_VOLUME", "CACHE")  # constraints that move nothing by themselves
_CHAINS = (bpy.types.KinematicConstraint, bpy.types.SplineIKConstraint)


def is_driven(armature: bpy.types.Object, bones: Iterable[str]) -> bool:
    """Whether something else than their own keys and their parents' moves some of these bones."""
    moved = constrained(armature)
    rest = armature_data(armature).bones
    return any(
        each.name in moved for name in bones for each in (rest[name], *rest[name].parent_recursive)
    )


def constrained(armature: bpy.types.Object) -> set[str]:
    """Bones with constraints, and those of inverse kinematics' chains."""
    found = set()
    for bone in pose_of(armature).bones:
        for constraint in bone.constraints:
            if constraint.mute or constraint.type.startswith(_PASSIVE):
                continue
            found.add(bone.name)
            if isinstance(constraint, _CHAINS):
                chain = [bone, *bone.parent_recursive]
                count = constraint.chain_count or len(chain)
                found.update(each.name for each in chain[:count])
    return found


def candidates(armature: bpy.types.Object, bodies: Iterable[str]) -> list[str]:
    """Bones that an artist may pose, parents first: those with shapes of their own where a rig has
    such, and those with keys; but no bodies, and none whose channels are all locked."""
    keyed = {fcurves.bone_of(curve.data_path) for curve in fcurves.curves_of(armature)}
    bones = [b for b in pose_of(armature).bones if not b.name.startswith(_INNER)]
    shaped = [bone for bone in bones if bone.custom_shape is not None]
    if len(shaped) >= _FEWEST_SHAPES:
        bones = [b for b in bones if b.custom_shape is not None or b.name in keyed]
    inner = set(bodies)
    found = [bone.name for bone in bones if bone.name not in inner and _free(bone)]
    rest = armature_data(armature).bones
    return sorted(found, key=lambda name: len(rest[name].parent_recursive))


def _free(bone: bpy.types.PoseBone) -> bool:
    return not (all(bone.lock_location) and all(bone.lock_rotation))
