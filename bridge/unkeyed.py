"""Channels that a recording leaves alone: where a result of it has keys, from the start or by hand
later, Blender leaves them as that result had them.

So a result knows what they are in its recording, and whoever stops performing it gets those back
that only the result has keys for.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import isfinite
from typing import Any

import bpy

from .accessors import SHOWS
from .action_slots import all_curves
from .hidden_texts import HiddenText, listed, number, whole, word

_RECORDING = "hangtime_unkeyed_in"  # of a result that knows every such channel: in this action
_TRANSFORMS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")
_BENDS = ("curveinx", "curveinz", "curveoutx", "curveoutz", "rollin", "rollout")
_LENGTHS = ("easein", "easeout", "scalein", "scaleout")
_ANIMATED = (*_TRANSFORMS, *(f"bbone_{each}" for each in (*_BENDS, *_LENGTHS)), "influence")
_CUSTOM = '["'  # with which the names of custom properties begin, as in the paths of curves

_Channel = tuple[str, str, int]  # path of what has a property, the property, and index
_Values = dict[_Channel, float]


def note_unkeyed(
    owner: bpy.types.Object,
    result: bpy.types.Action,
    performed: bpy.types.Action,
    recording: bpy.types.Action,
) -> None:
    """Keep with a result what the recording that it goes back to leaves alone, as `owner` has it,
    which performs that or another result of it; what only this one has keys for is as it knows.
    Numbers that are not finite, as of custom properties, JSON cannot hold: they are left out."""
    keyed = _keyed(recording)
    values = {
        channel: value
        for channel, value in _set_in(owner)
        if channel not in keyed and isfinite(value)
    }
    values |= dict(_given_back(owner, performed))
    result[UNKEYED.name] = json.dumps([(*channel, value) for channel, value in values.items()])
    result[_RECORDING] = recording


def note_copied(result: bpy.types.Action, recording: bpy.types.Action) -> None:
    """Let a copied result, where it knows what its recording leaves alone, know it of a copy of
    that."""
    if result.get(_RECORDING) is not None:
        result[_RECORDING] = recording


class PutBack:
    """Gives `owner`, which performed a result, what only this has keys for as its recording has it;
    bones and properties that are gone meanwhile have none. Others stay as the artist set them.

    What that is it looks for in all curves, once of each result: one serves for the slices of a
    reading, and no longer.
    """

    def __init__(self) -> None:
        self._found: dict[int, dict[_Channel, float]] = {}  # by the results' numbers in the session

    def __call__(self, owner: bpy.types.Object, result: bpy.types.Action) -> None:
        uid = result.session_uid
        if uid not in self._found:
            self._found[uid] = dict(_given_back(owner, result))
        for (path, name, index), value in self._found[uid].items():
            try:
                _put(owner.path_resolve(path) if path else owner, name, index, value)
            except (ValueError, AttributeError, LookupError, TypeError):
                continue
        if self._found[uid]:
            owner.update_tag()  # of custom properties Blender does not notice it


def _given_back(
    owner: bpy.types.Object, result: bpy.types.Action
) -> Iterator[tuple[_Channel, float]]:
    """What only a result has keys for, with the values in its recording; nothing of what is no
    result."""
    noted, recording = UNKEYED.of(result.get(UNKEYED.name)), result.get(_RECORDING)
    if noted is None:
        return
    for channel in _keyed(result) - (_keyed(recording) if recording is not None else set()):
        value = noted.get(channel)
        if value is None and recording is not None:  # earlier versions noted but what had keys
            value = _by_default(owner, *channel)
        if value is not None:
            yield channel, value


def _keyed(take: bpy.types.Action) -> set[_Channel]:
    """The channels with keys in a take, or in the difference that is edited in its stead."""
    differences = (each for each in bpy.data.actions if each.get(SHOWS) == take)
    curves = (curve for action in (take, *differences) for curve in all_curves(action))
    return {(*_split(curve.data_path), curve.array_index) for curve in curves}


def _split(path: str) -> tuple[str, str]:
    """What has a curve's property, and that."""
    if path.endswith("]"):
        at = path.rindex(_CUSTOM)  # in names quotes are escaped
        return path[:at], path[at:]
    holder, _, name = path.rpartition(".")
    return holder, name


def _set_in(owner: bpy.types.Object) -> Iterator[tuple[_Channel, float]]:
    """The values of what may be animated of an armature, its bones and their constraints, but for
    what is as it is by default; of custom properties all."""
    bones = owner.pose.bones if owner.pose is not None else ()
    posed: list[bpy.types.Object | bpy.types.PoseBone] = [owner, *bones]
    for each in posed:
        path = each.path_from_id() if each != owner else ""
        yield from _animated_of(path, each)
        for constraint in each.constraints:
            yield from _animated_of(constraint.path_from_id(), constraint)
        for key, held in each.items():
            if _is_number(held):
                name = f'{_CUSTOM}{bpy.utils.escape_identifier(key)}"]'
                yield from (((path, name, i), value) for i, value in enumerate(_listed(held)))


def _animated_of(path: str, holder: Any) -> Iterator[tuple[_Channel, float]]:
    for name in _ANIMATED:
        known = holder.bl_rna.properties.get(name)
        if known is None:
            continue
        for index, value in enumerate(_listed(getattr(holder, name))):
            if value != _default(known, index):
                yield (path, name, index), value


def _is_number(held: Any) -> bool:
    """Whether a custom property is a number, or an array of such."""
    return isinstance(held, int | float) or getattr(held, "typecode", "") in {*"bifd"}


def _listed(value: Any) -> list[float]:
    return [float(each) for each in (value if hasattr(value, "__len__") else (value,))]


def _default(known: Any, index: int) -> float:
    return float(known.default_array[index] if known.is_array else known.default)


def _by_default(owner: bpy.types.Object, path: str, name: str, index: int) -> float | None:
    """What a channel is that was not noted; None where that is not known."""
    try:
        holder = owner.path_resolve(path) if path else owner
        return _default(holder.bl_rna.properties[name], index) if name in _ANIMATED else None
    except (ValueError, AttributeError, LookupError):
        return None


def _put(holder: Any, name: str, index: int, value: float) -> None:
    """Set a channel of a property, of the property's own type."""
    custom = name.startswith(_CUSTOM)
    key = bpy.utils.unescape_identifier(name[2:-2]) if custom else name
    held = holder[key] if custom else getattr(holder, name)
    if hasattr(held, "__len__"):
        if held[index] != value:  # whatever is set has Blender go through the armature anew
            held[index] = type(held[index])(value)
    elif held == value:
        return
    elif custom:
        holder[key] = type(held)(value)
    else:
        setattr(holder, name, value)


def _read_channels(content: Any) -> _Values:
    return {
        (word(path), word(name), whole(at)): number(value)
        for path, name, at, value in map(listed, listed(content))
    }


UNKEYED: HiddenText[_Values | None] = HiddenText("hangtime_unkeyed", _read_channels, None)
