"""Results that are combined with their take, as keys of their own."""

from __future__ import annotations

import bpy

from ..accessors import source_of
from ..armature.fcurves import slot_identifier
from ..armature.played import in_scene_time
from ..properties.action import action_settings
from ..takes.difference import bake_combined, difference_shown
from .digests import own_digest, take_digest


def bake_shown(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Make a result that is combined with its take what its strip shows, where either was edited;
    before it is built upon, or leaves the file."""
    made, source = action_settings(result), source_of(result)
    if source is None or difference_shown(result) is None:
        return
    now = own_digest(result)
    if (take_digest(armature, source), now) != (made.take_key, made.own_key):
        _, _, difference = now.partition(" ")
        made.holds_polish |= difference != made.own_key.partition(" ")[2]
        with in_scene_time(armature, source) as take:
            bake_combined(result, take, slot_identifier(armature))
        made.own_key = own_digest(result)
