"""An action as FBX, and back for checking."""

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
from ..armature import fcurves, read
from ..armature.poses import evaluated, frames_per_second


def export_fbx(armature: bpy.types.Object, action: bpy.types.Action, path: str | Path) -> None:
    """Write the armature with `action` alone, a key on every frame, as binary FBX.

    Folders are made where missing. The scene is left as it was. Raises OutputNotWritable.
    """
    target = Path(path)
    with tempfile.TemporaryDirectory() as folder, _alone(armature, action):
        made = Path(folder) / "export.fbx"
        with bpy.context.temp_override(selected_objects=[armature]):
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
        _deliver(made, target)


def export_gltf(armature: bpy.types.Object, action: bpy.types.Action, path: str | Path) -> None:
    """Write the armature with `action` alone, a key on every frame, as binary glTF.

    Folders are made where missing. The scene is left as it was. Raises OutputNotWritable.
    """
    target = Path(path)
    with (
        tempfile.TemporaryDirectory() as folder,
        _alone(armature, action),
        _selected_alone(armature),
    ):
        made = Path(folder) / "export.glb"
        bpy.ops.export_scene.gltf(
            filepath=str(made),
            export_format="GLB",
            use_selection=True,
            export_animations=True,
            export_animation_mode="ACTIVE_ACTIONS",
            export_frame_range=True,
            export_force_sampling=True,
            export_optimize_animation_size=False,
        )
        _deliver(made, target)


def _deliver(made: Path, target: Path) -> None:
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(made, target)
    except OSError as error:
        raise OutputNotWritable(str(target), error.strerror or type(error).__name__) from error


@contextmanager
def _selected_alone(armature: bpy.types.Object) -> Iterator[None]:
    """Only the armature is selected and active, which the exporter looks at; then as before."""
    layer = bpy.context.view_layer
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    for thing in selected:
        thing.select_set(False)
    armature.select_set(True)
    layer.objects.active = armature
    try:
        yield
    finally:
        armature.select_set(False)
        for thing in selected:
            thing.select_set(True)
        layer.objects.active = active


def reimport_fbx(path: str | Path, frames: FloatArray) -> Recording:
    """What an FBX file holds at the seconds at which the scene shows `frames` (T,), as a Recording.

    Read by Blender's own importer; nothing of it stays. `frames` of the result are as given.
    """
    render = bpy.context.scene.render
    seconds = frames / frames_per_second(bpy.context.scene)
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


@contextmanager
def _alone(armature: bpy.types.Object, action: bpy.types.Action) -> Iterator[None]:
    """The armature evaluated under `action` only, the scene's range that of the action."""
    scene = bpy.context.scene
    data = armature.animation_data or armature.animation_data_create()
    was, slot, nla = data.action, fcurves.slot_identifier(armature), data.use_nla
    start, end = scene.frame_start, scene.frame_end
    try:
        fcurves.assign(armature, action, slot)
        data.use_nla = False
        scene.frame_start, scene.frame_end = map(round, action.frame_range)
        with evaluated(armature):
            yield
    finally:
        scene.frame_start, scene.frame_end = start, end
        data.use_nla = nla
        fcurves.assign(armature, was, slot)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


@contextmanager
def _removed_afterwards() -> Iterator[None]:
    """Remove the objects, armatures and actions made inside; the selection comes back."""
    kinds = bpy.data.objects, bpy.data.armatures, bpy.data.actions
    before = [set(kind) for kind in kinds]
    layer = bpy.context.view_layer
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    try:
        yield
    finally:
        for kind, known in zip(kinds, before, strict=True):
            for block in set(kind) - known:
                kind.remove(block)
        layer.objects.active = active
        for thing in selected:
            thing.select_set(True)
