"""Shape keys in a file's takes: their values while an armature performs, on a rig in its stead.

The rig's actions hold the values, and drivers pass them on. So each take has its own at the frames
where the file has the take, and every exporter finds them.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene, pose_of, present
from ..armature import fcurves
from ..armature.poses import evaluated

_GROUP = "Shape Keys"


def moving_shapes(meshes: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """The meshes whose shape keys something animates."""
    return [mesh for mesh in meshes if has_shapes(mesh) and _keys(mesh).animation_data is not None]


def has_shapes(mesh: bpy.types.Object) -> bool:
    """Whether a mesh has shape keys beside the basis."""
    keys = getattr(mesh.data, "shape_keys", None)
    return keys is not None and len(keys.key_blocks) > 1


def sample_shapes(meshes: Sequence[bpy.types.Object], frames: FloatArray) -> FloatArray:
    """(T, K) values of the meshes' shape keys, the bases left out, at each of `frames` (T,)."""
    values = np.empty((len(frames), sum(len(_shapes(mesh)) for mesh in meshes)))
    if values.size == 0:
        return values
    with evaluated(meshes):
        for row, frame in zip(values, frames, strict=True):
            whole = int(np.floor(frame))
            current_scene().frame_set(whole, subframe=frame - whole)
            graph = bpy.context.evaluated_depsgraph_get()
            seen = (_keys(mesh).evaluated_get(graph).key_blocks[1:] for mesh in meshes)
            row[:] = [block.value for blocks in seen for block in blocks]
    return values


def write_shapes(
    rig: bpy.types.Object, curves: fcurves.CurveHolder, frames: FloatArray, values: FloatArray
) -> None:
    """Have a rig's action hold sampled values (T, K)."""
    for i, column in enumerate(values.T):
        pose_of(rig).bones[0][_property(i)] = 0.0
        fcurves.write_channels(curves, _path(rig, i), frames, column[:, None], _GROUP)


def drive_shapes(
    rig: bpy.types.Object, copies: Sequence[bpy.types.Object], values: FloatArray
) -> None:
    """Have copies of the meshes that were sampled show what a rig's actions hold. values (T, K): of
    all takes; what does not change in them needs no keys."""
    i = 0
    for copy in copies:
        _keys(copy).animation_data_clear()
        for block in _shapes(copy):
            block.value = values[0, i]
            if np.ptp(values[:, i]) > 0.0 and not block.mute:
                _drive(block, rig, _path(rig, i))
            i += 1


def _drive(block: bpy.types.ShapeKey, rig: bpy.types.Object, path: str) -> None:
    curve = block.driver_add("value")
    assert isinstance(curve, bpy.types.FCurve)
    driver = present(curve.driver)
    driver.type = "SUM"  # unlike an expression it needs no leave to run scripts
    target = driver.variables.new().targets[0]
    target.id, target.data_path = rig, path


def _keys(mesh: bpy.types.Object) -> bpy.types.Key:
    assert isinstance(mesh.data, bpy.types.Mesh)
    return present(mesh.data.shape_keys)


def _shapes(mesh: bpy.types.Object) -> list[bpy.types.ShapeKey]:
    """The shape keys of a mesh, the basis left out."""
    return list(_keys(mesh).key_blocks[1:])


def _property(index: int) -> str:
    return f"shape {index}"


def _path(rig: bpy.types.Object, index: int) -> str:
    """Of a value; on a bone, for of objects files tell custom properties."""
    return f'{pose_of(rig).bones[0].path_from_id()}["{_property(index)}"]'
