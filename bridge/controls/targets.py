"""Where a track's bodies should be, in the armature's space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ...solver.skeleton.tree import tree_of
from ..accessors import current_scene
from ..armature.channels import proper
from ..armature.poses import Poses, metres_per_unit
from ..armature.read import rest_bones
from .posing import Posed


@dataclass(frozen=True)
class Targets:
    """Poses of bodies (B) at T frames, in the armature's space and units.

    unit: (T,) m in a unit of the armature.
    """

    frames: FloatArray
    bodies: tuple[str, ...]
    rotations: FloatArray
    heads: FloatArray
    unit: FloatArray


def targets_of(armature: bpy.types.Object, poses: Poses, track: PoseTrack) -> Targets:
    """Targets of a track, whose bodies hang together as they do in poses at the same frames."""
    metres = metres_per_unit(current_scene())
    world = poses.object_to_world
    columns = [poses.bones.index(bone) for bone in track.bones]
    recorded = world[:, None] @ poses.matrices[:, columns]
    parents = parents_of(armature, poses, track.bones)
    heads = _heads(parents, track, proper(recorded[..., :3, :3]), recorded[..., :3, 3])
    linear = world[:, :3, :3]
    apart = heads - world[:, None, :3, 3]
    return Targets(
        track.frames,
        track.bones,
        np.swapaxes(proper(linear), 1, 2)[:, None] @ track.rotations,
        np.einsum("tij,tbj->tbi", np.linalg.inv(linear), apart),
        metres * np.cbrt(np.abs(np.linalg.det(linear))),
    )


def _heads(
    parents: list[int],
    track: PoseTrack,
    turned: FloatArray,
    placed: FloatArray,
) -> FloatArray:
    """(T, B, 3) heads, world, Blender units; each where it mostly is on the body above."""
    heads = np.empty_like(placed)
    heads[:, 0] = track.root_head / metres_per_unit(current_scene())
    for b, parent in enumerate(parents):
        if parent >= 0:
            apart = placed[:, b] - placed[:, parent]
            offset = np.median(np.einsum("tji,tj->ti", turned[:, parent], apart), axis=0)
            heads[:, b] = heads[:, parent] + track.rotations[:, parent] @ offset
    return heads


def parents_of(armature: bpy.types.Object, poses: Poses, bodies: Sequence[str]) -> list[int]:
    """Index of the body above each, -1 for the first."""
    tree = tree_of(rest_bones(armature, poses))
    names = [bone.name for bone in tree.bones]
    found = []
    for name in bodies:
        line = [names[i] for i in tree.ancestors(names.index(name))[1:]]
        found.append(next((bodies.index(above) for above in line if above in bodies), -1))
    return found


def move_of_pelvis(posed: Posed, targets: Targets, t: int) -> FloatArray:
    """(4, 4), by which the first body, the pelvis, comes from where it is posed to where it should
    be at the frame of index t."""
    was, move = posed.bodies[0], np.eye(4)
    turn = targets.rotations[t, 0] @ proper(was[:3, :3]).T
    move[:3, :3], move[:3, 3] = turn, targets.heads[t, 0] - turn @ was[:3, 3]
    return move


def moved_bases(posed: Posed, move: FloatArray) -> FloatArray:
    """Pose bases (C, 4, 4) of controls that a move (4, 4) takes along, if no other moves them."""
    moved = move @ posed.controls
    bases = np.linalg.solve(posed.frames, moved)
    bases[:, :, 3:] = np.linalg.solve(posed.places, moved[:, :, 3:])
    return np.asarray(bases)
