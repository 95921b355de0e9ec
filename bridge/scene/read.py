"""Solid objects of the scene as the solver's records: faces in metres, movement frame by frame.

What cannot move is looked at once; the rest at every frame, a few at a time, and the scene is
between them as the artist had it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.scene import SceneObject
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices, one_by_one
from ..armature.poses import metres_per_unit
from ..movable import may_deform, may_move
from .bone_parts import BonePart, read_bone_parts
from .members import Member
from .mesh import Triangles, read_triangles
from .rigid import rigid_movement
from .seen import Showing, seen_at, simulate

_NEAR = 1e-5  # m and of rotations' entries; less is the same place


@dataclass(frozen=True)
class SceneReading:
    """objects: as the solver takes them; what another armature bends is one for each part.
    reshaped: names of those whose shape changes otherwise while the frames pass; they have that of
    the first frame throughout."""

    objects: tuple[SceneObject, ...] = ()
    reshaped: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Piece:
    """An object, or the part of it that a bone carries, with its matrices (T, 4, 4), or one."""

    member: Member
    shape: Triangles
    matrices: FloatArray
    bone: str = ""


def read_scene(
    of: Sequence[Member], frames: FloatArray, showing: Showing = nullcontext
) -> Incremental[SceneReading]:
    """Read solid objects at frames (T,), a few frames a slice. showing: as of `in_slices`.

    Raises NoFaces, TooManyFaces.
    """
    if not of:
        return SceneReading()
    objects = [member.object for member in of]
    yield from simulate(objects, frames[-1], showing)
    first = yield from in_slices(frames[:1], partial(_shapes, objects), showing)
    shapes = first[0][0]
    matrices = yield from _matrices(objects, frames, showing)
    changed = yield from _reshaped(objects, shapes, frames, showing)
    pieces: list[_Piece] = []
    for member, shape, way in zip(of, shapes, matrices, strict=True):
        parts = yield from _parts(member, changed, frames, showing)
        changed -= {member.object} if parts else set()
        whole = () if parts else (_Piece(member, shape, way),)
        pieces += [*whole, *(_Piece(member, p.shape, p.matrices, p.bone) for p in parts)]
    found = yield from one_by_one(pieces, partial(_record, frames))
    stretched = [piece for piece, (_, stretches) in zip(pieces, found, strict=True) if stretches]
    changed.update(piece.member.object for piece in stretched)
    records = tuple(record for record, _ in found)
    return SceneReading(records, tuple(m.name for m in of if m.object in changed))


def _parts(
    member: Member, changed: set[bpy.types.Object], frames: FloatArray, showing: Showing
) -> Incremental[tuple[BonePart, ...]]:
    """The stiff parts of what changes its shape as another armature's bones move."""
    if member.bent_by is None or member.object not in changed:
        return ()
    return (yield from read_bone_parts(member.object, member.bent_by, frames, showing))


def changed_objects(before: SceneReading, now: SceneReading) -> tuple[str, ...]:
    """Names of objects that are no longer what they were, have come or have gone."""
    old, new = ({each.name: each for each in read.objects} for read in (before, now))
    changed = (
        (new.get(name) or old[name]).whole
        for name in dict.fromkeys((*old, *new))
        if name not in old or name not in new or not _same(old[name], new[name])
    )
    return tuple(dict.fromkeys(changed))


def _same(one: SceneObject, other: SceneObject) -> bool:
    if one.role is not other.role or not np.array_equal(one.triangles, other.triangles):
        return False
    pairs = (
        (one.vertices, other.vertices),
        (one.frames, other.frames),
        (one.positions, other.positions),
        (one.rotations, other.rotations),
    )
    return all(a.shape == b.shape and np.allclose(a, b, rtol=0.0, atol=_NEAR) for a, b in pairs)


def _record(frames: FloatArray, piece: _Piece) -> tuple[SceneObject, bool]:
    """A record of a piece at frames (T,), and whether its scale changes."""
    member, shape, bone = piece.member, piece.shape, piece.bone
    metres = metres_per_unit(current_scene())
    movement = rigid_movement(piece.matrices, metres)
    inside_out = np.linalg.det(movement.baked) < 0.0
    record = SceneObject(
        f"{member.name}, {bone}" if bone else member.name,
        member.role,
        vertices=metres * shape.vertices @ movement.baked.T,
        triangles=shape.corners[:, ::-1].copy() if inside_out else shape.corners,
        frames=frames if movement.moves else frames[:1],
        positions=movement.positions,
        rotations=movement.rotations,
        part_of=member.name if bone else "",
    )
    return record, movement.stretches


def _matrices(
    objects: Sequence[bpy.types.Object], frames: FloatArray, showing: Showing
) -> Incremental[list[FloatArray]]:
    """Each object's matrices (T, 4, 4); one (1, 4, 4) of an object that nothing could move."""
    still = yield from in_slices(frames[:1], partial(_worlds, objects), showing)
    matrices = [still[0][:, i] for i in range(len(objects))]
    moving = [i for i, each in enumerate(objects) if may_move(each)]
    if moving and len(frames) > 1:
        look = partial(_worlds, [objects[i] for i in moving])
        found = np.concatenate((yield from in_slices(frames, look, showing)))
        for n, i in enumerate(moving):
            matrices[i] = found[:, n]
    return matrices


def _reshaped(
    objects: Sequence[bpy.types.Object],
    first: Sequence[Triangles],
    frames: FloatArray,
    showing: Showing,
) -> Incremental[set[bpy.types.Object]]:
    """The objects that have another shape halfway or at the end."""
    soft = {each: shape for each, shape in zip(objects, first, strict=True) if may_deform(each)}
    if not soft:
        return set()
    later = np.unique(frames[[len(frames) // 2, -1]])
    found = yield from in_slices(later, partial(_shapes, list(soft)), showing)
    looks = [look for part in found for look in part]
    return {
        each
        for i, (each, shape) in enumerate(soft.items())
        if not all(shape.same_shape(look[i]) for look in looks)
    }


def _worlds(objects: Sequence[bpy.types.Object], frames: FloatArray) -> FloatArray:
    """(T, N, 4, 4) matrices of N objects, Blender units."""
    return np.array(seen_at(objects, frames, lambda seen: np.array(seen.matrix_world, float)))


def _shapes(objects: Sequence[bpy.types.Object], frames: FloatArray) -> list[list[Triangles]]:
    """Shapes of objects, by frame."""
    return seen_at(objects, frames, read_triangles)
