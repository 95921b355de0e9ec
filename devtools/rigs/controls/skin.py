"""A skin for a rig: a tube about each bone that deforms, weighted to it, and at its head to the
bone that ends there too."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise

import bpy
import numpy as np

from ....bridge.accessors import armature_data, current_scene, present
from ....solver.arrays import FloatArray
from ....solver.body.anatomy import Part

# m; about a person's.
RADII = {
    Part.PELVIS: 0.12,
    Part.SPINE: 0.12,
    Part.NECK: 0.05,
    Part.HEAD: 0.08,
    Part.CLAVICLE: 0.05,
    Part.UPPER_ARM: 0.045,
    Part.FOREARM: 0.035,
    Part.HAND: 0.03,
    Part.THIGH: 0.07,
    Part.SHANK: 0.05,
    Part.FOOT: 0.035,
    Part.TOE: 0.03,
}
SHARES = (0.0, 0.5, 1.0)  # of a bone's length, at which a tube has rings
OWN = 1  # the ring that is weighted to the bone alone
AROUND = 8
NEAR = 0.01  # m; the tail of the bone above is no farther from a head


def add_skin(rig: bpy.types.Object, parts: Mapping[str, Part]) -> bpy.types.Object:
    """The skin, as a child of the rig. parts: of the bones that deform, by name."""
    bones = armature_data(rig).bones
    skin = bpy.data.objects.new("Skin", _tubes(bones, parts))
    skin.parent = rig
    present(current_scene().collection).objects.link(skin)
    for name in parts:
        skin.vertex_groups.new(name=name)
    for i, name in enumerate(parts):
        first, *others = (_vertices(i, ring) for ring in range(len(SHARES)))
        above = _ending_at(bones[name], parts, bones)
        if above is not None:
            skin.vertex_groups[above].add(first, 0.5, "REPLACE")
        skin.vertex_groups[name].add(first, 1.0 if above is None else 0.5, "REPLACE")
        for ring in others:
            skin.vertex_groups[name].add(ring, 1.0, "REPLACE")
    modifier = skin.modifiers.new("Armature", "ARMATURE")
    assert isinstance(modifier, bpy.types.ArmatureModifier)
    modifier.object = rig
    return skin


def _tubes(bones: bpy.types.ArmatureBones, parts: Mapping[str, Part]) -> bpy.types.Mesh:
    """A tube about each bone, its rings in turn."""
    points = [
        _ring(bones[name], share, RADII[part]) for name, part in parts.items() for share in SHARES
    ]
    faces = []
    for i in range(len(parts)):
        for lower, upper in pairwise(_vertices(i, ring) for ring in range(len(SHARES))):
            following = [*range(1, AROUND), 0]
            faces += [(lower[k], lower[n], upper[n], upper[k]) for k, n in enumerate(following)]
    mesh = bpy.data.meshes.new("Skin")
    mesh.from_pydata(np.concatenate(points).tolist(), [], faces)
    return mesh


def own_vertices(skin: bpy.types.Object, bone: str) -> list[int]:
    """The vertices that a bone alone moves."""
    return _vertices(skin.vertex_groups[bone].index, OWN)


def skin_at(
    skin: bpy.types.Object, frames: FloatArray, pose: Callable[[int], None] | None = None
) -> FloatArray:
    """(T, V, 3) m, where Blender has the skin's vertices at frames (T,); world.

    pose: poses what moves it, by the frame's index, where keys do not.
    """
    assert isinstance(skin.data, bpy.types.Mesh)
    found = np.empty((len(frames), len(skin.data.vertices), 3))
    for t, frame in enumerate(frames):
        current_scene().frame_set(int(frame))
        if pose is not None:
            pose(t)
            present(bpy.context.view_layer).update()
        shown = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
        flat = np.empty(found[t].size)
        mesh = shown.to_mesh()
        mesh.vertices.foreach_get("co", flat)
        world = np.array(shown.matrix_world)
        found[t] = flat.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3]
        shown.to_mesh_clear()
    return found


def _ring(bone: bpy.types.Bone, share: float, radius: float) -> FloatArray:
    """(AROUND, 3) about a bone at rest."""
    rest = np.array(bone.matrix_local)
    angles = 2.0 * np.pi * np.arange(AROUND) / AROUND
    around = np.stack(
        [radius * np.cos(angles), np.full(AROUND, share * bone.length), radius * np.sin(angles)],
        axis=1,
    )
    return np.asarray(around @ rest[:3, :3].T + rest[:3, 3])


def _vertices(bone: int, ring: int) -> list[int]:
    first = (bone * len(SHARES) + ring) * AROUND
    return list(range(first, first + AROUND))


def _ending_at(
    bone: bpy.types.Bone, parts: Mapping[str, Part], bones: bpy.types.ArmatureBones
) -> str | None:
    """The bone, of those that deform, that ends where a bone begins."""
    others = [name for name in parts if name != bone.name]
    nearest = min(others, key=lambda name: (bones[name].tail_local - bone.head_local).length)
    near = (bones[nearest].tail_local - bone.head_local).length < NEAR
    return nearest if near else None
