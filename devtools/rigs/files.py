"""A result written to files and read again, as another program would get it."""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy
import numpy as np

from ...bridge.accessors import current_action, present
from ...bridge.files.export import export_fbx, export_gltf, reimport_fbx, reimport_gltf
from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from ...solver.numerics.rotations import rotation_vector
from .result import FileResult

FORMATS = {"FBX": (".fbx", export_fbx, reimport_fbx), "glTF": (".glb", export_gltf, reimport_gltf)}


def round_trips(armature: bpy.types.Object, shown: Recording) -> tuple[FileResult, ...]:
    """What each format loses of the action that the armature shows. Raises OutputNotWritable."""
    action, found = present(current_action(armature)), []
    for name, (extension, export, reimport) in FORMATS.items():
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"result{extension}"
            export(armature, action, path)
            again = reimport(path, shown.frames)
        columns = [again.index(bone.name) for bone in shown.bones]
        off = np.linalg.norm(again.heads[:, columns] - shown.heads, axis=2).max()
        apart = _turns(shown.rotations), _turns(again.rotations[:, columns])
        turn = rotation_vector((np.swapaxes(apart[0], -1, -2) @ apart[1]).reshape(-1, 3, 3))
        angle = np.degrees(np.linalg.norm(turn, axis=1).max())
        found.append(FileResult(name, 1e3 * float(off), float(angle)))
    return tuple(found)


def _turns(rotations: FloatArray) -> FloatArray:
    """(T, B, 3, 3) turns in the world since the first frame: a format may turn bones' own axes."""
    return np.asarray(rotations @ np.swapaxes(rotations[:1], -1, -2))
