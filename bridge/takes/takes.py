"""The takes of an armature: its recording, and the results that were made from it, or from each
other; each with its own edit.

An edit is what the artist asks of a take: the armature's settings. The one at work is the
armature's; the others wait with their actions.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Collection
from dataclasses import dataclass

import bpy

from ..accessors import HOLDS, current_action, made_for, present, root_of, source_of
from ..action_slots import copied_slots, lost_slot, settle_copy
from ..armature.actions import recorded_action, show
from ..armature.fcurves import slot_identifier
from ..armature.keys_digest import keys_digest
from ..armature.played import adopt_strip, in_scene_time, strip_time
from ..armature.traces_store import forget, put_by, take_up
from ..fake_users import guard
from ..hidden_texts import spans_text
from ..marked_strips import MARKS
from ..properties.action import HangtimeAction, action_settings
from ..properties.overridden_lists import linked_count
from ..properties.settings import HangtimeSettings, settings_of
from ..properties.stances import move_empties
from ..rows.choices import Span
from ..rows.copying import (
    OUTCOMES,
    HeldSettings,
    copy_settings,
    held_settings,
    put_settings,
    rows_named,
    settings_digest,
    settings_targets,
)
from ..scene.surfaces_digest import Conditions, surfaces_digest
from .difference import bake_combined, difference_shown
from .span import ResultSpan

_OF_RECORDING = ("repairs", "findings", "examined", "examination_stale", "feet")
_NOT_ASKED = (  # of the next result
    *("marks", "adapted", "source", MARKS.name, "status", "met", "measured_height", "fit_quality"),
    *("shapes_told", "unseen", "analysed_motion", "analysed_span", "analysed_contacts"),
    *("whole_stance", "moving", "active_contact", "active_constraint", "active_surface"),
    *("active_body_change", "analysed_state"),
    *("keep_polish", *_OF_RECORDING),
)
_NOT_KEPT = ("marks", "adapted", "source", MARKS.name, *_OF_RECORDING)
SPANS = spans_text("spans")
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


@dataclass(frozen=True)
class AskedSettings:
    """Settings as they were when a result was asked for, after which the artist may go on changing
    them. key: their digest. surfaces: that of the surfaces among which they asked for it.
    conditions: as text what else there was."""

    held: HeldSettings
    key: str
    surfaces: str
    conditions: str

    @staticmethod
    def of(settings: HangtimeSettings) -> AskedSettings:
        """Of what an armature's settings are now, without what solves told of them."""
        held = held_settings(settings, (*_NOT_KEPT, *OUTCOMES))
        armature = settings.id_data
        assert isinstance(armature, bpy.types.Object)
        surfaces = surfaces_digest(settings, armature, {})
        key = settings_digest(settings, _NOT_ASKED, off=False)
        return AskedSettings(held, key, surfaces, Conditions.of(armature).as_text())


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
    result = _own_result(armature)
    if result is not None:
        copy_settings(settings, action_settings(result).edit, _NOT_KEPT)
    elif source is not None:
        source[HOLDS] = True
        copy_settings(settings, action_settings(source).next_edit, _NOT_KEPT)
    owner = result or source
    if owner is not None:
        put_by(armature, owner)


def _own_result(armature: bpy.types.Object) -> bpy.types.Action | None:
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
    copy_settings(edit, settings, _NOT_KEPT)
    move_empties(settings)


def starts_from_result(armature: bpy.types.Object) -> bool:
    """Whether the next result is made from a result, and not from the recording."""
    source = recorded_action(armature)
    return source is not None and source_of(source) is not None


def start_from_result(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Make the next results from a result: a second jump builds on the first, and hand polish
    stays. Contacts are to be found anew; limits that always hold stay."""
    keep_edit(armature)
    bake_shown(armature, result)
    settings = settings_of(armature)
    settings.source, settings.adapted = result, None
    rows_named(settings.contacts, ())
    rows_named(settings.stances, ())
    _drop_constraints(armature, settings)
    forget(armature)
    settings.analysed = settings.analysed_motion = settings.analysed_contacts = ""
    settings.analysed_state = settings.unseen = settings.fit_quality = settings.status = ""
    result.use_fake_user = True
    show(armature, result)


def _drop_constraints(armature: bpy.types.Object, settings: HangtimeSettings) -> None:
    """But for those that always hold; an override's linked ones are switched off."""
    linked = linked_count(armature, "constraints")
    for index in reversed(range(len(settings.constraints))):
        if settings.constraints[index].span == Span.ALWAYS.name:
            continue
        if index < linked:
            settings.constraints[index].used = False
        else:
            settings.constraints.remove(index)


def start_from_recording(armature: bpy.types.Object) -> None:
    """Make the next results from the recording again, with the edit that belongs to it."""
    source = recorded_action(armature)
    if source is not None:
        show_take(armature, root_of(source))


# ---------------------------------------------------------------- what became of them


def note_made(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    span: ResultSpan | None,
    later: int,
    asked: AskedSettings | None = None,
) -> None:
    """Keep with a new result its edit, and what it and its take are now.

    asked: what it was made with; None for the settings as they are.
    """
    made, source = action_settings(action), source_of(action)
    assert source is not None
    asked = asked or AskedSettings.of(settings_of(armature))
    copy_settings(settings_of(armature), made.edit, _NOT_KEPT)
    put_settings(asked.held, made.edit)
    made.asked_key, made.surfaces_key = asked.key, asked.surfaces
    made.conditions = asked.conditions
    made.asked_targets.clear()
    for target in settings_targets(made.edit, _NOT_ASKED, off=False):
        made.asked_targets.add().target = target
    made.take_key, made.own_key = take_digest(armature, source), _digest(action)
    made.stale, made.polished, made.holds_polish = "", False, False
    spans = []
    if span is not None:
        for first, last in adapted_spans(source):
            if last <= span.first:
                spans.append((first, last))
            elif first + later >= span.last:
                spans.append((first + later, last + later))
        spans.append((span.first, span.last))
    made.spans = json.dumps(spans)


def adapted_spans(action: bpy.types.Action) -> tuple[tuple[float, float], ...]:
    """First and last frame of each adaptation that a take holds."""
    return SPANS.of(action_settings(action).spans)


TAKE_CHANGED = "The take below has changed"
EDIT_CHANGED = "The settings have changed"
SURFACES_CHANGED = "A surface has changed"


def look_again(armature: bpy.types.Object) -> bool:
    """Note which results are not what would be made now, and which were edited by hand.

    Returns whether anything is new.
    """
    settings, own, new = settings_of(armature), _own_result(armature), False
    keys: dict[bpy.types.Action, str] = {}
    sources: dict[bpy.types.Action, str] = {}
    surfaces: dict[bpy.types.Object, str] = {}
    for take in takes_of(armature):
        kept = action_settings(take.action)
        if take.source is None or not kept.own_key:
            continue
        if take.action not in keys:
            keys[take.action] = _digest(take.action)
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
        settings_targets(edit, _NOT_ASKED, off=off) == targets
        and settings_digest(edit, _NOT_ASKED, off=off) == str(kept.asked_key)
        for off in (False, True)
    )


def polished_result(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The last result, where it has hand polish: was edited since it was made, or took it over."""
    result: bpy.types.Action | None = settings_of(armature).adapted
    if result is None or not action_settings(result).own_key:
        return None
    kept = action_settings(result)
    return result if kept.holds_polish or _digest(result) != kept.own_key else None


def take_digest(armature: bpy.types.Object, take: bpy.types.Action) -> str:
    """Of the keys of what results are made from, and of when a strip plays it."""
    time, found = strip_time(armature, take), _digest(take)
    return found if time is None else f"{found} {time}"


def _digest(action: bpy.types.Action) -> str:
    """Of a take's keys, and of the difference that is edited in its stead."""
    difference = difference_shown(action)
    own = keys_digest(action)
    return own if difference is None else f"{own} {keys_digest(difference)}"


def bake_shown(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Make a result that is combined with its take what its strip shows, where either was edited;
    before it is built upon, or leaves the file."""
    made, source = action_settings(result), source_of(result)
    if source is None or difference_shown(result) is None:
        return
    now = _digest(result)
    if (take_digest(armature, source), now) != (made.take_key, made.own_key):
        _, _, difference = now.partition(" ")
        made.holds_polish |= difference != made.own_key.partition(" ")[2]
        with in_scene_time(armature, source) as take:
            bake_combined(result, take, slot_identifier(armature))
        made.own_key = _digest(result)
