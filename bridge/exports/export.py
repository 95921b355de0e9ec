"""Export of takes to one file, as FBX, glTF or USD, the way a game engine wants it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from itertools import count
from pathlib import Path

import bpy
import numpy as np

from ...solver.data.faults import MissingPart, SeveralTakes
from ..accessors import present
from ..files.data_blocks import data_blocks, remove_added, scene_restored
from ..recipe.export import ExportOptions
from ..rows.choices import FileFormat
from .baked_rig import bake
from .engines import CONVENTIONS, format_of
from .placed_takes import frames_of, outline_for, place_takes
from .shapes import drive_shapes, moving_shapes
from .skin import Skin, copy_skin, skin_of
from .writers import require_format, under_name, write

AS_IT_IS = ExportOptions()


def export_takes(
    armature: bpy.types.Object,
    takes: Sequence[bpy.types.Action],
    path: str | Path,
    options: ExportOptions = AS_IT_IS,
    pelvis: str | None = None,
) -> Skin:
    """Write an armature with these takes alone, a key on every frame, each under its action's name.

    pelvis: the bone; needed where something else carries the way, or takes begin at the origin.
    Folders are made where missing. The scene is left as it was. A single take keeps its frames
    where the file is for no engine, as long as none is below 0, where files have none; others begin
    at 0 s. Returns the skin, whose meshes are in the file. Raises OutputNotWritable, MissingPart,
    SeveralTakes (a USD file holds one), SameUsdNames.
    """
    form = format_of(options)
    if form is FileFormat.USD and len(takes) > 1:
        raise SeveralTakes(tuple(take.name for take in takes))
    if pelvis is None and options.needs_pelvis:
        raise MissingPart("pelvis")
    alone = len(takes) == 1 and not CONVENTIONS[options.engine].clean
    keeps = alone and frames_of(takes[0])[0] >= 0
    skin = skin_of(armature) if options.skin else Skin()
    shaped = moving_shapes(skin.meshes)
    with scene_restored():
        found = place_takes(armature, takes, options, pelvis, shaped, keeps_frames=keeps)
        before = data_blocks()
        try:
            rig = bake("Exported", found.skeleton, found.placed, found.takes)
            copies = copy_skin(skin, armature, rig, found.from_armature)
            moving = [copy for copy, mesh in copies.items() if mesh in shaped]
            drive_shapes(rig, moving, np.concatenate([take.shapes for take in found.takes]))
            names = {rig: CONVENTIONS[options.engine].object or armature.name}
            names |= _beside(names[rig], copies)
            with _data_named(copies):
                write(rig, names, found.takes, Path(path), options, keeps_frames=keeps)
        finally:
            remove_added(before)
    return skin


def require_exportable(
    armature: bpy.types.Object, path: str | Path, options: ExportOptions
) -> None:
    """What can be told of a file before there is a take for it. Raises OutputNotWritable,
    SameUsdNames."""
    bones = outline_for(armature, options, pelvis=None).names
    require_format(format_of(options), bones, Path(path))


def _beside(
    rig: str, copies: Mapping[bpy.types.Object, bpy.types.Object]
) -> dict[bpy.types.Object, str]:
    """Copies' names, those of their meshes: but that of the rig, which an engine may want of it, is
    the rig's, and its mesh gets one that no other has."""
    names = {copy: mesh.name for copy, mesh in copies.items()}
    free = f"{rig} Mesh"
    numbers = count(2)
    while free in names.values():
        free = f"{rig} Mesh {next(numbers)}"
    return {copy: free if name == rig else name for copy, name in names.items()}


@contextmanager
def _data_named(copies: Mapping[bpy.types.Object, bpy.types.Object]) -> Iterator[None]:
    """Context in which copies' meshes are called as the originals' are, which are set aside; of
    several that were one mesh the first."""
    firsts = {mesh.data: copy.data for copy, mesh in reversed(list(copies.items()))}
    with ExitStack() as named:
        for original, copy in firsts.items():
            named.enter_context(under_name(copy, present(original).name, bpy.data.meshes))
        yield
