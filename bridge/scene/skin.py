"""The meshes that an armature deforms, as points in the rest pose, each with its bone.

Points are spread evenly over the faces: neither dense nor coarse parts of a mesh count more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from enum import Enum
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.faults import NoFaces, TooManyFaces
from ...solver.data.recording import Skin
from ...solver.scene.checks import MOST_TRIANGLES
from ..accessors import armature_data, current_scene
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from .mesh import triangles_of
from .seen import Showing, seen_at
from .weights import heaviest_bones

POINTS = 20_000  # on all meshes together: a toe still has some sixty
# Steps of an evenly spread sequence in the plane (Roberts 2018, from the plastic number).
STEPS = (0.7548776662466927, 0.5698402909980532)


class Unusable(Enum):
    """Why a mesh that the armature deforms tells no shapes."""

    NO_BONE = "no vertex group is called as a bone"
    NO_FACES = "it has no faces"
    TOO_MANY = f"it has more than {MOST_TRIANGLES:,} triangles"


@dataclass(frozen=True)
class SkinReading:
    """skin: None where no mesh tells it. unusable: meshes that tell nothing, by name."""

    skin: Skin | None = None
    unusable: Mapping[str, Unusable] = field(default_factory=dict)


@dataclass(frozen=True)
class _Bound:
    """Of one mesh: points (N, 3) m, world; owners (N,) of the armature's bones; area in m²."""

    points: FloatArray
    owners: IntArray
    area: float


def skinned_meshes(armature: bpy.types.Object) -> tuple[bpy.types.Object, ...]:
    """The scene's mesh objects that an armature deforms, hidden ones too."""
    return tuple(
        each
        for each in current_scene().objects
        if each.type == "MESH"
        and (
            any(getattr(modifier, "object", None) == armature for modifier in each.modifiers)
            or (each.parent == armature and each.parent_type == "ARMATURE")
        )
    )


def read_skin(
    armature: bpy.types.Object, frames: FloatArray, showing: Showing = nullcontext
) -> Incremental[SkinReading]:
    """The skin where the armature stands at the first of frames (T,). showing: see `in_slices`."""
    meshes = skinned_meshes(armature)
    if not meshes:
        return SkinReading()
    looks = yield from in_slices(frames[:1], partial(_bound_at, armature, meshes), showing)
    found = dict(zip((mesh.name for mesh in meshes), looks[0], strict=True))
    bound = {name: each for name, each in found.items() if isinstance(each, _Bound)}
    unusable = {name: each for name, each in found.items() if isinstance(each, Unusable)}
    if not bound:
        return SkinReading(None, unusable)
    total = sum(each.area for each in bound.values())
    thinned = [_thinned(each, each.area / total) for each in bound.values()]
    points, owners = (np.concatenate(parts) for parts in zip(*thinned, strict=True))
    return SkinReading(Skin(tuple(bound), tuple(_names(armature)), points, owners), unusable)


def _names(armature: bpy.types.Object) -> list[str]:
    return [bone.name for bone in armature_data(armature).bones]


def _thinned(mesh: _Bound, share: float) -> tuple[FloatArray, IntArray]:
    """A share of a mesh's points and owners, evenly."""
    count = max(1, round(share * len(mesh.points)))
    chosen = np.linspace(0, len(mesh.points) - 1, count).astype(int)
    return mesh.points[chosen], mesh.owners[chosen]


def _bound_at(
    armature: bpy.types.Object, meshes: Sequence[bpy.types.Object], frames: FloatArray
) -> list[_Bound | Unusable]:
    """Of each mesh at the first of frames (T,), the armature in its rest pose."""
    with _at_rest(armature):
        return seen_at(meshes, frames, partial(_look, _names(armature)))[0]


@contextmanager
def _at_rest(armature: bpy.types.Object) -> Iterator[None]:
    data = armature_data(armature)
    before, data.pose_position = data.pose_position, "REST"
    try:
        yield
    finally:
        data.pose_position = before


def _look(bones: Sequence[str], evaluated: bpy.types.Object) -> _Bound | Unusable:
    index = {name: i for i, name in enumerate(bones)}
    bone_of = [index.get(group.name, -1) for group in evaluated.vertex_groups]
    if max(bone_of, default=-1) < 0:
        return Unusable.NO_BONE
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=graph)
    try:
        vertices, corners = triangles_of(mesh, evaluated.name)
        world = np.array(evaluated.matrix_world)
        placed = metres_per_unit(current_scene()) * (vertices @ world[:3, :3].T + world[:3, 3])
        triangles = placed[corners]
        sides = triangles[:, 1:] - triangles[:, :1]
        areas = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        if not areas.sum() > 0.0:
            return Unusable.NO_FACES
        chosen, shares = _spread(areas)
        points = np.einsum("nc,nci->ni", shares, triangles[chosen])
        nearest = corners[chosen, np.argmax(shares, axis=1)]
        return _Bound(points, heaviest_bones(mesh, nearest, bone_of), float(areas.sum()))
    except NoFaces:
        return Unusable.NO_FACES
    except TooManyFaces:
        return Unusable.TOO_MANY
    finally:
        evaluated.to_mesh_clear()


def _spread(areas: FloatArray) -> tuple[IntArray, FloatArray]:
    """Points evenly over triangles (F,) m²: which they are on (POINTS,), and their corners' shares
    (POINTS, 3)."""
    ends = np.cumsum(areas)
    steps = np.arange(POINTS)
    chosen = np.searchsorted(ends, (steps + 0.5) * ends[-1] / POINTS).clip(max=len(areas) - 1)
    u, v = ((0.5 + step * steps) % 1.0 for step in STEPS)
    beyond = u + v > 1.0
    u, v = np.where(beyond, 1.0 - u, u), np.where(beyond, 1.0 - v, v)
    return chosen, np.stack([1.0 - u - v, u, v], axis=1)
