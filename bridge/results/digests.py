"""Whether the keys of takes are what they were."""

from __future__ import annotations

import bpy

from ..armature.keys_digest import keys_digest
from ..armature.played import strip_time
from ..takes.difference import difference_shown


def take_digest(armature: bpy.types.Object, take: bpy.types.Action) -> str:
    """Of the keys of what results are made from, and of when a strip plays it."""
    time, found = strip_time(armature, take), own_digest(take)
    return found if time is None else f"{found} {time}"


def own_digest(action: bpy.types.Action) -> str:
    """Of a take's keys, and of the difference that is edited in its stead."""
    difference = difference_shown(action)
    own = keys_digest(action)
    return own if difference is None else f"{own} {keys_digest(difference)}"
