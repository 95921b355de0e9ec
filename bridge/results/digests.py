"""Whether the keys of takes are what they were."""

from __future__ import annotations

import bpy

from ..armature.keys_digest import KeptDigests
from ..armature.played import strip_time
from ..takes.difference import difference_shown


def take_digest(
    armature: bpy.types.Object, take: bpy.types.Action, known: KeptDigests | None = None
) -> str:
    """Of the keys of what results are made from, and of when a strip plays it. known: digests that
    are up to date."""
    time, found = strip_time(armature, take), own_digest(take, known)
    return found if time is None else f"{found} {time}"


def own_digest(take: bpy.types.Action, known: KeptDigests | None = None) -> str:
    """Of a take's keys, and of the difference that is edited in its stead. known: as above."""
    known = known or KeptDigests()
    return " ".join(map(known.of, keyed_for(take)))


def keyed_for(take: bpy.types.Action) -> list[bpy.types.Action]:
    """The actions whose keys make a take: its own, and the difference that is edited in its
    stead."""
    difference = difference_shown(take)
    return [take] if difference is None else [take, difference]
