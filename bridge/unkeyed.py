"""Channels that a result keys and its take does not: Blender leaves them as the result had them.

So a result knows what they are in its take, and whoever stops performing it gets them back.
"""

from __future__ import annotations

import json
from typing import Any

import bpy

from .action_slots import all_curves
from .hidden_texts import HiddenText, listed, number, whole, word

_TRANSFORMS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")
_Channels = tuple[tuple[str, str, int, float], ...]  # bone, property, index and value of each


def note_unkeyed(owner: bpy.types.Object, result: bpy.types.Action, take: bpy.types.Action) -> None:
    """Keep with a result what its take leaves alone, as `owner` has it that performs the take; and
    what that take, where it is a result, knows so of its own."""
    keyed = {(curve.data_path, curve.array_index) for curve in all_curves(take)}
    found = _noted(take)
    for curve in all_curves(result):
        path, _, name = curve.data_path.rpartition(".")
        if name in _TRANSFORMS and (curve.data_path, curve.array_index) not in keyed:
            values = getattr(owner.path_resolve(path) if path else owner, name)
            found.append((path, name, curve.array_index, values[curve.array_index]))
    result[UNKEYED.name] = json.dumps(found)


def put_back(owner: bpy.types.Object, result: bpy.types.Action) -> None:
    """Give `owner`, which performed a result, the channels that its takes leave alone as they have
    them; bones that are gone meanwhile have none."""
    for path, name, index, value in _noted(result):
        try:
            getattr(owner.path_resolve(path) if path else owner, name)[index] = value
        except (ValueError, AttributeError, IndexError):
            continue


def _noted(result: bpy.types.Action) -> list[tuple[str, str, int, float]]:
    """Bone, property, index and value of each channel; none of what is no result."""
    return [*UNKEYED.of(result.get(UNKEYED.name))]


def _read_channels(content: Any) -> _Channels:
    return tuple(
        (word(path), _TRANSFORMS[_TRANSFORMS.index(name)], whole(at), number(value))
        for path, name, at, value in map(listed, listed(content))
    )


UNKEYED: HiddenText[_Channels] = HiddenText("hangtime_unkeyed", _read_channels, ())
