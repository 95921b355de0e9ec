"""FBX files, damaged: imported into Blender and analysed, or the fault is named."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import bpy

from ....bridge.accessors import present
from ....bridge.files.import_clip import import_clip
from ....bridge.properties.settings import settings_of
from ....solver.data.faults import Fault
from ...recordings import HELD
from ..protocol.blender_file import MARK, View, empty_file, marked, must_be_same
from ..protocol.case import Changed, Family, HostileCase
from ..protocol.damage import damaged_bytes
from ..protocol.fbx_tree import damaged_tree
from .rigs import analysed

OPERATORS: Any = bpy.ops  # of which the stubs do not know all
NATIVE = 4, 5, 0  # the first Blender with an importer beside the add-on's
SOURCE = HELD / "09_11_cmu.fbx"
HEAD = 3000  # bytes of the file in which half of the damage is, where its records begin
FRAMES = 1, 60


def by_bytes(case: HostileCase) -> None:
    """Bytes flipped, taken out, put in or moved."""
    data = SOURCE.read_bytes()
    first = case.pick((HEAD, len(data)))
    _imported(case, damaged_bytes(case, data[:first]) + data[first:])


def by_meaning(case: HostileCase) -> None:
    """Values, names, connections and nodes of its tree."""
    damaged_tree(case, SOURCE, case.folder / "tree.fbx")
    _imported(case, (case.folder / "tree.fbx").read_bytes())


def _imported(case: HostileCase, data: bytes) -> None:
    """Beside an artist's object, which stays as it was."""
    path = case.folder / "clip.fbx"
    path.write_bytes(data)
    empty_file()
    _artists_object()
    before, view = marked(), View.now()
    if bpy.app.version >= NATIVE and case.chance(0.3):
        _by_the_artist(case, path)
        must_be_same(before, marked())
        return
    try:
        armature = import_clip(path).armature
    except Fault as fault:
        if View.now() != view:
            raise Changed(f"before: {view}\nafter: {View.now()}") from fault
        raise
    finally:
        must_be_same(before, marked())
    _analysed(case, armature)


def _by_the_artist(case: HostileCase, path: Path) -> None:
    """By Blender's other importer, whose own refusals are no matter of ours."""
    with suppress(RuntimeError):
        OPERATORS.wm.fbx_import(filepath=str(path))
    armature = next((o for o in bpy.data.objects if o.type == "ARMATURE"), None)
    if armature is not None:
        _analysed(case, armature)


def _analysed(case: HostileCase, armature: bpy.types.Object) -> None:
    settings = settings_of(armature)
    settings.use_range, (settings.first_frame, settings.last_frame) = True, FRAMES
    analysed(case, armature)


def _artists_object() -> None:
    mine = bpy.data.objects.new("Mine", bpy.data.meshes.new("Mine"))
    present(bpy.context.collection).objects.link(mine)
    mine.keyframe_insert("location", frame=1.0)
    data = present(mine.animation_data)
    present(data.action)[MARK] = "other"
    present(bpy.context.view_layer).objects.active = mine
    mine.select_set(True)


FAMILIES = (
    Family("FBX files, bytes", 1.0, 60.0, by_bytes),
    Family("FBX files, meaning", 1.5, 60.0, by_meaning),
)
