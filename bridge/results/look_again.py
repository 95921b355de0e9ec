"""Whether results are what would be made now, and whether they were edited by hand."""

from __future__ import annotations

import bpy

from ..accessors import present
from ..armature.keys_digest import KeptDigests
from ..fake_users import guard
from ..properties.action import HangtimeAction, action_settings
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.copying import settings_digest
from ..scene.surfaces_digest import Conditions, surfaces_digest
from ..takes.takes import ListedTake, own_result, takes_of
from .digests import keyed_for, own_digest, take_digest
from .made import NOT_ASKED

TAKE_CHANGED = "The take below has changed"
EDIT_CHANGED = "The settings have changed"
SURFACES_CHANGED = "A surface has changed"


def looked_at(armature: bpy.types.Object) -> list[bpy.types.Action]:
    """The actions whose keys `look_again` asks for."""
    takes = [each for each in takes_of(armature) if _is_told(each)]
    asked = dict.fromkeys(one for take in takes for one in (take.action, present(take.source)))
    return [action for take in asked for action in keyed_for(take)]


def look_again(armature: bpy.types.Object, known: KeptDigests | None = None) -> bool:
    """Note which results are not what would be made now, and which were edited by hand.

    known: digests that are up to date. Returns whether anything is new.
    """
    settings, own, new = settings_of(armature), own_result(armature), False
    known, now = known or KeptDigests(), Conditions.of(armature)
    surfaces: dict[bpy.types.Object, str] = {}
    for take in filter(_is_told, takes_of(armature)):
        kept = action_settings(take.action)
        edit = settings if take.action == own else kept.edit
        stale = _unphysical(now, kept)
        if stale:
            pass  # of which the changes below may only be what follows
        elif take_digest(armature, present(take.source), known) != kept.take_key:
            stale = TAKE_CHANGED
        elif not _asks_the_same(edit, kept):
            stale = EDIT_CHANGED
        elif kept.surfaces_key and surfaces_digest(edit, armature, surfaces) != kept.surfaces_key:
            stale = SURFACES_CHANGED
        edited = own_digest(take.action, known) != kept.own_key
        polished = kept.holds_polish or edited
        if edited and take.action.library is None:  # who works on a result means to keep it
            guard(take.action)
        if (kept.stale, kept.polished) != (stale, polished):
            kept.stale, kept.polished = stale, polished
            new = True
    return new


def _is_told(take: ListedTake) -> bool:
    """Whether it is known what a take was when it was made: of results, but those of the earliest
    versions."""
    return take.source is not None and bool(action_settings(take.action).own_key)


def unphysical_since(armature: bpy.types.Object, result: bpy.types.Action) -> str:
    """What of the scene or of its armature's place makes a result unphysical, in words; "" for
    nothing, as for results of earlier versions."""
    return _unphysical(Conditions.of(armature), action_settings(result))


def _unphysical(now: Conditions, made: HangtimeAction) -> str:
    """The same of conditions."""
    if not made.conditions:
        return ""
    before = Conditions.read(str(made.conditions))
    return now.since(before, among_surfaces=bool(made.surfaces_key))


def _asks_the_same(edit: HangtimeSettings, kept: HangtimeAction) -> bool:
    """Whether an edit is what a result was made with. What is switched off asks for nothing, as do
    linked rows that an edit lacks; results of earlier versions count it."""
    targets = [row.target for row in kept.asked_targets]
    asked = str(kept.asked_key), targets
    return any(settings_digest(edit, NOT_ASKED, off=off) == asked for off in (False, True))


def polished_result(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The last result, where it has hand polish: was edited since it was made, or took it over."""
    result: bpy.types.Action | None = settings_of(armature).adapted
    if result is None or not action_settings(result).own_key:
        return None
    kept = action_settings(result)
    return result if kept.holds_polish or own_digest(result) != kept.own_key else None
