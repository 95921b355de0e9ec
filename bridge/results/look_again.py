"""Whether results are what would be made now, and whether they were edited by hand."""

from __future__ import annotations

import bpy

from ..fake_users import guard
from ..properties.action import HangtimeAction, action_settings
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.copying import settings_digest, settings_targets
from ..scene.surfaces_digest import Conditions, surfaces_digest
from ..takes.takes import own_result, takes_of
from .digests import own_digest, take_digest
from .made import NOT_ASKED

TAKE_CHANGED = "The take below has changed"
EDIT_CHANGED = "The settings have changed"
SURFACES_CHANGED = "A surface has changed"


def look_again(armature: bpy.types.Object) -> bool:
    """Note which results are not what would be made now, and which were edited by hand.

    Returns whether anything is new.
    """
    settings, own, new = settings_of(armature), own_result(armature), False
    keys: dict[bpy.types.Action, str] = {}
    sources: dict[bpy.types.Action, str] = {}
    surfaces: dict[bpy.types.Object, str] = {}
    for take in takes_of(armature):
        kept = action_settings(take.action)
        if take.source is None or not kept.own_key:
            continue
        if take.action not in keys:
            keys[take.action] = own_digest(take.action)
        if take.source not in sources:
            sources[take.source] = take_digest(armature, take.source)
        edit = settings if take.action == own else kept.edit
        stale = unphysical_since(armature, take.action)
        if stale:
            pass  # of which the changes below may only be what follows
        elif sources[take.source] != kept.take_key:
            stale = TAKE_CHANGED
        elif not _asks_the_same(edit, kept):
            stale = EDIT_CHANGED
        elif kept.surfaces_key and surfaces_digest(edit, armature, surfaces) != kept.surfaces_key:
            stale = SURFACES_CHANGED
        edited = keys[take.action] != kept.own_key
        polished = kept.holds_polish or edited
        if edited and take.action.library is None:  # who works on a result means to keep it
            guard(take.action)
        if (kept.stale, kept.polished) != (stale, polished):
            kept.stale, kept.polished = stale, polished
            new = True
    return new


def unphysical_since(armature: bpy.types.Object, result: bpy.types.Action) -> str:
    """What of the scene or of its armature's place makes a result unphysical, in words; "" for
    nothing, as for results of earlier versions."""
    made = action_settings(result)
    if not made.conditions:
        return ""
    before = Conditions.read(str(made.conditions))
    return Conditions.of(armature).since(before, among_surfaces=bool(made.surfaces_key))


def _asks_the_same(edit: HangtimeSettings, kept: HangtimeAction) -> bool:
    """Whether an edit is what a result was made with. What is switched off asks for nothing, as do
    linked rows that an edit lacks; results of earlier versions count it."""
    targets = [row.target for row in kept.asked_targets]
    return any(
        settings_targets(edit, NOT_ASKED, off=off) == targets
        and settings_digest(edit, NOT_ASKED, off=off) == str(kept.asked_key)
        for off in (False, True)
    )


def polished_result(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The last result, where it has hand polish: was edited since it was made, or took it over."""
    result: bpy.types.Action | None = settings_of(armature).adapted
    if result is None or not action_settings(result).own_key:
        return None
    kept = action_settings(result)
    return result if kept.holds_polish or own_digest(result) != kept.own_key else None
