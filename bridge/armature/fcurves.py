"""F-curves of an action, legacy or layered (4.4): access, keys, cropping.

4.2 and 4.3 keep them in the action. From 4.4 an action has one slot per thing that it animates, and
the curves are in that slot's channelbag; 5.0 has no other way. Nothing else knows the difference.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, TypeAlias

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solver.arrays import FloatArray
from ..accessors import current_action, take_strips
from ..action_slots import bag_of, home_of, keyframe_strip, recorded_slot
from ..played_strips import played_strip
from ..unkeyed import PutBack
from .incremental import note_made_action

CurveHolder: TypeAlias = "bpy.types.Action | bpy.types.ActionChannelbag"  # 4.2 has no channelbags

KeyTable: TypeAlias = "dict[str, NDArray[Any]]"
"""What the keys of a curve carry, by Blender's names, a column (n, ...) each."""

_LINEAR = 1  # values of the enums in foreach_get and foreach_set
_FREE_HANDLE = 0
_AUTO_CLAMPED = 4
_NEW_KEY = {"amplitude": 0.8, "back": 1.70158, "period": 4.1, "interpolation": _LINEAR}
_THIRD = 1.0 / 3.0  # frames, of a handle that nothing uses while its key is linear
_FLOATS = {"co": 2, "handle_left": 2, "handle_right": 2, "amplitude": 1, "back": 1, "period": 1}
_ENUMS = ("interpolation", "easing", "handle_left_type", "handle_right_type", "type")
_EPSILON = 1e-4  # frames


def holder(owner: bpy.types.Object) -> CurveHolder | None:
    """Container of the F-curves of the action that animates `owner`; None where nothing does."""
    action = current_action(owner)
    return None if action is None else holder_in(action, slot_identifier(owner))


def curves_of(owner: bpy.types.Object) -> list[bpy.types.FCurve]:
    """F-curves of the action that animates `owner`; none where nothing does."""
    curves = holder(owner)
    return list(curves.fcurves) if curves is not None else []


def holder_in(action: bpy.types.Action, slot: str | None) -> CurveHolder | None:
    """Container of the F-curves of an action's slot of that identifier, whomever it animates; of a
    result that is a slot, that one's."""
    if not hasattr(action, "slots"):
        return action
    home = home_of(action)
    if home is not None:
        return bag_of(*home)
    return bag_of(action, next((s for s in action.slots if s.identifier == slot), None))


def new_holder(owner: bpy.types.Object, name: str) -> CurveHolder:
    """Container of the curves of a new action, which animates `owner`."""
    data = owner.animation_data_create()
    data.action, curves = new_action(owner, name, owner.name)
    if hasattr(data.action, "slots"):
        data.action_slot = data.action.slots[0]
    return curves


def new_action(
    owner: bpy.types.Object, name: str, slot: str
) -> tuple[bpy.types.Action, CurveHolder]:
    """A new action, and the container of its curves; in a slot of that name, where it has slots."""
    action = bpy.data.actions.new(name)
    note_made_action(action)
    if not hasattr(action, "slots"):
        return action, action
    made = action.slots.new(owner.id_type, slot)
    strip = keyframe_strip(action.layers.new("Layer").strips.new(type="KEYFRAME"))
    return action, strip.channelbag(made, ensure=True)


def slot_identifier(owner: bpy.types.Object) -> str | None:
    """Identifier of the slot that `owner` uses, of one that is a result the recording's; None
    without one and before Blender 4.4."""
    data = owner.animation_data
    slot = getattr(data, "action_slot", None)
    if data is not None and data.action is not None and slot is not None:
        slot = recorded_slot(data.action, slot)
    if slot is None:
        strips = [*(strip for _, strip in take_strips(owner)), played_strip(owner)]
        slots = (getattr(strip, "action_slot", None) for strip in strips)
        slot = next((each for each in slots if each is not None), None)
    return slot.identifier if slot is not None else None


def assign(
    owner: bpy.types.Object,
    action: bpy.types.Action | None,
    slot: str | None = None,
    put_back: PutBack | None = None,
) -> None:
    """Let `action` animate `owner`, through the slot of that identifier where there are slots.

    Without such a slot the first that fits the kind of `owner` is taken. A result that is a slot is
    shown by this. What only the result that is left has keys for is as before it: `put_back` has it
    so, one of its own where none is given.
    """
    data = owner.animation_data or owner.animation_data_create()
    left = current_action(owner)
    if left is not None and left != action:
        (put_back or PutBack())(owner, left)
    home = home_of(action) if action is not None else None
    if home is not None:
        data.action, data.action_slot = home
        return
    data.action = action
    if action is None or not hasattr(action, "slots"):
        return
    fitting = [s for s in action.slots if s.target_id_type in {owner.id_type, "UNSPECIFIED"}]
    named = [s for s in fitting if s.identifier == slot]
    if named or (fitting and data.action_slot is None):
        data.action_slot = (named or fitting)[0]


def bone_of(data_path: str) -> str | None:
    """Name of the pose bone that a data path animates; None where it animates something else."""
    match = re.match(r'pose\.bones\["((?:[^"\\]|\\.)*)"\]', data_path)
    return bpy.utils.unescape_identifier(match[1]) if match else None


def keys(curve: bpy.types.FCurve) -> FloatArray:
    """Frames and values (n, 2) of the keys of a curve."""
    points = np.empty(2 * len(curve.keyframe_points), np.float32)
    curve.keyframe_points.foreach_get("co", points)
    return points.reshape(-1, 2).astype(np.float64)


def values_at(curve: bpy.types.FCurve, frames: FloatArray) -> FloatArray:
    """(T,) what a curve shows at frames (T,): where each has a key of its own, that is the key's
    value, which is read a hundred times as fast."""
    own = keys(curve)
    index = np.searchsorted(own[:, 0], frames)
    within = not len(curve.modifiers) and bool((index < len(own)).all())
    if within and np.array_equal(own[index, 0], frames):
        return np.asarray(own[index, 1])
    return np.fromiter(map(curve.evaluate, frames.tolist()), float, len(frames))


def scale_keys(curve: bpy.types.FCurve, frames: float, values: float) -> None:
    """Multiply the keys and handles of a curve, in time and value."""
    factors = np.array([frames, values], dtype=np.float32)
    for attribute in ("co", "handle_left", "handle_right"):
        table = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
        curve.keyframe_points.foreach_get(attribute, table)
        scaled = table.reshape(-1, 2) * factors
        curve.keyframe_points.foreach_set(attribute, scaled.ravel())
    curve.update()


def align_quaternions(curves: Iterable[bpy.types.FCurve]) -> None:
    """Flip quaternion keys so that none points away from the one before.

    q and -q are the same rotation, but what lies half way between them is none.
    """
    by_path: dict[str, list[bpy.types.FCurve]] = {}
    for curve in curves:
        if curve.data_path.endswith("rotation_quaternion"):
            by_path.setdefault(curve.data_path, []).append(curve)
    for components in by_path.values():
        tables = np.array([keys(curve) for curve in components])
        values = tables[:, :, 1]
        flips = np.cumsum(np.sum(values[:, 1:] * values[:, :-1], axis=0) < 0.0) % 2 == 1
        if flips.any():
            tables[:, 1:, 1] = np.where(flips, -values[:, 1:], values[:, 1:])
            for curve, table in zip(components, tables, strict=True):
                curve.keyframe_points.foreach_set("co", table.astype(np.float32).ravel())
                curve.update()


def write_channels(
    curves: CurveHolder, path: str, frames: FloatArray, values: FloatArray, group: str
) -> None:
    """Write the curves of `path`, a column of values (T, n) each, as `_write_channel` does."""
    for index, column in enumerate(values.T):
        _write_channel(curves, path, index, frames, column, group)


def ensured(curves: CurveHolder, path: str, index: int, group: str) -> bpy.types.FCurve:
    """The curve of that path and index; a new one goes to the group of that name."""
    curve = curves.fcurves.find(path, index=index)
    if curve is None:
        curve = curves.fcurves.new(path, index=index)
        curve.group = curves.groups.get(group) or curves.groups.new(group)
    return curve


def _write_channel(
    curves: CurveHolder, path: str, index: int, frames: FloatArray, values: FloatArray, group: str
) -> None:
    """Make the curve of `path` and `index` these keys (T,) alone, linear in between."""
    curve = ensured(curves, path, index, group)
    for modifier in list(curve.modifiers):
        curve.modifiers.remove(modifier)
    curve.mute = False
    curve.extrapolation = "CONSTANT"
    points = curve.keyframe_points
    points.clear()
    points.add(len(frames))
    points.foreach_set("co", np.column_stack([frames, values]).astype(np.float32).ravel())
    points.foreach_set("interpolation", np.full(len(frames), _LINEAR, np.int32))
    curve.update()


def crop(curve: bpy.types.FCurve, first: float, last: float) -> None:
    """Remove the keys outside [first, last]; the values at the frames within stay what they were.

    Where a border cuts between two keys, every whole frame up to the next key within gets a key.
    Curves with modifiers (a cycle needs its keys) and without keys are left alone.
    """
    at = keys(curve)[:, 0]
    inside = (at > first - _EPSILON) & (at < last + _EPSILON)
    if inside.all() or len(curve.modifiers) > 0:
        return
    added = _cut_frames(at, inside, first, last)
    values = np.array([curve.evaluate(frame) for frame in added])
    kept = {name: column[inside] for name, column in table(curve).items()}
    if inside.any():
        _free_handles(kept)
    put(curve, joined(kept, linear_keys(kept, added, values)))
    curve.update()


def _cut_frames(at: FloatArray, inside: NDArray[np.bool_], first: float, last: float) -> FloatArray:
    """Whole frames between the borders and the keys within, on the sides that lose a key."""
    whole = np.arange(np.ceil(first), np.floor(last) + 1.0)
    before, after = (at <= first - _EPSILON).any(), (at >= last + _EPSILON).any()
    if inside.any():
        left = before & (whole < at[inside].min() - _EPSILON)
        right = after & (whole > at[inside].max() + _EPSILON)
        return np.asarray(whole[left | right])
    return whole if before and after else np.asarray(whole[[0, -1]])


def table(curve: bpy.types.FCurve) -> KeyTable:
    """Everything that the keys of a curve carry."""
    return {name: column(curve, name) for name in (*_FLOATS, *_ENUMS)}


def column(curve: bpy.types.FCurve, name: str) -> NDArray[Any]:
    """(n, width) one column of the table."""
    points = curve.keyframe_points
    found = np.empty(
        (len(points), _FLOATS.get(name, 1)), np.float32 if name in _FLOATS else np.int32
    )
    points.foreach_get(name, found.reshape(-1))  # a view
    return found


def put(curve: bpy.types.FCurve, keys_of: KeyTable) -> None:
    """Make the keys of a curve those of a table, bit by bit: no handle is worked out anew."""
    points = curve.keyframe_points
    points.clear()
    points.add(len(keys_of["co"]))
    for name, column in keys_of.items():
        points.foreach_set(name, column.ravel())


def joined(one: KeyTable, other: KeyTable) -> KeyTable:
    """The keys of both tables, in order."""
    order = np.argsort(np.concatenate([one["co"][:, 0], other["co"][:, 0]]), kind="stable")
    return {name: np.concatenate([one[name], other[name]])[order] for name in one}


def linear_keys(like: KeyTable, frames: FloatArray, values: FloatArray) -> KeyTable:
    """Keys at frames (n,) that are linear in between. like: a table of the same columns."""
    count = len(frames)
    made = {
        name: np.zeros((count, *column.shape[1:]), column.dtype) for name, column in like.items()
    }
    for name, value in _NEW_KEY.items():
        made[name][:] = value
    made["co"][:] = np.column_stack([frames, values])
    for side, name in ((-1.0, "handle_left"), (1.0, "handle_right")):
        made[name][:] = np.column_stack([frames + side * _THIRD, values])
        made[f"{name}_type"][:] = _AUTO_CLAMPED
    return made


def _free_handles(keys_of: KeyTable) -> None:
    """Keep the outermost keys' tangents, which Blender would flatten for want of a neighbour."""
    for name in ("handle_left_type", "handle_right_type"):
        keys_of[name][[0, -1]] = _FREE_HANDLE
