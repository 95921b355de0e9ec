"""Which rows of an overridden armature come from the linked file.

Blender keeps an override's changes of these rows' values, but neither that one is gone or renamed
nor that its bones are others: it would add them anew when the file is opened.
"""

from __future__ import annotations

import bpy

from ..accessors import attached


def linked_count(armature: bpy.types.Object, rows: str) -> int:
    """How many of a list, the first ones, are linked; rows: the name of the settings' property."""
    override = armature.override_library
    if override is None or override.reference is None:
        return 0
    return len(getattr(attached(override.reference), rows))
