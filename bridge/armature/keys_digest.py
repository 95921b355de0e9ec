"""Whether an action's curves are what they were."""

from __future__ import annotations

from zlib import crc32

import bpy
import numpy as np

from .fcurves import all_curves, table

_BEZIER = 2  # of Blender's enum
_HANDLES = ("handle_left", "handle_right")


def keys_digest(action: bpy.types.Action) -> str:
    """A number for all keys of an action, and the handles that shape its curves; another where
    something differs."""
    found = 0
    for curve in all_curves(action):
        keys = table(curve)
        found = crc32(f"{curve.data_path}[{curve.array_index}]{curve.mute}".encode(), found)
        found = crc32(keys["co"].tobytes(), found)
        interpolation = keys["interpolation"][:, 0]
        found = crc32(interpolation.tobytes(), found)
        bent = interpolation == _BEZIER
        after_bent = np.concatenate([[False], bent[:-1]]) if len(bent) else bent
        for name, used in zip(_HANDLES, (after_bent, bent), strict=True):
            found = crc32(keys[name][used].tobytes(), found)
    return str(found)
