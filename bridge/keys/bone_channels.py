"""Channels of each bone that a result keys: which they are, their values, and their poses."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import armature_data, pose_of
from ..armature import fcurves
from ..armature.channels import EULER_ORDERS, proper, rotations_of
from ..armature.pose_basis import carrier_of

ROTATIONS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
EULER = "rotation_euler"


@dataclass(frozen=True)
class BoneChannels:
    """Keyed channels of a bone at T frames.

    mode: of its rotation; None where that is not keyed. moves: whether its location is keyed.
    values: (T, n), those of the rotation first. basis: (T, 4, 4), the pose basis they are taken of.
    """

    bone: str
    mode: str | None
    moves: bool
    values: FloatArray
    basis: FloatArray

    @property
    def paths(self) -> list[tuple[str, slice]]:
        """Properties of the pose bone, and the columns of `values` that are theirs."""
        width = 0 if self.mode is None else self.values.shape[1] - 3 * self.moves
        rotation = [] if self.mode is None else [(rotation_property(self.mode), slice(0, width))]
        return rotation + ([("location", slice(width, width + 3))] if self.moves else [])

    def basis_of(self, values: FloatArray) -> FloatArray:
        """Pose basis (T, 4, 4) with other values (T, n) of the keyed channels; scale stays."""
        basis = self.basis.copy()
        for path, columns in self.paths:
            if path == "location":
                basis[:, :3, 3] = values[:, columns]
            elif self.mode is not None:
                linear = self.basis[:, :3, :3]
                scale = np.swapaxes(proper(linear), 1, 2) @ linear
                mode = self.mode if self.mode in (*ROTATIONS, *EULER_ORDERS) else "XYZ"
                basis[:, :3, :3] = rotations_of(values[:, columns], mode) @ scale
        return basis


def rotation_property(mode: str) -> str:
    """Property of a pose bone that has its rotation in a rotation mode."""
    return ROTATIONS.get(mode, EULER)


def bone_channels(
    armature: bpy.types.Object,
    bones: tuple[str, ...],
    bases: dict[str, FloatArray],
    curves: fcurves.CurveHolder,
    frames: FloatArray,
) -> list[BoneChannels]:
    """Channels as curves have them at frames (T,): rotations of the bones, and the location of the
    one that carries the first of them. bases: (T, 4, 4) by bone, theirs among them."""
    carrier = carrier_of(armature_data(armature).bones[bones[0]]).name
    found = []
    for name, basis in bases.items():
        bone = pose_of(armature).bones[name]
        mode = str(bone.rotation_mode) if name in bones else None
        parts = [] if mode is None else [_sampled(bone, rotation_property(mode), curves, frames)]
        if name == carrier:
            parts.append(_sampled(bone, "location", curves, frames))
        if parts:
            values = np.concatenate(parts, axis=1)
            found.append(BoneChannels(name, mode, name == carrier, values, basis))
    return found


def _sampled(
    bone: bpy.types.PoseBone, path: str, curves: fcurves.CurveHolder, frames: FloatArray
) -> FloatArray:
    """Values (T, n) of a property; what it has where no curve animates it."""
    values = np.tile(np.array(getattr(bone, path), dtype=float), (len(frames), 1))
    for index in range(values.shape[1]):
        curve = curves.fcurves.find(bone.path_from_id(path), index=index)
        if curve is not None:
            values[:, index] = [curve.evaluate(frame) for frame in frames]
    return values
