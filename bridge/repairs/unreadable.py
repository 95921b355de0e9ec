"""What is not Hangtime's, in the properties of an armature and of the takes at work."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from ...solver.data.faults import TextCure, UnreadableText
from ..accessors import current_action
from ..armature import traces_store
from ..armature.actions import recorded_action
from ..hidden_texts import HiddenText
from ..properties.action import action_settings
from ..properties.of_actions.known_contacts import KNOWN
from ..properties.of_actions.shown_overlaps import OVERLAPS
from ..properties.of_actions.shown_times import TIMES
from ..properties.settings import settings_of
from ..results.made import SPANS
from ..rows.phases import UNSEEN
from ..unkeyed import UNKEYED
from .analysed_state import STATE
from .stored import FEET, is_finding


def require_readable(armature: bpy.types.Object) -> None:
    """That what a solve takes from such texts can be read: what carries unseen, and which frames of
    the take are adapted already. Raises UnreadableText."""
    recorded = recorded_action(armature)
    if not UNSEEN.is_ours(settings_of(armature).unseen):
        raise UnreadableText(armature.name, UNSEEN.name, TextCure.ANALYZE)
    if recorded is not None and not SPANS.is_ours(action_settings(recorded).spans):
        raise UnreadableText(recorded.name, SPANS.name, TextCure.ADAPT)


def unreadable_texts(armature: bpy.types.Object) -> Iterator[UnreadableText]:
    """Every text that is not Hangtime's, as a fault; what is read of them is nothing."""
    settings = settings_of(armature)
    if not UNSEEN.is_ours(settings.unseen):
        yield UnreadableText(armature.name, UNSEEN.name, TextCure.ANALYZE)
    if not STATE.is_ours(settings.analysed_state):
        yield UnreadableText(armature.name, STATE.name, TextCure.ANALYZE)
    if not FEET.is_ours(settings.feet):
        yield UnreadableText(armature.name, FEET.name, TextCure.EXAMINE)
    if not traces_store.is_ours(armature):
        yield UnreadableText(armature.name, traces_store.CONTENT, TextCure.ANALYZE)
    if not all(is_finding(row) for row in settings.findings):
        yield UnreadableText(armature.name, "findings", TextCure.EXAMINE)
    takes = (recorded_action(armature), current_action(armature), settings.adapted)
    for action in dict.fromkeys(take for take in takes if take is not None):
        made = action_settings(action)
        texts: tuple[tuple[HiddenText[Any], object], ...] = (
            (SPANS, made.spans),
            (TIMES, made.times),
            (OVERLAPS, made.overlaps),
            (KNOWN, made.known_contacts),
            (UNKEYED, action.get(UNKEYED.name)),
        )
        for text, stored in texts:
            if not text.is_ours(stored):
                yield UnreadableText(action.name, text.name, TextCure.ADAPT)
        if not traces_store.is_ours(action):
            yield UnreadableText(action.name, traces_store.CONTENT, TextCure.ADAPT)
