"""Bones that are found again after the artist renamed them, by a key that the bone carries.

A key travels with its bone through edit mode, copies and files. A copied bone has the same key as
the one it was copied from; the name then decides.
"""

from __future__ import annotations

from uuid import uuid4

import bpy

from ..accessors import armature_data, attached


def find(armature: bpy.types.Object, key: str, called: str) -> bpy.types.Bone | None:
    """The bone with a key, else the one of that name; None where neither is there.

    called: the name when last looked at, which decides among bones with the same key.
    """
    if armature.type != "ARMATURE":
        return None
    bones = armature_data(armature).bones
    by_name = bones.get(called)
    if not key or (by_name is not None and key_of(by_name) == key):
        return by_name
    return next((bone for bone in bones if key_of(bone) == key), by_name)


def current_name(armature: bpy.types.Object, key: str, called: str) -> str:
    """What a bone is called now; what it was called where it is gone."""
    bone = find(armature, key, called)
    return bone.name if bone is not None else called


def remember(armature: bpy.types.Object, name: str) -> str:
    """The key of the bone of that name, which gets one where it has none.

    Empty where there is no such bone, or its armature is linked and cannot carry one.
    """
    bone = find(armature, "", name)
    if bone is None:
        return ""
    data = armature_data(armature)
    if not key_of(bone) and data.is_editable and not data.override_library:
        attached(bone).key = uuid4().hex
    return key_of(bone)


def key_of(bone: bpy.types.Bone) -> str:
    """The key that a bone carries; empty where it has none."""
    return str(attached(bone).key)
