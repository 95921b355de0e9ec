"""Library files that are missing: what was linked from them is an empty placeholder."""

import bpy

from ..solver.data.faults import LibraryMissing
from .accessors import present


def lost_character(armature: bpy.types.Object) -> LibraryMissing | None:
    """The missing file of an armature, or of its bones; None where all is there."""
    override = armature.override_library
    reference = override.reference if override is not None else None
    return next(filter(None, map(lost_file, (reference, armature.data))), None)


def lost_file(block: bpy.types.ID | None) -> LibraryMissing | None:
    """The missing file of a data-block that is linked; None where that is there."""
    if block is None or not block.is_missing:
        return None
    return LibraryMissing(bpy.path.basename(present(block.library).filepath), block.name)
