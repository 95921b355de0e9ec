"""Bones whose keys change a length: poses alone do not tell one that is stretched from one further
up, whose scale it inherits."""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.data.recording import POSE_TOLERANCE
from ..accessors import armature_data, present
from ..armature import fcurves
from ..armature.actions import recorded_action


def stretching_bone(armature: bpy.types.Object, bone: str) -> str:
    """The bone whose keys change the length of another: of their scale, on it or the nearest bone
    above, or of the location of what hangs on it; that other one itself where no such keys are."""
    keyed, rest = _varying(armature), armature_data(armature).bones[bone]
    above: list[str] = [each.name for each in (rest, *rest.parent_recursive)]
    below: list[str] = [each.name for each in rest.children]
    scaled = [name for name in above if (name, "scale") in keyed]
    moved = [name for name in below if (name, "location") in keyed]
    return [*scaled, *moved, bone][0]


def _varying(armature: bpy.types.Object) -> set[tuple[str | None, str]]:
    """Bones and properties whose keys in the recording are not all alike."""
    slot = fcurves.slot_identifier(armature)
    curves = fcurves.holder_in(present(recorded_action(armature)), slot)
    assert curves is not None
    return {
        (fcurves.bone_of(curve.data_path), curve.data_path.rpartition(".")[2])
        for curve in curves.fcurves
        if len(curve.keyframe_points) and np.ptp(fcurves.keys(curve)[:, 1]) > POSE_TOLERANCE
    }
