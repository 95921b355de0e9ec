"""Joints that hold their places in the body above, as a solution's do and a recording's may not:
bones between two bodies move them, and scale and location of the bodies' own bones."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..accessors import armature_data, current_scene
from .channels import proper
from .incremental import Incremental, sample_incrementally
from .pose_basis import basis_under
from .poses import Poses, metres_per_unit

MOVES = 1e-4  # m; a joint that moves by less holds its place
EVEN = 1e-3  # share by which scales that are the same may differ


def steady_bases(
    armature: bpy.types.Object,
    poses: Poses,
    bodies: tuple[str, ...],
    recorded: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
    shares: FloatArray | None = None,
) -> Incremental[dict[str, FloatArray]]:
    """Bases (T, 4, 4) with which joints hold their places, of bones that move them in poses.

    The median over the recording of each such bone's turn, location and scale: the solver's body,
    whose joints are at the median, is made of the same frames. bodies: the pelvis first. recorded:
    the recording's frames, and showing: lets the armature perform it. shares: (T,) from 0, as in
    the poses, to 1; all 1 without.
    """
    moving = sorted(_moving(armature, poses, bodies))
    if not moving:
        return {}
    told = yield from sample_incrementally(armature, recorded, showing)
    share = np.ones(len(poses.matrices)) if shares is None else shares
    return {
        name: _towards(_basis(armature, poses, name), _median(_basis(armature, told, name)), share)
        for name in moving
    }


def unsteady_scales(armature: bpy.types.Object, poses: Poses, bone: str) -> list[str]:
    """What changes a bone's length, or where its ends are, by its scale: the armature where that is
    not the same in all poses, and bones from the uppermost to this one where it is not the same
    along all axes, too."""
    rest = armature_data(armature).bones[bone]
    line = [each.name for each in reversed((rest, *rest.parent_recursive))]
    bases = {name: _basis(armature, poses, name) for name in line}
    sizes = np.cbrt(np.abs(np.linalg.det(poses.object_to_world[:, :3, :3])))
    found = [armature.name] if np.ptp(sizes) > EVEN * sizes.mean() else []
    for name, basis in bases.items():
        stretch = _turns_and_stretches(basis)[1]
        if np.ptp(np.diagonal(stretch, axis1=1, axis2=2)) > EVEN:
            found.append(name)
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
