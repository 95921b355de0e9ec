"""What importers and exporters leave behind, and change, so that it can be undone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..accessors import current_scene, present


def data_blocks() -> set[bpy.types.ID]:
    """Objects, armatures, actions, meshes, materials and images of the open file."""
    data = bpy.data
    kinds = (data.objects, data.armatures, data.actions, data.meshes, data.materials, data.images)
    return {block for kind in kinds for block in kind}


def remove_added(before: set[bpy.types.ID]) -> None:
    """Remove what is not in `before`, an earlier `data_blocks()`."""
    bpy.data.batch_remove(data_blocks() - before)


@contextmanager
def scene_restored() -> Iterator[None]:
    """Context with nothing selected and in object mode; selection, mode and the scene's range,
    frame, rate and unit come back.

    What was removed inside is not looked at: Blender 4.2 crashes over it.
    """
    layer, scene = present(bpy.context.view_layer), current_scene()
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    mode = active.mode if active is not None else "OBJECT"
    shown = scene.frame_current, scene.frame_subframe
    start, end = scene.frame_start, scene.frame_end
    rate, units = (scene.render.fps, scene.render.fps_base), scene.unit_settings
    length = units.scale_length
    if mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for thing in selected:
        thing.select_set(False)
    try:
        yield
    finally:
        scene.frame_start, scene.frame_end = start, end
        scene.render.fps, scene.render.fps_base = rate
        units.scale_length = length
        scene.frame_set(shown[0], subframe=shown[1])
        for thing in selected:
            thing.select_set(True)
        layer.objects.active = active
        if mode != "OBJECT":
            bpy.ops.object.mode_set(mode=mode)
