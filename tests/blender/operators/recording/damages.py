"""A jump without some frames, and what is found in an armature's recording."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.fcurves import curves_of, put, table
from hangtime.bridge.repairs.stored import findings

GAP, LACKS = 150, 4  # frames are missing after one


def kinds(armature: bpy.types.Object) -> list[str]:
    return [row.name for row in findings(armature.hangtime)]


def take_frames_out(armature: bpy.types.Object) -> None:
    """Leaves out frames 151 to 154, those after them that much earlier."""
    for curve in curves_of(armature):
        keys = table(curve)
        at = keys["co"][:, 0]
        keys = {name: column[(at <= GAP) | (at > GAP + LACKS)] for name, column in keys.items()}
        late = keys["co"][:, 0] > GAP
        for name in ("co", "handle_left", "handle_right"):
            keys[name][late, 0] -= LACKS
        put(curve, keys)
