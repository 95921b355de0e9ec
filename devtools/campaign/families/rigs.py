"""Random rigs in Blender: names, topologies, rests, scales, parents, rotation modes. Analysed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ....bridge.accessors import armature_data, pose_of, present
from ....bridge.files.import_clip import import_clip
from ....bridge.properties.settings import settings_of
from ...recordings import HELD
from ..protocol.blender_file import MARK, empty_file, marked, must_be_same, refusals
from ..protocol.case import Family, HostileCase
from .bipeds import hopping_biped

OPERATORS: Any = bpy.ops  # of which the stubs do not know all
NAMES = (
    *("Hips", "hips", "Spine", "Head", "head", "LeftUpLeg", "RightUpLeg", "LeftLeg", "RightLeg"),
    *("LeftFoot", "RightFoot", "LeftToeBase", "thigh.L", "thigh.R", "shin.L", "shin.R", "foot.L"),
    *("foot.R", "upper_arm.L", "upper_arm.R", "hand.L", "hand.R", "Bone", "骨", "Ћуфта", "a" * 63),
    *('q"uote', "back\\slash", "bra[ck]et", "dot.", ".", " ", "\t", "DEF-spine", "MCH-x", "nan"),
)
FITTED = 0.15  # of the rigs that could be analysed
MODES: tuple[Any, ...] = ("QUATERNION", "XYZ", "ZYX", "AXIS_ANGLE")
FACTORS = (0.0, 1e-9, 1e-3, 0.01, 1.0, -1.0, 100.0, 1e6)
SOURCES = ("forward_jump_116cm.bvh", "131_03_hop.bvh", "hop_01_01.bvh")


def made_up(case: HostileCase) -> None:
    """Bones anywhere, that move anyhow."""
    empty_file()
    armature = _skeleton(case)
    _keys(case, armature)
    for _ in range(int(case.rng.integers(3))):
        case.pick(CHANGES)(case, armature)
    analysed(case, armature)


def bipeds(case: HostileCase) -> None:
    """Figures with arms and legs of any proportions and names that hop, and may be changed."""
    empty_file()
    armature = hopping_biped(case)
    for _ in range(int(case.rng.integers(3))):
        case.pick(CHANGES)(case, armature)
    analysed(case, armature)


def changed(case: HostileCase) -> None:
    """A recorded jump whose rig was changed."""
    empty_file()
    armature = import_clip(HELD / case.pick(SOURCES)).armature
    first = int(case.rng.integers(1, 200))
    settings = settings_of(armature)
    settings.use_range = True
    settings.first_frame, settings.last_frame = first, first + int(case.rng.integers(0, 150))
    for _ in range(int(case.rng.integers(1, 3))):
        case.pick(CHANGES)(case, armature)
    analysed(case, armature)


def analysed(case: HostileCase, armature: bpy.types.Object) -> None:
    """Its bones are found, the recording analysed and some fitted, or a refusal says why not."""
    layer = present(bpy.context.view_layer)
    layer.objects.active = armature
    layer.update()
    if armature.animation_data is not None and armature.animation_data.action is not None:
        armature.animation_data.action[MARK] = "recording"
    before = marked()
    try:
        with refusals():
            OPERATORS.hangtime.find_bones()
        with refusals():
            OPERATORS.hangtime.analyze()
        case.taken_on = True
        if case.chance(FITTED):
            with refusals():
                OPERATORS.hangtime.fit()
    finally:
        must_be_same(before, marked())


def _skeleton(case: HostileCase) -> bpy.types.Object:
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    present(bpy.context.collection).objects.link(armature)
    present(bpy.context.view_layer).objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones: list[bpy.types.EditBone] = []
    for _ in range(int(case.rng.integers(0, 30))):
        bone = armature_data(armature).edit_bones.new(case.pick(NAMES))
        if bones and case.chance(0.9):
            bone.parent = case.pick(bones)
        head = bone.parent.tail if bone.parent is not None else (0.0, 0.0, 1.0)
        size = 0.3 * (case.pick(FACTORS) if case.chance(0.1) else 1.0)
        bone.head = head
        bone.tail = tuple(np.array(head) + size * case.rng.normal(size=3))
        bone.roll = case.rng.uniform(-4.0, 4.0)
        bones.append(bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def _keys(case: HostileCase, armature: bpy.types.Object) -> None:
    bones = list(pose_of(armature).bones)
    frames = range(1, int(case.rng.integers(2, 80)), int(case.rng.integers(1, 8)))
    for bone in bones[:8]:
        bone.rotation_mode = case.pick(MODES)
        path = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}.get(
            bone.rotation_mode, "rotation_euler"
        )
        for frame in frames:
            bone.location = (case.rng.normal(size=3) * case.pick((0.0, 0.01, 1.0))).tolist()
            bone.keyframe_insert("location", frame=frame)
            setattr(bone, path, case.rng.normal(size=len(getattr(bone, path))))
            bone.keyframe_insert(path, frame=frame)


# ---------------------------------------------------------------- changes


def _bone(case: HostileCase, armature: bpy.types.Object) -> bpy.types.PoseBone | None:
    bones = list(pose_of(armature).bones)
    return case.pick(bones) if bones else None


def _renamed(case: HostileCase, armature: bpy.types.Object) -> None:
    if (bone := _bone(case, armature)) is not None:
        bone.name = case.pick(NAMES)


def _mode(case: HostileCase, armature: bpy.types.Object) -> None:
    if (bone := _bone(case, armature)) is not None:
        bone.rotation_mode = case.pick(MODES)


def _posed(case: HostileCase, armature: bpy.types.Object) -> None:
    if (bone := _bone(case, armature)) is not None:
        bone.scale = [case.pick(FACTORS) for _ in range(3)]


def _object(case: HostileCase, armature: bpy.types.Object) -> None:
    factors = [case.pick(FACTORS)] * 3 if case.chance(0.7) else [case.pick(FACTORS) for _ in "xyz"]
    armature.scale = factors
    armature.rotation_euler = case.rng.normal(size=3).tolist()


def _under(case: HostileCase, armature: bpy.types.Object) -> None:
    parent = bpy.data.objects.new("Parent", None)
    present(bpy.context.collection).objects.link(parent)
    parent.scale = [case.pick(FACTORS) for _ in range(3)]
    armature.parent = parent


def _edited(case: HostileCase, armature: bpy.types.Object) -> None:
    """Bones deleted, of no length, or with another parent."""
    present(bpy.context.view_layer).objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature_data(armature).edit_bones
    for _ in range(int(case.rng.integers(1, 6))):
        if not len(bones):
            break
        bone, other = case.pick(list(bones)), case.pick(list(bones))
        match int(case.rng.integers(4)):
            case 0:
                bones.remove(bone)
            case 1:
                bone.tail = bone.head
            case 2:
                bone.parent = None
            case _:
                if bone not in (other, *other.parent_recursive):
                    bone.parent = other
    bpy.ops.object.mode_set(mode="OBJECT")


def _keyed(case: HostileCase, armature: bpy.types.Object) -> None:
    """A key that is no number, or far off."""
    data = armature.animation_data
    curves = list(data.action.fcurves) if data is not None and data.action is not None else []
    if curves:
        points = case.pick(curves).keyframe_points
        place = (float("nan"), float("inf"), 1e30, -1e6, 0.0)
        if len(points):
            case.pick(list(points)).co[1] = case.pick(place)


def _constrained(case: HostileCase, armature: bpy.types.Object) -> None:
    if (bone := _bone(case, armature)) is not None:
        kind: Any = case.pick(("IK", "COPY_ROTATION", "LIMIT_LOCATION", "CHILD_OF", "STRETCH_TO"))
        made: Any = bone.constraints.new(kind)
        if hasattr(made, "target"):
            made.target = armature
            made.subtarget = case.pick([each.name for each in pose_of(armature).bones])


def _settings(case: HostileCase, armature: bpy.types.Object) -> None:
    settings = settings_of(armature)
    settings.mass = case.pick((1e-6, 1.0, 70.0, 1e9))
    settings.first_frame = int(case.rng.integers(-100, 400))
    settings.last_frame = int(case.rng.integers(-100, 400))
    settings.use_range = case.chance(0.5)


def _scene(case: HostileCase, _: bpy.types.Object) -> None:
    scene = present(bpy.context.scene)
    scene.render.fps = case.pick((1, 12, 24, 240, 1000))
    scene.unit_settings.scale_length = case.pick((1e-5, 0.01, 1.0, 1000.0))


CHANGES: tuple[Callable[[HostileCase, bpy.types.Object], None], ...] = (
    *(_renamed, _mode, _posed, _object, _under, _edited, _edited, _keyed, _constrained, _settings),
    _scene,
)

FAMILIES = (
    Family("rigs, made up", 0.5, 40.0, made_up),
    Family("rigs, bipeds that hop", 3.0, 60.0, bipeds),
    Family("rigs, changed", 3.0, 40.0, changed),
)
