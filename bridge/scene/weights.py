"""Which bone a mesh's vertices belong to."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ...solver.arrays import IntArray


def heaviest_bones(mesh: bpy.types.Mesh, vertices: IntArray, bone_of: Sequence[int]) -> IntArray:
    """(N,) the bone of the most weight at vertices (N,); -1 where none has any.

    bone_of: of each vertex group, the bone's number; -1 of one that is no bone's.
    """
    every, places = np.unique(vertices, return_inverse=True)
    owners = np.full(len(every), -1)
    for i, vertex in enumerate(every.tolist()):
        most = 0.0
        for group in mesh.vertices[vertex].groups:
            if group.weight > most and bone_of[group.group] >= 0:
                most, owners[i] = group.weight, bone_of[group.group]
    return owners[places]
