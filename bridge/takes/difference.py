"""What a result has more than its take, as Blender's NLA combines it: an action of differences.

Blender adds locations and angles to what is below, less what the property is by default, and
multiplies sizes, and quaternions from the right (anim_sys.cc, nla_combine_value and
nla_combine_quaternion). So differences are result minus take, result by take, and take⁻¹ · result.
Keys stand on whole frames.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import SHOWS, pose_of
from ..armature import fcurves
from ..armature.fcurves import CurveHolder, ensured, linear_keys, put, table
from ..armature.write import rotation_channel
from .key_splice import key_span

_SAME = 1e-6  # of a channel's value
_QUATERNION = "rotation_quaternion"
_SCALE = "scale"
_DEFAULTS = {
    "location": (0.0, 0.0, 0.0),
    "rotation_quaternion": (1.0, 0.0, 0.0, 0.0),
    "rotation_axis_angle": (0.0, 0.0, 0.0, 0.0),  # not the property's own, whose axis is Y
    "rotation_euler": (0.0, 0.0, 0.0),
    "scale": (1.0, 1.0, 1.0),
}


def difference_of(
    armature: bpy.types.Object,
    take: bpy.types.Action,
    result: bpy.types.Action,
    slot: str | None,
) -> bpy.types.Action:
    """A new action that, combined with a take, shows a result on whole frames.

    Of bones' locations, rotations and sizes, and channels that the take lacks; others are the
    take's.
    slot: identifier of the slot that both have for the armature, and the new action gets.
    """
    below, above = fcurves.holder_in(take, slot), fcurves.holder_in(result, slot)
    assert below is not None
    assert above is not None
    name = f"{result.name} difference"
    action, made = fcurves.new_action(armature, name, slot[2:] if slot else armature.name)
    first, last = key_span(list(above.fcurves))
    frames = np.arange(np.floor(first), np.ceil(last) + 1.0)
    for bone in pose_of(armature).bones:
        for attribute in ("location", rotation_channel(bone), _SCALE):
            path = bone.path_from_id(attribute)
            _write_difference(made, (below, above), path, attribute, bone.name, frames)
    there = {(curve.data_path, curve.array_index) for curve in below.fcurves}
    mine = {(curve.data_path, curve.array_index) for curve in made.fcurves}
    for curve in above.fcurves:
        if (curve.data_path, curve.array_index) not in there | mine:  # such as contact channels
            group = curve.group.name if curve.group is not None else ""
            put(ensured(made, curve.data_path, curve.array_index, group), table(curve))
    return action


def _write_difference(
    made: CurveHolder,
    curves: tuple[CurveHolder, CurveHolder],
    path: str,
    attribute: str,
    bone: str,
    frames: FloatArray,
) -> None:
    """The keys of a property, where it differs; none where it does nowhere."""
    default = np.array(_DEFAULTS[attribute])
    take, result = (_values(each, path, default, frames) for each in curves)
    changed = np.abs(result - take).max(axis=1) > _SAME
    if not changed.any():
        return
    values = _apart(attribute, take, result)
    where = np.flatnonzero(changed)
    kept = slice(max(where[0] - 1, 0), where[-1] + 2)
    for index, column in enumerate(values[kept].T):
        curve = ensured(made, path, index, bone)
        put(curve, linear_keys(table(curve), frames[kept], column))


def bake_combined(result: bpy.types.Action, take: bpy.types.Action, slot: str | None) -> None:
    """Make a result what its strip shows: the take below as it is now, combined with the difference
    as it is now. Nothing changes where it has no difference."""
    difference = difference_shown(result)
    if difference is None:
        return
    below, above, made = (fcurves.holder_in(each, slot) for each in (take, difference, result))
    assert below is not None
    assert above is not None
    assert made is not None
    first, last = key_span([*below.fcurves, *above.fcurves])
    frames = np.arange(np.floor(first), np.ceil(last) + 1.0)
    combined = {
        curve.data_path
        for curve in above.fcurves
        if curve.data_path.rpartition(".")[2] in _DEFAULTS
    }
    for curve in below.fcurves:
        if curve.data_path not in combined:
            group = curve.group.name if curve.group is not None else ""
            put(ensured(made, curve.data_path, curve.array_index, group), table(curve))
    for path in combined:
        attribute = path.rpartition(".")[2]
        default = np.array(_DEFAULTS[attribute])
        take_values, more = (_values(each, path, default, frames) for each in (below, above))
        values = _together(attribute, take_values, more)
        for index, column in enumerate(values.T):
            curve = ensured(made, path, index, fcurves.bone_of(path) or "")
            put(curve, linear_keys(table(curve), frames, column))
    result.update_tag()


def _apart(attribute: str, take: FloatArray, result: FloatArray) -> FloatArray:
    """What a result (T, n) has more than a take, as Blender combines an attribute."""
    if attribute == _QUATERNION:
        return _quotient(take, result)
    if attribute == _SCALE:
        return result / take
    return np.asarray(result - take + _DEFAULTS[attribute])


def _together(attribute: str, take: FloatArray, more: FloatArray) -> FloatArray:
    """A take (T, n) combined with what a result has more."""
    if attribute == _QUATERNION:
        return _product(take, more)
    if attribute == _SCALE:
        return take * more
    return np.asarray(take + more - _DEFAULTS[attribute])


def difference_shown(result: bpy.types.Action) -> bpy.types.Action | None:
    """The action that holds a result's difference; None where no strip combines it."""
    return next((each for each in bpy.data.actions if each.get(SHOWS) == result), None)


def _values(curves: CurveHolder, path: str, default: FloatArray, frames: FloatArray) -> FloatArray:
    """(T, n) of a property at frames (T,); what no curve animates is what Blender's NLA takes."""
    values = np.tile(default, (len(frames), 1))
    for index in range(len(default)):
        curve = curves.fcurves.find(path, index=index)
        if curve is not None and not curve.mute:
            values[:, index] = [curve.evaluate(frame) for frame in frames]
    return values


def _quotient(take: FloatArray, result: FloatArray) -> FloatArray:
    """take⁻¹ · result of quaternions wxyz (T, 4), neighbours on one side."""
    found = _product(take * np.array([1.0, -1.0, -1.0, -1.0]), result)
    turned = np.einsum("ti,ti->t", found[1:], found[:-1]) < 0.0
    signs = np.cumprod(np.where(np.concatenate([[found[0, 0] < 0.0], turned]), -1.0, 1.0))
    return np.asarray(found * signs[:, None])


def _product(one: FloatArray, other: FloatArray) -> FloatArray:
    """one · other of quaternions wxyz (T, 4), of length 1."""
    one, other = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in (one, other))
    w, v = one[:, :1], one[:, 1:]
    a, u = other[:, :1], other[:, 1:]
    real = w * a - np.einsum("ti,ti->t", v, u)[:, None]
    return np.concatenate([real, w * u + a * v + np.cross(v, u)], axis=1)
