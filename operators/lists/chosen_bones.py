"""The bones that the artist has selected in pose mode."""

from __future__ import annotations

import bpy

from ...bridge.accessors import armature_data, pose_of


def chosen_bones(armature: bpy.types.Object) -> list[str]:
    """Names of the selected pose bones, the active one first; none outside pose mode."""
    if armature.mode != "POSE":
        return []
    names = [bone.name for bone in pose_of(armature).bones if _is_selected(bone)]
    active = armature_data(armature).bones.active
    if active is not None and active.name in names:
        names.remove(active.name)
        names.insert(0, active.name)
    return names


def _is_selected(bone: bpy.types.PoseBone) -> bool:
    # From Blender 5.0 on the pose's bone knows it.
    carrier = bone if hasattr(bone, "select") else bone.bone
    return bool(carrier.select and not getattr(carrier, "hide", False))
