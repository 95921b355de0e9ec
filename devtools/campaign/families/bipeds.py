"""Figures with two arms and two legs, of random proportions and names, that crouch and hop."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

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
# Names by the first convention and by the figure's own, the first one's parent, and the joints.
Chain = tuple[tuple[str, ...], tuple[str, ...], str, list[tuple[float, float, float]]]
GRAVITY = 9.8
CROUCH = 0.9  # rad, of the thighs at the deepest
STEP = 2  # frames between keys


@dataclass(frozen=True)
class Proportions:
    """Lengths, m: of thigh and shank each, of the ankle's height, of foot, trunk, and upper arm,
    forearm and hand each."""

    leg: float
    ankle: float
    foot: float
    trunk: float
    arm: float

    @staticmethod
    def drawn(rng: np.random.Generator) -> Proportions:
        ranges = ((0.3, 0.55), (0.04, 0.1), (0.12, 0.25), (0.4, 0.7), (0.2, 0.35))
        return Proportions(*(float(rng.uniform(*each)) for each in ranges))


def hopping_biped(case: HostileCase) -> bpy.types.Object:
    """Looks along -Y and stands on the floor at 0, as most do in Blender."""
    armature = bpy.data.objects.new("Biped", bpy.data.armatures.new("Biped"))
    present(bpy.context.collection).objects.link(armature)
    present(bpy.context.view_layer).objects.active = armature
    size = Proportions.drawn(case.rng)
    names = _built(case, armature, _chains(size, int(case.rng.integers(len(TRUNK)))))
    _hop(case, armature, names, size.leg)
    return armature


def _chains(size: Proportions, convention: int) -> Iterator[Chain]:
    hips = size.ankle + 2.0 * size.leg
    top = hips + size.trunk
    heights = (hips, hips + 0.12, top, top + 0.22)
    yield TRUNK[0], TRUNK[convention], "", [(0.0, 0.0, height) for height in heights]
    for side, x in (("Left", 1.0), ("Right", -1.0)):
        keys, names = (
            tuple(name.format(side, side[0].lower()) for name in LIMBS[which])
            for which in (0, convention)
        )
        arm = [(x * (0.18 + size.arm * i), 0.0, top - 0.05) for i in range(4)]
        yield keys[:3], names[:3], "Spine", arm
        leg = [(0.1 * x, 0.0, size.ankle + size.leg * i) for i in (2, 1, 0)]
        yield keys[3:], names[3:], "Hips", [*leg, (0.1 * x, -size.foot, 0.02)]


def _built(
    case: HostileCase, armature: bpy.types.Object, chains: Iterable[Chain]
) -> dict[str, str]:
    """Makes the bones; their names by the first convention's."""
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature_data(armature).edit_bones
    names: dict[str, str] = {}
    for keys, called, on, points in chains:
        for key, name, head, tail in zip(keys, called, points, points[1:], strict=False):
            made = bones.new(name)
            made.head, made.tail = head, tail
            made.roll = float(case.rng.uniform(-0.5, 0.5)) if case.chance(0.3) else 0.0
            made.parent = bones[names[on]] if on else None
            names[key], on = made.name, key
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
