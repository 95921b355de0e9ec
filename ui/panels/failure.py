"""What a failed solve is told by: a short line, rows that lead to what is missed, and remedies."""

import bpy

from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.rows.kind import Icon
from ...operators.lists.choose_named import named_row
from ...operators.names import OperatorId
from ...operators.solve.session import session
from ...operators.words.failure_text import Failure
from ...solver.data.faults import NoFit, NoSolution, OddHeight, RenamedBones, UnseenSupport
from ..drawing.wrapping import wrapped
from .sidebar import lines


def draw_failure(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    armature: bpy.types.Object,
    *of: str,
) -> None:
    """Why the last solve of an armature failed, where it was one of these operators'."""
    failure = session().failure
    if failure is None or failure.uid != armature.session_uid or failure.of not in of:
        return
    box = layout.box().column()
    if failure.rows:
        lines(box, wrapped(context, failure.head), icon="ERROR")
        settings = settings_of(armature)
        for row in failure.rows:
            line = box.row()
            line.alignment = "LEFT"
            found = named_row(settings, row.name)
            if found is not None:
                icon: Icon = "CHECKBOX_HLT" if found.used else "CHECKBOX_DEHLT"
                tick = line.operator(OperatorId.TICK_NAMED, text="", icon=icon, emboss=False)
                tick.name = row.name
            text = wrapped(context, row.text, icons=2).splitlines()
            choose = line.operator(
                OperatorId.CHOOSE_NAMED, text=text[0], icon="RESTRICT_SELECT_OFF", emboss=False
            )
            choose.name = row.name
            if len(text) > 1:
                rest = box.row()
                rest.alignment = "LEFT"
                if found is not None:
                    rest.label(text="", icon="BLANK1")
                lines(rest, "\n".join(text[1:]), icon="BLANK1")
        lines(box, wrapped(context, failure.text))
    else:
        lines(box, wrapped(context, failure.text), icon="ERROR")
    _draw_remedy(box, failure, settings_of(armature))


def _draw_remedy(layout: bpy.types.UILayout, failure: Failure, settings: HangtimeSettings) -> None:
    match failure.fault:
        case UnseenSupport(rate=float() as rate):
            button = layout.operator(
                OperatorId.SET_FRAME_RATE, text=f"Set {rate:.5g} fps", icon="TIME"
            )
            button.rate = rate
        case UnseenSupport():
            layout.operator(OperatorId.EXAMINE, text="Examine the Recording", icon="VIEWZOOM")
        case OddHeight(factor=factor):
            layout.operator(OperatorId.SCALE_TO_HUMAN, icon="FULLSCREEN_EXIT").factor = factor
        case RenamedBones(paired=True):
            layout.operator(OperatorId.RENAME_KEYS, icon="FILE_REFRESH")
        case NoFit() as fault:
            _draw_untick(layout, failure, settings)
            _draw_trim(layout, fault)
            layout.operator(OperatorId.EXAMINE, text="Examine the Recording", icon="VIEWZOOM")
        case NoSolution():
            _draw_untick(layout, failure, settings)


def _draw_untick(layout: bpy.types.UILayout, failure: Failure, settings: HangtimeSettings) -> None:
    """A button that leaves out what is furthest off, and tries again."""
    worst = failure.rows[0].name if failure.rows else ""
    found = named_row(settings, worst)
    if found is not None and found.used:
        text = f"Untick {found.name}, Try Again"
        button = layout.operator(OperatorId.TICK_NAMED, text=text, icon="CHECKBOX_DEHLT")
        button.name, button.then = worst, failure.of


def _draw_trim(layout: bpy.types.UILayout, fault: NoFit) -> None:
    """A button for the longest part of the frame range without what cannot be held."""
    if fault.sound is not None:
        first, last = fault.sound
        text = f"Trim to Frames {first} to {last}"
        button = layout.operator(OperatorId.TRIM, text=text, icon="TIME")
        button.first, button.last = first, last
