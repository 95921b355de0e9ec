"""Joints that hold their places in the body above, as a solution's do and a recording's may not:
bones between two bodies move them, and scale and location of the bodies' own bones."""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..accessors import armature_data, current_scene
from .channels import proper
from .pose_basis import basis_under
from .poses import Poses, metres_per_unit

MOVES = 1e-4  # m; a joint that moves by less holds its place


def steady_bases(
    armature: bpy.types.Object,
    poses: Poses,
    bodies: tuple[str, ...],
    told: IntArray | slice = slice(None),
    shares: FloatArray | None = None,
) -> dict[str, FloatArray]:
    """Bases (T, 4, 4) with which joints hold their places, of bones whose own ones move them.

    The median of each such bone's turn, location and scale, of which the solver's body, whose
    joints are at the median, is made. bodies: the pelvis first. told: which of the poses (T) count
    for it. shares: (T,) from 0, as the bone was, to 1; all 1 without.
    """
    share = np.ones(len(poses.matrices)) if shares is None else shares
    found = {}
    for name in sorted(_moving(armature, poses, bodies)):
        basis = _basis(armature, poses, name)
        found[name] = _towards(basis, _median(basis[told]), share)
    return found


def _moving(armature: bpy.types.Object, poses: Poses, bodies: tuple[str, ...]) -> set[str]:
    """Bodies that move in the body above, and bones between; those of either that change size,
    which what hangs on them inherits."""
    rest, units = armature_data(armature).bones, metres_per_unit(current_scene())
    size = units * float(np.cbrt(abs(np.linalg.det(poses.object_to_world[0, :3, :3]))))
    found, seen = set[str](), set(bodies)
    for name in bodies:
        line = [each.name for each in rest[name].parent_recursive]
        above = next((i for i, each in enumerate(line) if each in bodies), None)
        if above is None:
            continue
        own, body = (poses.matrices[:, poses.bones.index(each)] for each in (name, line[above]))
        place = np.linalg.solve(body, own[..., 3:])[:, :3, 0]
        if size * np.ptp(place, axis=0).max() > MOVES:
            found.update((name, *line[:above]))
        seen.update(line[:above])
    for name in seen - found:
        _, stretch = _turns_and_stretches(_basis(armature, poses, name))
        if size * rest[name].length * np.ptp(stretch, axis=0).max() > MOVES:
            found.add(name)
    return found


def _basis(armature: bpy.types.Object, poses: Poses, name: str) -> FloatArray:
    """(T, 4, 4) the channels of a bone in these poses."""
    bone = armature_data(armature).bones[name]
    own = poses.matrices[:, poses.bones.index(name)]
    above = None if bone.parent is None else poses.matrices[:, poses.bones.index(bone.parent.name)]
    return basis_under(bone, above, own)


def _turns_and_stretches(bases: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotations and what they are applied to, (..., 3, 3) both, of bases (..., 4, 4)."""
    turns = proper(bases[..., :3, :3])
    return turns, np.swapaxes(turns, -1, -2) @ bases[..., :3, :3]


def _median(bases: FloatArray) -> FloatArray:
    """(4, 4) of bases (T, 4, 4)."""
    turns, stretches = _turns_and_stretches(bases)
    away = np.median(rotation_vector(turns[0].T @ turns), axis=0)
    result: FloatArray = np.median(bases, axis=0)
    result[:3, :3] = turns[0] @ rotation_matrix(away) @ np.median(stretches, axis=0)
    return result


def _towards(bases: FloatArray, steady: FloatArray, shares: FloatArray) -> FloatArray:
    """Bases (T, 4, 4) moved by shares (T,) of the way to another one (4, 4)."""
    (turns, stretches), (turn, stretch) = map(_turns_and_stretches, (bases, steady))
    share = shares[:, None, None]
    away = rotation_vector(np.swapaxes(turns, 1, 2) @ turn)
    result: FloatArray = bases + share * (steady - bases)
    stretched = stretches + share * (stretch - stretches)
    result[:, :3, :3] = turns @ rotation_matrix(share[..., 0] * away) @ stretched
    return result
