"""What the extension stores on actions: of what an adapted one was made, and what was found."""

from __future__ import annotations

from typing import cast

import bpy

from ..accessors import attached, called
from ..fake_users import guard
from ..rows.row import HIDDEN, declared
from ..rows.stored import boolean, target, text, whole
from .settings import HangtimeSettings


class HangtimeAskedFor(bpy.types.PropertyGroup):
    """A data-block that settings point to."""

    target: declared(target(type=bpy.types.ID), options=HIDDEN)


def _get_called(made: HangtimeAction) -> str:
    return called(cast(bpy.types.Action, made.id_data))


def _set_called(made: HangtimeAction, to: str) -> None:
    action = cast(bpy.types.Action, made.id_data)
    if to not in ("", _get_called(made)) and action.is_editable:  # a linked one keeps its name
        action.name = to
        if made.own_key:  # who names a result means to keep it
            guard(action)


class HangtimeAction(bpy.types.PropertyGroup):
    """Of an adapted action: the take that it was made from, how, and what was found.

    unfilled: of a recording into which missing frames were put, the one without.
    maker: the armature whose settings asked for it. owned: whether there was one, who may be
    deleted; earlier versions did not keep it. count: how many results there were, itself
    included, when it was made. edit: what was asked for, and the artist's changes to that since.
    next_edit: of a take from which nothing is made yet. asked_key, take_key, own_key: digests of
    the settings, of the take's keys and of its own when it was made. asked_targets: the data-blocks
    that the settings pointed to then. surfaces_key: digest of the surfaces then; empty where an
    earlier version kept none. conditions: what else its physics depended on then
    (`Conditions`, as text), likewise. spans: the frames of all adaptations that it holds.
    """

    called: declared(text("Name", get=_get_called, set=_set_called), options=HIDDEN)

    recording: declared(target(type=bpy.types.Action), options=HIDDEN)
    unfilled: declared(target(type=bpy.types.Action), options=HIDDEN)
    maker: declared(target(), options=HIDDEN)
    owned: declared(boolean(), options=HIDDEN)
    count: declared(whole(), options=HIDDEN)
    edit: bpy.props.PointerProperty(type=HangtimeSettings, options=HIDDEN)
    next_edit: bpy.props.PointerProperty(type=HangtimeSettings, options=HIDDEN)
    asked_key: declared(text(), options=HIDDEN)
    asked_targets: bpy.props.CollectionProperty(type=HangtimeAskedFor, options=HIDDEN)
    surfaces_key: declared(text(), options=HIDDEN)
    conditions: declared(text(), options=HIDDEN)
    take_key: declared(text(), options=HIDDEN)
    own_key: declared(text(), options=HIDDEN)
    spans: declared(text(), options=HIDDEN)
    warning: declared(text(), options=HIDDEN)  # what is beyond reason in it: lines
    stale: declared(text(), options=HIDDEN)  # why it is not what would be made now
    polished: declared(boolean(), options=HIDDEN)  # edited by hand
    holds_polish: declared(boolean(), options=HIDDEN)  # not since, but of the one before it
    refined: declared(boolean(), options=HIDDEN)  # by Refine, whose weights are of its edit
    performer: declared(target(), options=HIDDEN)  # of other limbs; none: who has the recording
    accepted: declared(boolean(), options=HIDDEN)
    lengthens: declared(boolean(), options=HIDDEN)  # the scene, which goes to its end
    report: declared(text(), options=HIDDEN)  # the report's text
    times: declared(text(), options=HIDDEN)  # its time map: recorded frames, adapted frames
    overlaps: declared(text(), options=HIDDEN)  # what is in what: of the recording, of itself
    known_contacts: declared(text(), options=HIDDEN)  # of the frames that adaptations wrote


def action_settings(action: bpy.types.Action) -> HangtimeAction:
    """Of an adapted action; empty for others."""
    settings: HangtimeAction = attached(action)
    return settings
