"""Files read again by Blender's importers, for checking what is in them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from ..accessors import current_scene, present
from ..armature import fcurves, read
from ..armature.poses import frames_per_second
from .data_blocks import data_blocks, remove_added, scene_restored


def reimport(
    path: str | Path,
    frames: FloatArray,
    *,
    take: str = "",
    begins: float = 0.0,
    native: bool = False,
) -> Recording:
    """Record a file at the seconds at which the scene shows `frames` (T,); nothing of it stays.

    take: part of the name of the one to be performed, where there are several. begins: the frame
    that is 0 s in the file. native: an FBX is read by Blender's own importer, which comes with 4.5,
    and not by its add-on. `frames` of the result are as given.
    """
    scene = current_scene()
    render = scene.render
    rate = render.fps, render.fps_base
    seconds = (frames - begins) / frames_per_second(scene)
    before = data_blocks()
    with scene_restored():
        try:
            whole_rate = _import(Path(path), native=native)
            render.fps, render.fps_base = rate
            made = data_blocks() - before
            armature = next(
                o for o in made if isinstance(o, bpy.types.Object) and o.type == "ARMATURE"
            )
            if take:
                actions = (a for a in made if isinstance(a, bpy.types.Action) and take in a.name)
                fcurves.assign(armature, next(actions))
                present(armature.animation_data).use_nla = False
            at = seconds * (rate[0] if whole_rate else frames_per_second(scene))
            recording = read.record(armature, at)
        finally:
            remove_added(before)
    return dataclasses.replace(recording, frames=frames, times=seconds - seconds[0])


def _import(path: Path, *, native: bool) -> bool:
    """Import a file; whether its keys are placed by the whole number of frames a second, whatever
    the base."""
    match path.suffix:
        case ".fbx" if native:
            bpy.ops.wm.fbx_import(filepath=str(path), anim_offset=0.0)
            return False
        case ".fbx":
            bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
            return True
        case ".glb":
            scene = current_scene()
            scene.unit_settings.scale_length = 1.0  # the file's metres become units
            scene.render.fps_base = 1.0 / scene.render.fps_base  # by which Blender multiplies
            bpy.ops.import_scene.gltf(filepath=str(path))
        case _:
            current_scene().unit_settings.scale_length = 1.0
            bpy.ops.wm.usd_import(filepath=str(path), set_frame_range=False)
    return False
