"""Small animated rigs, made from nothing, for the Blender-facing tests."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Quaternion

FRAMES = range(1, 25)
MOVING = ("hips", "spine", "head", "thigh", "shin", "foot")  # parents first, the pelvis first
RIDING = ("twist", "finger")


@dataclass(frozen=True)
class BoneSpec:
    """A bone of the test rig; head and tail in the armature's space."""

    name: str
    parent: str | None
    head: tuple[float, float, float]
    tail: tuple[float, float, float]
    roll: float = 0.0
    connected: bool = False


BODY = (
    BoneSpec("hips", None, (0.0, 0.0, 1.0), (0.0, 0.0, 1.2), 0.4),
    BoneSpec("spine", "hips", (0.0, 0.0, 1.2), (0.0, 0.05, 1.5), -0.3, True),
    BoneSpec("twist", "spine", (0.0, 0.05, 1.5), (0.0, 0.0, 1.6), 0.7),
    BoneSpec("head", "twist", (0.0, 0.05, 1.5), (0.0, -0.02, 1.9)),  # where "twist" turns about
    BoneSpec("thigh", "hips", (0.1, 0.0, 1.0), (0.12, -0.03, 0.55), 1.2),
    BoneSpec("shin", "thigh", (0.12, -0.03, 0.55), (0.12, 0.02, 0.1), 1.0, True),
    BoneSpec("foot", "shin", (0.12, 0.02, 0.1), (0.14, -0.15, 0.02), -2.0, True),
    BoneSpec("finger", "head", (0.0, 0.0, 1.9), (0.1, 0.0, 1.9)),
)


def reset() -> None:
    """An empty scene as the factory has it. Preferences and Blender's add-ons stay, for they take
    six times as long."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def make_armature(specs: Iterable[BoneSpec] = BODY, name: str = "Rig") -> bpy.types.Object:
    """An armature object with these bones, in the scene and active, without animation."""
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for spec in specs:
        bone = armature.data.edit_bones.new(spec.name)
        bone.head, bone.tail, bone.roll = spec.head, spec.tail, spec.roll
        if spec.parent is not None:
            bone.parent = armature.data.edit_bones[spec.parent]
            bone.use_connect = spec.connected
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def with_root(specs: Iterable[BoneSpec] = BODY, *, connected: bool = False) -> list[BoneSpec]:
    """The same bones with a root bone above those that had no parent."""
    root = BoneSpec("root", None, (0.3, 0.2, 0.0), (0.0, 0.0, 1.0), 0.5)
    return [root] + [
        BoneSpec(
            s.name,
            s.parent or "root",
            s.head,
            s.tail,
            s.roll,
            s.connected or (not s.parent and connected),
        )
        for s in specs
    ]


def animate(
    armature: bpy.types.Object,
    mode: str = "QUATERNION",
    seed: int = 0,
    frames: Iterable[int] = FRAMES,
) -> None:
    """Key every bone's rotation in `mode`, and the location of bones without a parent."""
    rng = np.random.default_rng(seed)
    swings = {bone.name: rng.uniform(-1.0, 1.0, (2, 3)) for bone in armature.pose.bones}
    for bone in armature.pose.bones:
        bone.rotation_mode = mode
    for frame in frames:
        for bone in armature.pose.bones:
            set_rotation(bone, swing(swings[bone.name], frame))
            bone.keyframe_insert(rotation_path(bone), frame=frame)
            if bone.parent is None:
                bone.location = 0.3 * np.sin(0.2 * frame * swings[bone.name][0])
                bone.keyframe_insert("location", frame=frame)


def swing(amplitudes: np.ndarray, frame: float) -> Quaternion:
    """A smooth rotation at a frame; amplitudes: (2, 3) rad."""
    vector = amplitudes[0] * np.sin(0.1 * frame) + amplitudes[1] * np.cos(0.07 * frame)
    angle = float(np.linalg.norm(vector))
    return Quaternion(vector / angle, angle)


def turn_by(vector: np.ndarray) -> np.ndarray:
    """(3, 3) rotation by a rotation vector, rad."""
    angle = float(np.linalg.norm(vector))
    return np.array(Quaternion(vector / angle, angle).to_matrix())


def rotation_path(bone: bpy.types.PoseBone) -> str:
    """The property that holds a bone's rotation in its mode."""
    paths = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
    return paths.get(bone.rotation_mode, "rotation_euler")


def set_rotation(bone: bpy.types.PoseBone, rotation: Quaternion) -> None:
    """Turn a bone in its own rotation mode."""
    if bone.rotation_mode == "QUATERNION":
        bone.rotation_quaternion = rotation
    elif bone.rotation_mode == "AXIS_ANGLE":
        axis, angle = rotation.to_axis_angle()
        bone.rotation_axis_angle = (angle, *axis)
    else:
        bone.rotation_euler = rotation.to_euler(bone.rotation_mode, bone.rotation_euler)


def world_of(armature: bpy.types.Object, bone: str, frame: float) -> Matrix:
    """A bone's evaluated matrix in the world at a frame, Blender units, by Blender alone."""
    whole = int(np.floor(frame))
    bpy.context.scene.frame_set(whole, subframe=frame - whole)
    posed = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return posed.matrix_world @ posed.pose.bones[bone].matrix
