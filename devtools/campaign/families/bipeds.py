"""Figures with two arms and two legs, of random proportions and names, that crouch and hop."""

from __future__ import annotations

import bpy
import numpy as np

from ....bridge.accessors import armature_data, pose_of, present
from ..protocol.case import HostileCase

# Hips, spine, head, then of each side: upper arm, forearm, hand, thigh, shank, foot.
TRUNK = (("Hips", "Spine", "Head"), ("hips", "spine", "head"), ("pelvis", "spine_01", "head"))
LIMBS = (
    ("{0}Arm", "{0}ForeArm", "{0}Hand", "{0}UpLeg", "{0}Leg", "{0}Foot"),
    (
        *("upper_arm.{0[0]}", "forearm.{0[0]}", "hand.{0[0]}"),
        *("thigh.{0[0]}", "shin.{0[0]}", "foot.{0[0]}"),
    ),
    ("upperarm_{1}", "lowerarm_{1}", "hand_{1}", "thigh_{1}", "calf_{1}", "foot_{1}"),
)
GRAVITY = 9.8
CROUCH = 0.9  # rad, of the thighs at the deepest
STEP = 2  # frames between keys


def hopping_biped(case: HostileCase) -> bpy.types.Object:
    """Looks along -Y and stands on the floor at 0, as most do in Blender."""
    armature = bpy.data.objects.new("Biped", bpy.data.armatures.new("Biped"))
    present(bpy.context.collection).objects.link(armature)
    present(bpy.context.view_layer).objects.active = armature
    convention = int(case.rng.integers(len(TRUNK)))
    leg = float(case.rng.uniform(0.3, 0.55))  # m, thigh and shank each
    names = _built(case, armature, convention, leg)
    _hop(case, armature, names, leg)
    return armature


def _built(
    case: HostileCase, armature: bpy.types.Object, convention: int, leg: float
) -> dict[str, str]:
    """Makes the bones; their names by the first convention's."""
    ankle, foot = float(case.rng.uniform(0.04, 0.1)), float(case.rng.uniform(0.12, 0.25))
    hips = ankle + 2.0 * leg
    top, arm = hips + float(case.rng.uniform(0.4, 0.7)), float(case.rng.uniform(0.2, 0.35))
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature_data(armature).edit_bones
    names: dict[str, str] = {}

    def bone(
        key: str, name: str, head: tuple[float, ...], tail: tuple[float, ...], on: str
    ) -> None:
        made = bones.new(name)
        made.head, made.tail = head, tail
        made.roll = float(case.rng.uniform(-0.5, 0.5)) if case.chance(0.3) else 0.0
        made.parent = bones[names[on]] if on else None
        names[key] = made.name

    usual, own = TRUNK[0], TRUNK[convention]
    bone(usual[0], own[0], (0.0, 0.0, hips), (0.0, 0.0, hips + 0.12), "")
    bone(usual[1], own[1], (0.0, 0.0, hips + 0.12), (0.0, 0.0, top), usual[0])
    bone(usual[2], own[2], (0.0, 0.0, top), (0.0, 0.0, top + 0.22), usual[1])
    for side, x in (("Left", 1.0), ("Right", -1.0)):
        keys = [key.format(side) for key in LIMBS[0]]
        called = [key.format(side, side[0].lower()) for key in LIMBS[convention]]
        wide, hip = 0.18 * x, 0.1 * x
        places: list[tuple[float, float, float]]
        places = [(wide + arm * i * x, 0.0, top - 0.05) for i in range(3)]
        places.append((places[-1][0] + 0.15 * x, 0.0, top - 0.05))
        on = usual[1]
        for i in range(3):
            bone(keys[i], called[i], places[i], places[i + 1], on)
            on = keys[i]
        places = [(hip, 0.0, hips), (hip, 0.0, ankle + leg), (hip, 0.0, ankle)]
        places.append((hip, -foot, 0.02))
        on = usual[0]
        for i in range(3):
            bone(keys[3 + i], called[3 + i], places[i], places[i + 1], on)
            on = keys[3 + i]
    bpy.ops.object.mode_set(mode="OBJECT")
    return names


def _hop(case: HostileCase, armature: bpy.types.Object, names: dict[str, str], leg: float) -> None:
    """Crouch, push, flight, landing: thighs and shanks bend alike, so that the feet stay level."""
    rate = present(bpy.context.scene).render.fps
    stand, flight = float(case.rng.uniform(0.4, 0.8)), float(case.rng.uniform(0.15, 0.5))
    length = 2.0 * stand + flight
    for frame in range(1, 2 + int(length * rate), 1 if rate < 40 else STEP):
        t = (frame - 1) / rate
        ground = t if t < stand else t - stand - flight
        bend, lift = 0.0, 0.0
        if stand < t < stand + flight:
            lift = 0.5 * GRAVITY * (t - stand) * (stand + flight - t)
        else:
            bend = CROUCH * float(np.sin(np.pi * np.clip(ground / stand, 0.0, 1.0)) ** 2)
        lower = 2.0 * leg * (1.0 - float(np.cos(bend)))
        for side in ("Left", "Right"):
            for key, angle in (("UpLeg", -bend), ("Leg", 2.0 * bend), ("Foot", -bend)):
                _turned(armature, names[side + key], angle, frame)
        hips = pose_of(armature).bones[names["Hips"]]
        rest = armature_data(armature).bones[hips.name].matrix_local.to_3x3()
        hips.location = rest.inverted() @ type(hips.location)((0.0, 0.0, lift - lower))
        hips.keyframe_insert("location", frame=frame)


def _turned(armature: bpy.types.Object, name: str, angle: float, frame: int) -> None:
    """Turns a bone about the world's X at rest."""
    bone = pose_of(armature).bones[name]
    rest = armature_data(armature).bones[name].matrix_local.to_3x3()
    axis = rest.inverted() @ type(bone.location)((1.0, 0.0, 0.0))
    half = 0.5 * angle
    bone.rotation_quaternion = (np.cos(half), *(np.sin(half) * np.array(axis)))
    bone.keyframe_insert("rotation_quaternion", frame=frame)
