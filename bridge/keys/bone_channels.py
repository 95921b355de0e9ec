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
EULER, SCALE = "rotation_euler", "scale"


@dataclass(frozen=True)
class BoneChannels:
    """Keyed channels of a bone at T frames.

    mode: of its rotation; None where that is not keyed. moves, sizes: whether its location and its
    scale are keyed. values: (T, n), of the rotation, location and scale. basis: (T, 4, 4), the pose
    basis they are taken of.
    """

    bone: str
    mode: str | None
    moves: bool
    values: FloatArray
    basis: FloatArray
    sizes: bool = False

    @property
    def paths(self) -> list[tuple[str, slice]]:
        """Properties of the pose bone, and the columns of `values` that are theirs."""
        width = self.values.shape[1] - 3 * (self.moves + self.sizes)
        found = [] if self.mode is None else [(rotation_property(self.mode), slice(0, width))]
        for path, keyed in (("location", self.moves), (SCALE, self.sizes)):
            if keyed:
                found.append((path, slice(width, width + 3)))
                width += 3
        return found

    def basis_of(self, values: FloatArray) -> FloatArray:
        """Pose basis (T, 4, 4) with other values (T, n) of the keyed channels."""
        basis = self.basis.copy()
        turned = proper(self.basis[:, :3, :3])
        scale = np.swapaxes(turned, 1, 2) @ self.basis[:, :3, :3]
        for path, columns in self.paths:
            if path == "location":
                basis[:, :3, 3] = values[:, columns]
            elif path == SCALE:
                scale = values[:, columns, None] * np.eye(3)
            elif self.mode is not None:
                mode = self.mode if self.mode in (*ROTATIONS, *EULER_ORDERS) else "XYZ"
                turned = rotations_of(values[:, columns], mode)
        basis[:, :3, :3] = turned @ scale
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
        if name in bones or name == carrier:
            keyed = KeyedParts(name in bones, name == carrier)
            found.append(sampled_channels(armature, name, keyed, basis, curves, frames))
    return found


@dataclass(frozen=True)
class KeyedParts:
    """Which parts of a bone's transformation are keyed."""

    turns: bool
    moves: bool
    sizes: bool = False


def sampled_channels(
    armature: bpy.types.Object,
    name: str,
    keyed: KeyedParts,
    basis: FloatArray,
    curves: fcurves.CurveHolder,
    frames: FloatArray,
) -> BoneChannels:
    """A bone's channels as curves have them at frames (T,). basis: (T, 4, 4)."""
    bone = pose_of(armature).bones[name]
    mode = str(bone.rotation_mode) if keyed.turns else None
    paths = [] if mode is None else [rotation_property(mode)]
    paths += ["location"] if keyed.moves else []
    paths += [SCALE] if keyed.sizes else []
    values = np.concatenate([_sampled(bone, path, curves, frames) for path in paths], axis=1)
    return BoneChannels(name, mode, keyed.moves, values, basis, keyed.sizes)


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
