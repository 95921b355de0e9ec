"""Export: the accepted action alone, as FBX or glTF; the plotted curves as a table."""

import csv
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper

from ...bridge.accessors import present
from ...bridge.files.export import export_fbx, export_gltf
from ...bridge.plots.charts import kept_takes
from ...bridge.plots.curves import table
from ...bridge.properties.settings import action_settings
from ...solver.data.faults import OutputNotWritable
from ..headless.outbox import Outbox
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import FaultyOperator, chosen_armature, required_armature
from ..solve.results import performer_of, required_result, result_of

NO_NAME = "no file name is given"
NOTHING_TO_PLOT = "Press Analyze first: there is no motion to plot"
DIGITS = 6  # of a plotted value in the table
NOT_ACCEPTED = "Accept a result first; what is exported is the accepted action"


class _Export(FaultyOperator):
    """Mixin: asks for a file, and writes the accepted action to it."""

    extension = ""
    write: Callable[[bpy.types.Object, bpy.types.Action, str], None]

    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        result = result_of(chosen_armature(context))
        accepted = result is not None and action_settings(result).accepted
        return None if accepted else NOT_ACCEPTED

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path.home()
        name = bpy.path.clean_name(required_result(context).name)
        self.filepath = str((folder / name).with_suffix(self.extension))
        present(context.window_manager).fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        if not bpy.path.basename(self.filepath):
            raise OutputNotWritable(self.filepath, NO_NAME)
        path = bpy.path.ensure_ext(bpy.path.abspath(self.filepath), self.extension)
        self.write(performer_of(armature), required_result(context), path)
        self.report({"INFO"}, f"Exported {Path(path).name}")
        return {"FINISHED"}


class ExportFbxOperator(_Export, bpy.types.Operator):
    bl_idname = OperatorId.EXPORT_FBX
    bl_label = "Export FBX"
    bl_description = "Write the armature with the accepted action, a key on every frame, as FBX"
    extension = ".fbx"
    write = staticmethod(export_fbx)

    filter_glob: bpy.props.StringProperty(default="*.fbx", options={"HIDDEN"})


class ExportGltfOperator(_Export, bpy.types.Operator):
    bl_idname = OperatorId.EXPORT_GLTF
    bl_label = "Export glTF"
    bl_description = "Write the armature with the accepted action as one binary glTF file"
    extension = ".glb"
    write = staticmethod(export_gltf)

    filter_glob: bpy.props.StringProperty(default="*.glb", options={"HIDDEN"})


# The stubs take `check` and `invoke` of the mixin for functions that return nothing.
class SavePlotsOperator(FaultyOperator, bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    bl_idname = OperatorId.SAVE_PLOTS
    bl_label = "Save Plots"
    bl_description = (
        "Save centre of mass, contact forces and torques of the recording and of the adapted "
        "motion as a table (CSV), frame by frame"
    )

    filename_ext = ".csv"
    filter_glob: bpy.props.StringProperty(default="*.csv", options={"HIDDEN"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        return NOTHING_TO_PLOT if armature is None or not kept_takes(armature) else None

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:  # type: ignore[override]
        if not self.filepath:  # type: ignore[has-type]
            folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path()
            self.filepath = str(folder / f"{required_armature(context).name} plots.csv")
        return ExportHelper.invoke(self, context, event)  # type: ignore[func-returns-value, return-value]

    def run(self, context: bpy.types.Context) -> OperatorResult:
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
