"""What is wrong with the recording, with remedies: rows of the panel Recording."""

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.repairs.analysis_key import repaired_since
from ...bridge.repairs.stored import (
    applied,
    finding_of,
    findings,
    is_applied,
    rate_unrepaired,
    repairs_in,
)
from ...bridge.rows.finding import HangtimeFinding
from ...bridge.rows.kind import Icon
from ...operators.names import OperatorId
from ...operators.recording.repair import has_remedy
from ...operators.solve.common import chosen_armature
from ...operators.words.doctor_text import (
    HEALTHY,
    finding_sentence,
    remedy_label,
    remedy_text,
)
from ...solver.doctor.repairs import Repairs
from ..drawing.wrapping import wrapped
from .failure import draw_failure
from .setup import RecordingPanel
from .sidebar import ArmaturePanel, draw_at_work, lines, settings_in

STALE = "The recording has changed since: examine it again"
REPAIRED_SINCE = "Repaired since the analysis: analyze again"
BY_RECIPE = "Repaired already: {}"


class FindingsPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_findings"
    bl_parent_id = RecordingPanel.bl_idname
    bl_label = "What Is Wrong"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        settings = settings_in(context)
        wrong = sum(_icon(settings, row) == "ERROR" for row in findings(settings))
        if wrong:
            present(self.layout).label(text=str(wrong), icon="ERROR")

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        armature = present(chosen_armature(context))
        settings, rows = settings_of(armature), findings(settings_of(armature))
        if not draw_at_work(layout, OperatorId.EXAMINE):
            buttons = layout.row(align=True)
            buttons.operator(OperatorId.EXAMINE, icon="VIEWZOOM")
            if rows:
                buttons.operator(OperatorId.REPAIR_ALL, icon="MODIFIER")
        draw_failure(layout, context, armature, OperatorId.EXAMINE)
        if settings.examination_stale:
            lines(layout, wrapped(context, STALE), icon="FILE_REFRESH")
        elif settings.examined and not rows:
            lines(layout, wrapped(context, HEALTHY), icon="CHECKMARK")
        for row in rows:
            _draw_finding(layout.box().column(), context, settings, row)
        repairs = applied(settings)
        if repairs != Repairs() and not rows:
            lines(layout, wrapped(context, BY_RECIPE.format(remedy_text(repairs))), icon="MODIFIER")
        if repaired_since(settings):
            lines(layout, wrapped(context, REPAIRED_SINCE), icon="FILE_REFRESH")


def _icon(settings: HangtimeSettings, row: HangtimeFinding) -> Icon:
    """The severity: repaired, a note, damage."""
    if any(is_applied(settings, row, other=other) for other in (False, True)):
        return "CHECKMARK"
    return "INFO" if finding_of(row).kind.note else "ERROR"


def _draw_finding(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    settings: HangtimeSettings,
    row: HangtimeFinding,
) -> None:
    """A sentence, which leads to the frames, and the remedies' ticks."""
    finding = finding_of(row)
    first, *rest = wrapped(context, finding_sentence(finding)).splitlines()
    line = layout.row()
    line.alignment = "LEFT"
    icon = _icon(settings, row)
    show = line.operator(OperatorId.SHOW_FINDING, text=first, icon=icon, emboss=False)
    show.kind = row.name
    if rest:
        lines(layout, "\n".join(f"       {each}" for each in rest))
    if not has_remedy(row):
        return
    buttons = layout.row(align=True)
    for other, stored in ((False, row.remedy), (True, row.other)):
        if other and not stored:
            continue
        used = is_applied(settings, row, other=other)
        tick: Icon = "CHECKBOX_HLT" if used else "CHECKBOX_DEHLT"
        text = remedy_label(finding, repairs_in(stored), row.mass, rate_unrepaired(settings))
        button = buttons.operator(OperatorId.REPAIR, text=text, icon=tick, depress=used)
        button.kind, button.other = row.name, other
