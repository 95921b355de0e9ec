"""What importers and exporters leave behind, and change, so that it can be undone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

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


@dataclass(frozen=True)
class SceneState:
    """Selection and mode, and the scene's range, frame, rate and unit."""

    selected: tuple[bpy.types.Object, ...]
    active: bpy.types.Object | None
    mode: Any  # one of Blender's words, which the stubs spell out
    shown: tuple[int, float]
    frames: tuple[int, int]
    rate: tuple[int, float]
    unit: float

    @staticmethod
    def now() -> SceneState:
        """As they are."""
        layer, scene = present(bpy.context.view_layer), current_scene()
        active = layer.objects.active
        return SceneState(
            tuple(o for o in layer.objects if o.select_get()),
            active,
            active.mode if active is not None else "OBJECT",
            (scene.frame_current, scene.frame_subframe),
            (scene.frame_start, scene.frame_end),
            (scene.render.fps, scene.render.fps_base),
            scene.unit_settings.scale_length,
        )

    def restore(self) -> None:
        """Has them be as they were; what is selected beside is let be."""
        layer, scene = present(bpy.context.view_layer), current_scene()
        scene.frame_start, scene.frame_end = self.frames
        scene.render.fps, scene.render.fps_base = self.rate
        scene.unit_settings.scale_length = self.unit
        scene.frame_set(self.shown[0], subframe=self.shown[1])
        for thing in self.selected:
            thing.select_set(True)
        layer.objects.active = self.active
        if bpy.context.mode == "OBJECT" != self.mode:
            bpy.ops.object.mode_set(mode=self.mode)


@contextmanager
def scene_restored() -> Iterator[None]:
    """Context with nothing selected and in object mode; the scene's state comes back.

    What was removed inside is not looked at: Blender 4.2 crashes over it.
    """
    state = SceneState.now()
    if state.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for thing in state.selected:
        thing.select_set(False)
    try:
        yield
    finally:
        state.restore()
