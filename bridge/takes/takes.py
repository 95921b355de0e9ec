"""The takes of an armature: its recording, and the results that were made from it, or from each
other; each with its own edit.

An edit is what the artist asks of a take: the armature's settings. The one at work is the
armature's; the others wait with their actions.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import dataclass

import bpy

from ..accessors import HOLDS, current_action, made_for, present, root_of, source_of
from ..action_slots import copied_slots, lost_slot, settle_copy
from ..armature.actions import recorded_action, show
from ..armature.played import adopt_strip
from ..armature.traces_store import put_by, take_up
from ..marked_strips import MARKS
from ..properties.action import action_settings
from ..properties.settings import HangtimeSettings, settings_of
from ..properties.stances import move_empties
from ..rows.copying import copy_settings
from ..unkeyed import note_copied

OF_RECORDING = ("repairs", "findings", "examined", "examination_stale", "feet")
NOT_KEPT = ("marks", "adapted", "source", MARKS.name, *OF_RECORDING)
_Results = dict["bpy.types.Action", list["bpy.types.Action"]]
_LONGEST = 63 - len(" adapted 99")  # bytes of a name of which the rest is ours


@dataclass(frozen=True)
class ListedTake:
    """A take of an armature. source: what it was made from; None of the recording. depth: how many
    results it was made from, one after the other."""

    action: bpy.types.Action
    source: bpy.types.Action | None
    depth: int
    shown: bool
    stale: str
    polished: bool


def derive(action: bpy.types.Action, source: bpy.types.Action, armature: bpy.types.Object) -> None:
    """Note that an armature's settings made an action from a take: it is a result now."""
    made = action_settings(action)
    made.recording, made.maker, made.owned = source, armature, True
    action[HOLDS] = True
    adopt_strip(armature, source)
    made.count = 1 + max(action_settings(other).count for other in bpy.data.actions)


def adopt_copied_slots(armature: bpy.types.Object) -> None:
    """Where an armature was copied with its action (Shift-D), in which results are slots: has it
    results of its own of these slots' copies, which would be taken for recordings. Copies of
    results of other armatures that share the recording are nobody's."""
    settings, data = settings_of(armature), armature.animation_data
    known = settings.adapted or settings.source
    action = data.action if data is not None else None
    if known is None or action is None or action.library is not None:
        return
    copies = {r: slot for r, slot in copied_slots(action).items() if root_of(r) == root_of(known)}
    if not copies:
        return
    shown, maker = data.action_slot, action_settings(known).maker
    own = {r for r in copies if action_settings(r).maker == maker or copies[r] == shown}
    if action.users - action.use_fake_user > 1:  # the others may have been copied, too
        copies = {r: slot for r, slot in copies.items() if r in own}
    _adopt(armature, action, copies, own)


def _adopt(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    copies: dict[bpy.types.Action, bpy.types.ActionSlot],
    listed: Collection[bpy.types.Action],
) -> None:
    """Have an armature results of its own. copies: of results that are slots the slots' copies in
    its action. listed: those of them whose copies are the armature's."""
    settings = settings_of(armature)
    own = {result: result.copy() for result in copies}
    for result, copy in own.items():
        settle_copy(copy, (action, copies[result]))
        copy.use_fake_user = result.use_fake_user
        made = action_settings(copy)
        made.recording = own.get(made.recording, action)
        note_copied(copy, action)
        made.maker, made.owned = armature if result in listed else None, True
    settings.adapted = own.get(settings.adapted, settings.adapted)
    settings.source = own.get(settings.source, settings.source)


def free_name(root: str, word: str) -> str:
    """A name for a new action that is made from a recording: "jump adapted", then "jump adapted 2".

    Of a long name the end goes, as Blender would cut the word off instead.
    """
    root = root.encode()[:_LONGEST].decode(errors="ignore")
    first = f"{root} {word}"
    names = (first if count == 1 else f"{first} {count}" for count in itertools.count(1))
    return next(name for name in names if name not in bpy.data.actions)


def takes_of(armature: bpy.types.Object) -> tuple[ListedTake, ...]:
    """The recording that an armature shows a take of, and the results that were made for it; of
    those for another armature only the shown one, and what that was made from."""
    shown = current_action(armature)
    if shown is None:
        return ()
    line = [shown]
    while (source := source_of(line[-1])) is not None:
        line.append(source)
    listed = {
        source: [each for each in results if each in line or made_for(armature, each)]
        for source, results in _results().items()
    }
    return tuple(_branch(line[-1], shown, listed, 0))


def _branch(
    action: bpy.types.Action, shown: bpy.types.Action, made: _Results, depth: int
) -> list[ListedTake]:
    """A take and what was made from it. made: the results that are listed."""
    kept = action_settings(action)
    found = [
        ListedTake(action, source_of(action), depth, action == shown, kept.stale, kept.polished)
    ]
    for other in made.get(action, ()):
        found += _branch(other, shown, made, depth + 1)
    return found


def results_from(
    action: bpy.types.Action, armature: bpy.types.Object | None = None
) -> list[bpy.types.Action]:
    """The results that were made from a take, the newest last. armature: for which; None for
    any."""
    found = _results().get(action, [])
    return [each for each in found if armature is None or made_for(armature, each)]


def _results() -> _Results:
    """All results in the file, by what they were made from, the newest last. It takes a look at
    every action: one serves for all takes of a list, which is drawn often."""
    results = [o for o in bpy.data.actions if source_of(o) is not None and not lost_slot(o)]
    found: _Results = {}
    for each in sorted(results, key=lambda result: int(action_settings(result).count)):
        found.setdefault(present(source_of(each)), []).append(each)
    return found


def show_take(armature: bpy.types.Object, action: bpy.types.Action) -> None:
    """Let an armature perform one of its takes, with the edit that belongs to it at work.

    The recording and the last result made from it share an edit: between these nothing changes.
    """
    about_recording = source_of(action) is None and action == recorded_action(armature)
    if action != settings_of(armature).adapted and not about_recording:
        keep_edit(armature)
        _take_up(armature, action)
    show(armature, action)


def keep_edit(armature: bpy.types.Object) -> None:
    """Put the edit at work down with the result that it led to, or with the take it is about."""
    settings, source = settings_of(armature), recorded_action(armature)
    result = own_result(armature)
    if result is not None:
        copy_settings(settings, action_settings(result).edit, NOT_KEPT)
    elif source is not None:
        source[HOLDS] = True
        copy_settings(settings, action_settings(source).next_edit, NOT_KEPT)
    owner = result or source
    if owner is not None:
        put_by(armature, owner)


def own_result(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The result of the edit at work; a copied armature points to one whose edit is another's."""
    result: bpy.types.Action | None = settings_of(armature).adapted
    return result if result is not None and made_for(armature, result) else None


def _take_up(armature: bpy.types.Object, action: bpy.types.Action) -> None:
    """Make the edit of a take the one at work."""
    settings, source = settings_of(armature), source_of(action)
    made = results_from(action, armature)
    if source is None and made:  # the recording: with what was last made from it
        action, source = made[-1], action
    take_up(armature, action)
    if source is None:
        settings.adapted, settings.source = None, None
        _restore(settings, action_settings(action).next_edit)
        return
    settings.adapted = action
    settings.source = source if source_of(source) is not None else None
    _restore(settings, action_settings(action).edit)


def _restore(settings: HangtimeSettings, edit: HangtimeSettings) -> None:
    copy_settings(edit, settings, NOT_KEPT)
    move_empties(settings)
