"""What results are made with, which is kept with them."""

from __future__ import annotations

import json
from dataclasses import dataclass

import bpy

from ..accessors import source_of
from ..hidden_texts import spans_text
from ..marked_strips import MARKS
from ..properties.action import action_settings
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.copying import (
    OUTCOMES,
    HeldSettings,
    copy_settings,
    held_settings,
    put_settings,
    settings_digest,
)
from ..scene.surfaces_digest import Conditions, surfaces_digest
from ..takes.span import ResultSpan
from ..takes.takes import NOT_KEPT, OF_RECORDING
from .digests import own_digest, take_digest

SPANS = spans_text("spans")
NOT_ASKED = (  # of the next result
    *("marks", "adapted", "source", MARKS.name, "status", "met", "measured_height", "fit_quality"),
    *("shapes_told", "unseen", "analysed_motion", "analysed_span", "analysed_contacts"),
    *("whole_stance", "moving", "active_contact", "active_constraint", "active_surface"),
    *("active_body_change", "analysed_state"),
    *("keep_polish", *OF_RECORDING),
)


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
        held = held_settings(settings, (*NOT_KEPT, *OUTCOMES))
        armature = settings.id_data
        assert isinstance(armature, bpy.types.Object)
        surfaces = surfaces_digest(settings, armature, {})
        key, _ = settings_digest(settings, NOT_ASKED, off=False)
        return AskedSettings(held, key, surfaces, Conditions.of(armature).as_text())


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
    copy_settings(settings_of(armature), made.edit, NOT_KEPT)
    put_settings(asked.held, made.edit)
    made.asked_key, made.surfaces_key = asked.key, asked.surfaces
    made.conditions = asked.conditions
    made.asked_targets.clear()
    _, targets = settings_digest(made.edit, NOT_ASKED, off=False)
    for target in targets:
        made.asked_targets.add().target = target
    made.take_key, made.own_key = take_digest(armature, source), own_digest(action)
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
