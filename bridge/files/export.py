"""Export of an action as FBX or glTF; re-import of either for checking."""

from __future__ import annotations

import dataclasses
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.faults import OutputNotWritable
from ...solver.data.recording import Recording
from ..accessors import current_scene, present
from ..armature import fcurves, read
from ..armature.poses import evaluated, frames_per_second
from .data_blocks import data_blocks, remove_added


def export_fbx(armature: bpy.types.Object, action: bpy.types.Action, path: str | Path) -> None:
    """Write the armature with `action` alone, a key on every frame, as binary FBX.

    Folders are made where missing. The scene is left as it was. Raises OutputNotWritable.
    """
    with (
        _delivered("export.fbx", Path(path)) as made,
        _alone(armature, action),
        bpy.context.temp_override(selected_objects=[armature]),
    ):
        bpy.ops.export_scene.fbx(
            filepath=str(made),
            use_selection=True,
            object_types={"ARMATURE"},
            add_leaf_bones=False,
            bake_anim=True,
            bake_anim_use_all_bones=True,
            bake_anim_use_nla_strips=False,
            bake_anim_use_all_actions=False,
            bake_anim_force_startend_keying=True,
            bake_anim_simplify_factor=0.0,
        )


def export_gltf(armature: bpy.types.Object, action: bpy.types.Action, path: str | Path) -> None:
    """Write the armature with `action` alone, a key on every frame, as binary glTF.

    Folders are made where missing. The scene is left as it was. Raises OutputNotWritable.
    """
    with (
        _delivered("export.glb", Path(path)) as made,
        _alone(armature, action),
        _selected_alone(armature),
    ):
        bpy.ops.export_scene.gltf(
            filepath=str(made),
            export_format="GLB",
            use_selection=True,
            export_animations=True,
            export_animation_mode="ACTIVE_ACTIONS",
            export_nla_strips_merged_animation_name=action.name,  # else it is "Animation"
            export_anim_single_armature=False,  # else 4.2 merges all actions that fit into one
            export_frame_range=True,
            export_force_sampling=True,
            export_optimize_animation_size=False,
        )


@contextmanager
def _delivered(name: str, target: Path) -> Iterator[Path]:
    """Context in which a file is made in a folder of its own, and then put in its place."""
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / name
        yield made
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(made, target)
        except OSError as error:
            raise OutputNotWritable(str(target), error.strerror or type(error).__name__) from error


@contextmanager
def _selection_restored() -> Iterator[list[bpy.types.Object]]:
    """Context with the selected objects, after which these are selected, and what was active is.

    What was removed inside is not looked at: Blender 4.2 crashes over it.
    """
    layer = present(bpy.context.view_layer)
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    try:
        yield selected
    finally:
        for thing in selected:
            thing.select_set(True)
        layer.objects.active = active


@contextmanager
def _selected_alone(armature: bpy.types.Object) -> Iterator[None]:
    """Context in which only the armature is selected, and active, as the exporter wants it."""
    with _selection_restored() as selected:
        for thing in selected:
            thing.select_set(False)
        armature.select_set(True)
        present(bpy.context.view_layer).objects.active = armature
        try:
            yield
        finally:
            armature.select_set(False)


def reimport_fbx(path: str | Path, frames: FloatArray) -> Recording:
    """Record an FBX file at the seconds at which the scene shows `frames` (T,).

    Read by Blender's own importer; nothing of it stays. `frames` of the result are as given.
    """
    scene = current_scene()
    render = scene.render
    seconds = frames / frames_per_second(scene)
    rate = render.fps, render.fps_base
    with _removed_afterwards():
        before = set(bpy.data.objects)
        bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
        # The importer places keys by the whole number of frames per second, whatever the base.
        imported_frames = seconds * render.fps
        render.fps, render.fps_base = rate
        armature = next(o for o in set(bpy.data.objects) - before if o.type == "ARMATURE")
        recording = read.record(armature, imported_frames)
    return dataclasses.replace(recording, frames=frames, times=seconds - seconds[0])


def reimport_gltf(path: str | Path, frames: FloatArray) -> Recording:
    """Record a glTF file as `reimport_fbx` does an FBX file."""
    scene = current_scene()
    seconds = frames / frames_per_second(scene)
    with _removed_afterwards():
        before = set(bpy.data.objects)
        bpy.ops.import_scene.gltf(filepath=str(path))
        armature = next(o for o in set(bpy.data.objects) - before if o.type == "ARMATURE")
        recording = read.record(armature, seconds * frames_per_second(scene))
    return dataclasses.replace(recording, frames=frames, times=seconds - seconds[0])


@contextmanager
def _alone(armature: bpy.types.Object, action: bpy.types.Action) -> Iterator[None]:
    """Context in which the armature performs `action` alone, in the scene's whole range."""
    scene = current_scene()
    data = armature.animation_data or armature.animation_data_create()
    was, slot, nla = data.action, fcurves.slot_identifier(armature), data.use_nla
    start, end = scene.frame_start, scene.frame_end
    try:
        fcurves.assign(armature, action, slot)
        data.use_nla = False
        first, last = action.frame_range[0], action.frame_range[1]
        scene.frame_start, scene.frame_end = round(first), round(last)
        with evaluated([armature]):
            yield
    finally:
        scene.frame_start, scene.frame_end = start, end
        data.use_nla = nla
        fcurves.assign(armature, was, slot)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


@contextmanager
def _removed_afterwards() -> Iterator[None]:
    """Context that removes the data-blocks made inside; the selection comes back."""
    before = data_blocks()
    with _selection_restored():
        try:
            yield
        finally:
            remove_added(before)
