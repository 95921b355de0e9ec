"""A rig laid out as Auto-Rig Pro's, and the actor's jump on its controls, in FK or in IK.

Its bones and what they follow are in auto_rig_pro.toml.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector

from ....bridge.accessors import armature_data, pose_of, present
from ....bridge.armature import fcurves
from ....bridge.armature.channels import channels
from ....solver.arrays import FloatArray
from ....solver.data.recording import Bone
from ....solver.numerics.rotations import unit
from ..actor import JOINTS, Actor
from ..layout import GROUND, Placed
from .rest import FILE, POLE, AtRest, at_rest, bend, deform_bones, is_pole

SWITCH = "ik_fk_switch"  # on the limbs' IK controls; 0 is inverse kinematics
LIMBS = {"arm": "c_hand_ik", "leg": "c_foot_ik"}
STRAIGHT = 0.02  # m; a limb that bends less keeps its pole where the upper bone's own axis points
CONTROL = "c_"


@dataclass(frozen=True)
class Follows:
    """A constraint. share: of the target's length. switch: "IK" or "FK", in which alone it acts."""

    bone: str
    kind: str
    target: str
    share: float
    switch: str | None


def auto_rig_pro(actor: Actor, *, ik: bool, rate: int) -> bpy.types.Object:
    """The rig in an empty scene of its own, with the actor's jump on its controls."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = present(bpy.context.scene)
    scene.render.fps, scene.render.fps_base = rate, 1.0
    scene.frame_start, scene.frame_end = int(actor.frames[0]), int(actor.frames[-1])
    rest = at_rest(actor)
    armature = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    present(scene.collection).objects.link(armature)
    _add_bones(armature, rest.bones(actor))
    _shape_controls(armature)
    _add_switches(armature, ik=ik)
    for follows in _follows():
        _constrain(armature, follows)
    _perform(armature, rest, actor, ik=ik)
    present(bpy.context.view_layer).update()
    return armature


def _add_bones(armature: bpy.types.Object, bones: Sequence[Bone]) -> None:
    present(bpy.context.view_layer).objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    edit = armature_data(armature).edit_bones
    deforming = deform_bones()
    for bone in bones:
        made = edit.new(bone.name)
        made.head, made.tail = Vector(bone.head.tolist()), Vector(bone.tail.tolist())
        made.align_roll(Vector(bone.rotation[:, 2].tolist()))
        made.use_deform = bone.name in deforming
        if bone.parent >= 0:
            made.parent = edit[bones[bone.parent].name]
    bpy.ops.object.mode_set(mode="OBJECT")


def _shape_controls(armature: bpy.types.Object) -> None:
    shape = bpy.data.objects.new("cs_user", None)
    for bone in pose_of(armature).bones:
        if bone.name.startswith(CONTROL) and "scale_fix" not in bone.name:
            bone.custom_shape = shape
            bone.rotation_mode = "XYZ"
            bone.lock_location = (bone.name.rpartition(".")[0].endswith("_fk"),) * 3
            bone.lock_rotation = ("_pole" in bone.name,) * 3


def _add_switches(armature: bpy.types.Object, *, ik: bool) -> None:
    for side in "lr":
        for control in LIMBS.values():
            pose_of(armature).bones[f"{control}.{side}"][SWITCH] = 0.0 if ik else 1.0


def _follows() -> Iterator[Follows]:
    words = tomllib.loads(FILE.read_text(encoding="utf-8"))["follow"]
    lines = [line.format(s=side) for line in words.splitlines() if line for side in "lr"]
    for line in dict.fromkeys(lines):
        bone, kind, target, *switch = line.split()
        name, _, share = target.partition(":")
        yield Follows(bone, kind, name, float(share or 0.0), switch[0] if switch else None)


def _constrain(armature: bpy.types.Object, follows: Follows) -> None:
    bones = pose_of(armature).bones
    made = bones[follows.bone].constraints.new(follows.kind)  # type: ignore[arg-type]
    made.target, made.subtarget = armature, follows.target  # type: ignore[attr-defined]
    if isinstance(made, bpy.types.CopyLocationConstraint):
        made.head_tail = follows.share
    if isinstance(made, bpy.types.ChildOfConstraint):
        made.inverse_matrix = armature_data(armature).bones[follows.target].matrix_local.inverted()
    if isinstance(made, bpy.types.KinematicConstraint):
        made.chain_count, made.use_stretch = 2, False
        made.iterations = 200
        made.pole_target = armature
        made.pole_subtarget = _pole(follows.bone)
    if follows.switch is not None:
        _drive(armature, follows, made)


def _pole(bone: str) -> str:
    return f"{'c_arms' if bone.startswith('forearm') else 'c_leg'}_pole{bone[-2:]}"


def _drive(armature: bpy.types.Object, follows: Follows, constraint: bpy.types.Constraint) -> None:
    """Lets the limb's switch say how much of a constraint acts."""
    limb = "arm" if follows.bone.startswith(("arm", "forearm", "hand")) else "leg"
    control = pose_of(armature).bones[f"{LIMBS[limb]}{follows.bone[-2:]}"]
    curve = constraint.driver_add("influence")
    assert isinstance(curve, bpy.types.FCurve)
    driver = present(curve.driver)
    variable = driver.variables.new()
    variable.name = "switch"
    variable.targets[0].id = armature
    variable.targets[0].data_path = control.path_from_id(f'["{SWITCH}"]')
    driver.expression = "1 - switch" if follows.switch == "IK" else "switch"


def _perform(armature: bpy.types.Object, rest: AtRest, actor: Actor, *, ik: bool) -> None:
    """Keys the controls of the limbs that act, and those of the trunk."""
    poses = _poses(armature, rest, actor)
    rests = {b.name: np.array(b.matrix_local) for b in armature_data(armature).bones}
    curves = fcurves.new_holder(armature, "jump")
    for bone in rest.placed:
        control = pose_of(armature).bones[bone.name]
        stem = bone.name.rpartition(".")[0]
        other = stem.endswith("_fk" if ik else ("_ik", "_pole", "c_foot_01"))
        if control.custom_shape is None or other or bone.joint == GROUND:
            continue
        basis = np.linalg.solve(rests[bone.name], poses[bone.name])
        if bone.parent is not None:
            offset = np.linalg.solve(rests[bone.parent], rests[bone.name])
            basis = np.linalg.solve(poses[bone.parent] @ offset, poses[bone.name])
        if not all(control.lock_rotation):
            path = control.path_from_id("rotation_euler")
            values = channels(basis[:, :3, :3], "XYZ")
            fcurves.write_channels(curves, path, actor.frames, values, bone.name)
        if bone.parent is None or stem == "c_root_master":
            path = control.path_from_id("location")
            fcurves.write_channels(curves, path, actor.frames, basis[:, :3, 3], bone.name)


def _poses(armature: bpy.types.Object, rest: AtRest, actor: Actor) -> dict[str, FloatArray]:
    """(T, 4, 4) of each bone as the actor's joints carry it; poles where knees and elbows bend."""
    poses = {}
    for bone in rest.placed:
        at = np.array(armature_data(armature).bones[bone.name].matrix_local)
        pose = np.tile(at, (len(actor.frames), 1, 1))
        if bone.joint != GROUND:
            j = JOINTS.index(bone.joint)
            turns = actor.turns[:, j] @ rest.turns[j].T
            pose[:, :3, :3] = turns @ at[:3, :3]
            pose[:, :3, 3] = actor.heads[:, j] + turns @ (at[:3, 3] - rest.centres[j])
        if is_pole(bone):
            pose[:, :3, :3] = at[:3, :3]
            pose[:, :3, 3] = _pole_places(bone, rest, actor)
        poses[bone.name] = pose
    return poses


def _pole_places(bone: Placed, rest: AtRest, actor: Actor) -> FloatArray:
    """(T, 3) m."""
    middle = JOINTS.index(bone.joint)
    first = actor.parents[middle]
    last = next(j for j, parent in enumerate(actor.parents) if parent == middle)
    bends = bend(*(actor.heads[:, j] for j in (first, middle, last)))
    own = (actor.turns[:, first] @ rest.turns[first].T @ rest.frames[first])[..., 0]
    return np.asarray(actor.heads[:, middle] + POLE * unit(bends + STRAIGHT * own))
