"""Save Plots: the plotted curves as a table."""

import csv
from io import StringIO
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper

from ...bridge.plots.charts import kept_takes
from ...bridge.plots.curves import table
from ..files.outbox import Outbox
from ..names import OperatorId
from ..operator_types import FROM_BLEND, OperatorResult
from ..solve.common import NO_FILE, FaultyOperator, chosen_armature, required_armature

NOTHING_TO_PLOT = "Press Analyze first: there is no motion to plot"
DIGITS = 6  # of a plotted value in the table


# The stubs take `check` and `invoke` of the mixin for functions that return nothing.
class SavePlotsOperator(FaultyOperator, bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    bl_idname = OperatorId.SAVE_PLOTS
    bl_label = "Save Plots"
    bl_description = (
        "Save centre of mass, contact forces and torques of the recording and of the adapted "
        "motion as a table (CSV), frame by frame"
    )

    filename_ext = ".csv"
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options=FROM_BLEND)
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        return NOTHING_TO_PLOT if armature is None or not kept_takes(armature) else None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:  # type: ignore[override]
        if not self.filepath:
            folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path()
            self.filepath = str(folder / f"{required_armature(context).name} plots.csv")
        return ExportHelper.invoke(self, context, event)  # type: ignore[func-returns-value, return-value]

    def run(self, context: bpy.types.Context) -> OperatorResult:
        if not bpy.path.basename(self.filepath):
            return self.refuse(NO_FILE)
        takes = {take: kept.traces for take, kept in kept_takes(required_armature(context)).items()}
        path = Path(bpy.path.abspath(self.filepath))
        with Outbox(path.parent) as outbox:
            outbox.write_text(path.name, _csv(*table(takes)))
            outbox.deliver()
        self.report({"INFO"}, f"Saved {path.name}")
        return {"FINISHED"}


def _csv(headings: list[str], lines: list[list[float | None]]) -> str:
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(headings)
    for line in lines:
        writer.writerow("" if v is None else f"{v:.{DIGITS}g}" for v in line)
    return text.getvalue()
