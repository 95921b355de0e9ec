"""Data-blocks that importers make, so that they can be removed again."""

import bpy


def data_blocks() -> set[bpy.types.ID]:
    """Objects, armatures, actions, meshes, materials and images of the open file."""
    data = bpy.data
    kinds = (data.objects, data.armatures, data.actions, data.meshes, data.materials, data.images)
    return {block for kind in kinds for block in kind}


def remove_added(before: set[bpy.types.ID]) -> None:
    """Remove what is not in `before`, an earlier `data_blocks()`."""
    bpy.data.batch_remove(data_blocks() - before)
