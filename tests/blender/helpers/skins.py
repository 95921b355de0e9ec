"""Skinned meshes made from nothing: tubes of known girth about bones."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from mathutils import Matrix, Vector

AROUND = 24
RINGS = 9


def make_skin(
    armature: bpy.types.Object,
    girths: Mapping[str, float],
    *,
    name: str = "Skin",
    groups: Mapping[str, str] | None = None,
    world: Matrix | None = None,
    longer: float = 0.0,
) -> bpy.types.Object:
    """A mesh of tubes about bones in the rest pose, bound by an Armature modifier.

    girths: radii by bones' names, m. groups: what the bones' vertex groups are called, if not as
    they are. world: of the mesh's object; the tubes are where the bones are all the same. longer:
    share of a bone by which its tube goes beyond both its ends.
    """
    mesh = bpy.data.meshes.new(name)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    made.matrix_world = Matrix() if world is None else world
    bpy.context.view_layer.update()
    to_mesh = made.matrix_world.inverted() @ armature.matrix_world
    vertices, faces, owners = list[Vector](), list[tuple[int, ...]](), list[str]()
    for bone, radius in girths.items():
        rest = armature.data.bones[bone]
        unit = armature.matrix_world.to_scale().x
        first = len(vertices)
        for along in np.linspace(-longer, 1.0 + longer, RINGS):
            for angle in np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False):
                local = Vector(
                    (
                        radius / unit * np.cos(angle),
                        along * rest.length,
                        radius / unit * np.sin(angle),
                    )
                )
                vertices.append(to_mesh @ (rest.matrix_local @ local))
                owners.append(bone)
        faces += [
            tuple(
                first + (ring + a) * AROUND + (i + b) % AROUND
                for a, b in ((0, 0), (0, 1), (1, 1), (1, 0))
            )
            for ring in range(RINGS - 1)
            for i in range(AROUND)
        ]
    mesh.from_pydata(vertices, [], faces)
    for bone in girths:
        group = made.vertex_groups.new(name=(groups or {}).get(bone, bone))
        group.add([i for i, owner in enumerate(owners) if owner == bone], 1.0, "REPLACE")
    made.modifiers.new("Armature", "ARMATURE").object = armature
    return made
