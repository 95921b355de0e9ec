"""An object's scale, which importers of FBX key."""

from __future__ import annotations

import bpy

from ..accessors import current_scene
from ..armature import fcurves
from ..armature.fcurves import put, table

_LENGTHS = ("scale", "location")
_COLUMNS = ("co", "handle_left", "handle_right")


def scale_object(owner: bpy.types.Object, action: bpy.types.Action | None, factor: float) -> None:
    """Make an object so many times as large, together with the keys of its scale, and of its
    location, that an action has; bones' keys stay."""
    owner.scale = owner.scale * factor
    curves = fcurves.holder_in(action, fcurves.slot_identifier(owner)) if action else None
    for curve in curves.fcurves if curves is not None else ():
        if curve.data_path in _LENGTHS:
            keys = table(curve)
            for name in _COLUMNS:
                keys[name][:, 1] *= factor
            put(curve, keys)
    scene = current_scene()
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
