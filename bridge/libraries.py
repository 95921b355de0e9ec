"""Library files that are missing: what was linked from them is an empty placeholder."""

import bpy

from ..solver.data.faults import LibraryMissing


def lost_character(armature: bpy.types.Object) -> LibraryMissing | None:
    """The missing file of an armature, or of its bones; None where all is there."""
    override = armature.override_library
    reference = override.reference if override is not None else None
    return next(filter(None, map(lost_file, (reference, armature.data))), None)


def lost_file(block: bpy.types.ID | None) -> LibraryMissing | None:
    """The missing file of a data-block that is linked; None where that is there, and of what was
    made local, which stays marked as missing."""
    if block is None or block.library is None or not block.is_missing:
        return None
    return LibraryMissing(bpy.path.basename(block.library.filepath), block.name)
