"""Rows of the lists of constraints and of body changes, for their tests."""

from __future__ import annotations

from pathlib import Path

import bpy
from hangtime.bridge.constraints.requests import requests_of
from hangtime.bridge.constraints.rows import add_constraint
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.solver.data import requests
from hangtime.tests.blender.helpers import rigs

IN_FLIGHT = 8.0  # a frame of the rig's clip
PHASES = (("ground 1", 1.0, 5.0), ("ground 2", 15.0, 24.0))


def make_rig() -> bpy.types.Object:
    """An animated armature with two contacts, on the ground until frame 5 and from 15 on."""
    rigs.reset()
    armature = rigs.make_armature()
    rigs.animate(armature)
    for phase, start, end in PHASES:
        row = armature.hangtime.contacts.add()
        row.name, row.point, row.bone, row.phase = f"Heel {phase[-1]}", "Heel", "foot", phase
        row.found_start = row.start_frame = start
        row.found_end = row.end_frame = end
    bpy.context.scene.frame_set(int(IN_FLIGHT))
    return armature


def make_stances(forward: tuple[float, float, float]) -> bpy.types.Object:
    """The same, chosen in the panel; each contact is so many metres along X as its phase counts,
    and in a stance of its own, whose forward axis is given."""
    armature = make_rig()
    bpy.context.scene.hangtime.armature = armature
    for row in armature.hangtime.contacts:
        row.found_at = row.at = (float(row.name[-1]), 0.0, 0.0)
        stance = armature.hangtime.stances.add()
        stance.name, stance.forward_axis = row.phase, forward
    return armature


def added(
    armature: bpy.types.Object, kind: ConstraintKind, *bones: str, **fields: object
) -> bpy.types.PropertyGroup:
    """A new row with some of its fields set."""
    row = add_constraint(armature, kind, bones, IN_FLIGHT)
    for name, value in fields.items():
        setattr(row, name, value)
    return row


def asked(armature: bpy.types.Object) -> requests.Requests:
    return requests_of(armature.hangtime, armature)


def names(armature: bpy.types.Object) -> list[str]:
    return [row.name for row in armature.hangtime.constraints]


def select(armature: bpy.types.Object, *bones: str) -> None:
    """In pose mode, these alone; the first is active."""
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="POSE")
    for bone in armature.pose.bones:
        carrier = bone if hasattr(bone, "select") else bone.bone
        carrier.select = bone.name in bones
    armature.data.bones.active = armature.data.bones[bones[0]]


def rename(armature: bpy.types.Object, old: str, new: str) -> None:
    armature.data.bones[old].name = new


def reopen(path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
