"""A result written to files for every engine and read again, as another program would get it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import bpy
import numpy as np

from ...bridge.accessors import current_action, present
from ...bridge.exports.engines import ENDINGS
from ...bridge.exports.export import export_takes
from ...bridge.exports.writers import usd_name
from ...bridge.files.reimport import reimport
from ...bridge.recipe.export import ExportOptions
from ...bridge.rows.choices import Engine, FileFormat
from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from ...solver.numerics.rotations import rotation_vector
from .result import FileResult

NATIVE = bpy.app.version >= (4, 5)  # from which on Blender has an importer of FBX beside the add-on


@dataclass(frozen=True)
class Way:
    """A file's engine, format and importer."""

    engine: Engine
    format: FileFormat
    native: bool = False

    @property
    def name(self) -> str:
        importer = ", native importer" if self.native else ""
        return f"{self.format.name} for {self.engine.name.capitalize()}{importer}"


def round_trips(armature: bpy.types.Object, shown: Recording) -> tuple[FileResult, ...]:
    """What each way loses of the action that the armature shows. Raises OutputNotWritable."""
    action, found = present(current_action(armature)), []
    with tempfile.TemporaryDirectory() as folder:
        for way in ways():
            path = Path(folder) / f"result{ENDINGS[way.format]}"
            if not way.native:
                export_takes(armature, [action], path, ExportOptions(way.engine, way.format))
            begins = 0.0 if way.engine is Engine.NONE else round(action.frame_range[0])
            again = reimport(path, shown.frames, begins=begins, native=way.native)
            found.append(FileResult(way.name, *lost(shown, again, way.format)))
    return tuple(found)


def ways() -> Iterator[Way]:
    """Every engine, format and importer of this Blender."""
    for engine, form in product(Engine, FileFormat):
        yield Way(engine, form)
        if form is FileFormat.FBX and NATIVE:
            yield Way(engine, form, native=True)


def lost(shown: Recording, again: Recording, form: FileFormat) -> tuple[float, float]:
    """Largest difference of a bone's place, mm, and of its turn, degrees."""
    usd = form is FileFormat.USD
    columns = [again.index(usd_name(bone.name) if usd else bone.name) for bone in shown.bones]
    off = np.linalg.norm(again.heads[:, columns] - shown.heads, axis=2).max()
    rotations = shown.rotations, again.rotations[:, columns]
    if form is FileFormat.GLTF:  # which has no rest pose of bones' own axes
        rotations = _turns(rotations[0]), _turns(rotations[1])
    turn = np.swapaxes(rotations[0], -1, -2) @ rotations[1]
    angles = np.linalg.norm(rotation_vector(turn.reshape(-1, 3, 3)), axis=1)
    return 1e3 * float(off), float(np.degrees(angles.max()))


def _turns(rotations: FloatArray) -> FloatArray:
    """(T, B, 3, 3) turns in the world since the first frame."""
    return np.asarray(rotations @ np.swapaxes(rotations[:1], -1, -2))
