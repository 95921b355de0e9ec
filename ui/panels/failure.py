"""What a failed solve is told by: a short line, rows that lead to what is missed, and remedies."""

from textwrap import fill

import bpy

from ...bridge.accessors import present
from ...operators.names import OperatorId
from ...operators.solve.session import session
from ...operators.words.failure_text import Failure
from ...solver.data.faults import OddHeight, UnseenSupport
from ..drawing.editor import ui_scale
from .sidebar import lines

CHARACTER_PX = 6.8  # at an interface scale of 1
ICON_PX = 60  # an icon, and the panel's margins
LEAST_LETTERS = 16


def wrapped(context: bpy.types.Context, text: str) -> str:
    """Text in lines that the sidebar has room for, beside an icon."""
    scale = ui_scale(context)
    width = (present(context.region).width - ICON_PX * scale) / (CHARACTER_PX * scale)
    letters = max(LEAST_LETTERS, int(width))
    return "\n".join(fill(line, letters) for line in text.splitlines())


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
        for row in failure.rows:
            line = box.row()
            line.alignment = "LEFT"
            text = wrapped(context, row.text).splitlines()
            choose = line.operator(
                OperatorId.CHOOSE_NAMED, text=text[0], icon="RESTRICT_SELECT_OFF", emboss=False
            )
            choose.name = row.name
            if len(text) > 1:
                lines(box, "\n".join(text[1:]), icon="BLANK1")
        lines(box, wrapped(context, failure.text))
    else:
        lines(box, wrapped(context, failure.text), icon="ERROR")
    _draw_remedy(box, failure)


def _draw_remedy(layout: bpy.types.UILayout, failure: Failure) -> None:
    match failure.fault:
        case UnseenSupport(rate=int() as rate):
            button = layout.operator(OperatorId.SET_FRAME_RATE, text=f"Set {rate} fps", icon="TIME")
            button.rate = rate
        case OddHeight(factor=factor):
            layout.operator(OperatorId.SCALE_TO_HUMAN, icon="FULLSCREEN_EXIT").factor = factor
