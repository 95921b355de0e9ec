"""What game engines want of a file.

Unreal counts in centimetres, has Z up and takes the armature for one more bone above the root,
unless it is called "Armature"; it wants one root. Unity reads an FBX's unit and axes from its
header, but puts what is left of them on the topmost object: turns by -90° and scales of 100, from
which the file must be free. Godot recommends glTF and repeats takes whose name ends with "-loop".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import axis_rotation
from ..armature.poses import metres_per_unit
from ..recipe.export import ExportOptions
from ..rows.choices import Engine, FileFormat

ENDINGS: Mapping[FileFormat, str] = MappingProxyType(
    {FileFormat.FBX: ".fbx", FileFormat.GLTF: ".glb", FileFormat.USD: ".usda"}
)
_CM = 100.0  # in a metre


@dataclass(frozen=True)
class Convention:
    """How a file is written for an engine.

    format: that it reads best. y_up: of an FBX; otherwise it has Blender's axes. centimetres: what
    an FBX counts in; otherwise it is the scene's unit, which its header tells. clean: the object
    has no transformation in the file, only bones that deform are written, and takes begin at 0 s.
    object: its name; None is as in the scene. one_root: a bone above all others is needed. loop:
    end of a loop's name.
    """

    format: FileFormat = FileFormat.FBX
    y_up: bool = True
    centimetres: bool = False
    clean: bool = True
    object: str | None = None
    one_root: bool = False
    loop: str = ""

    def space(self, form: FileFormat, scene: bpy.types.Scene) -> FloatArray:
        """(4, 4) from Blender's world to the coordinates that bones have in a clean file."""
        to_file = np.eye(4)
        metres = metres_per_unit(scene)
        if form is FileFormat.FBX:
            turn = axis_rotation(0, -np.pi / 2.0) if self.y_up else np.eye(3)
            to_file[:3, :3] = turn * (_CM * metres if self.centimetres else 1.0)
        else:  # lengths are metres; Blender writes its units
            to_file[:3, :3] *= metres
        return to_file


CONVENTIONS: Mapping[Engine, Convention] = MappingProxyType(
    {
        Engine.NONE: Convention(centimetres=True, clean=False),
        Engine.UNREAL: Convention(y_up=False, centimetres=True, object="Armature", one_root=True),
        Engine.UNITY: Convention(),
        Engine.GODOT: Convention(FileFormat.GLTF, loop="-loop"),
    }
)


def format_of(options: ExportOptions) -> FileFormat:
    """The format that is chosen, else the one that the engine reads best."""
    return options.format or CONVENTIONS[options.engine].format
