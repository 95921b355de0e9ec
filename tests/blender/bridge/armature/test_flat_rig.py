"""Bones that lie flat and copy controls, as rigs for engines have them."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.read import record
from hangtime.bridge.constraints.bone_mapping import find_parts
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")


def flat_rig() -> bpy.types.Object:
    """Rigify's skeleton as controls, and on each a deform bone without a parent."""
    rigs.reset()
    armature = build(next(each for each in layouts() if each.key == "rigify"), actor())
    bpy.context.view_layer.objects.active = armature
    names = [bone.name for bone in armature.data.bones]
    bpy.ops.object.mode_set(mode="EDIT")
    for name in names:
        control = armature.data.edit_bones[name]
        flat = armature.data.edit_bones.new(f"DEF-{name}")
        flat.head, flat.tail, flat.roll = control.head, control.tail, control.roll
    bpy.ops.object.mode_set(mode="OBJECT")
    for name in names:
        copy = armature.pose.bones[f"DEF-{name}"].constraints.new("COPY_TRANSFORMS")
        copy.target, copy.subtarget = armature, name
    return armature


@pytest.mark.slow
def test_flat_deform_bones_are_found_with_a_pelvis_above_them() -> None:
    armature = flat_rig()
    find_parts(armature)
    found = {part.name: part.bone for part in armature.hangtime.parts}
    assert found["pelvis"] == "DEF-spine"
    assert found["left shank"] == "DEF-shin.L"
    bones = record(armature, np.array([1.0])).bones
    assert bones[map_anatomy(bones)[0].bone].name == "DEF-spine"
