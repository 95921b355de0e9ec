"""Export Recipe: what the panels ask for as a recipe, so that the command line solves the same."""

import os
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.io_utils import ExportHelper

from ...bridge.armature.actions import showing_recorded
from ...bridge.armature.incremental import complete
from ...bridge.formats.obj import obj_text
from ...bridge.properties.settings import settings_of
from ...bridge.recipe.object_texts import mesh_files
from ...bridge.recipe.problem import write_recipe
from ...bridge.recipe.shortest import shortest
from ...bridge.repairs.stored import repairs_to_write
from ...bridge.scene.moving_empties import take_places
from ...bridge.takes.options import result_options
from ...solver.data.problem import MotionProblem
from ...solver.data.scene import SceneObject
from ...solver.data.solver_options import Method
from ..files.outbox import Outbox
from ..names import OperatorId
from ..operator_types import FROM_BLEND, OperatorResult
from ..solve.adapt import ask_for, unanalysed
from ..solve.common import NO_FILE, FaultyOperator, required_armature
from ..solve.written.keys import key_options

EXPORTED = "Exported {}"
NO_CLIP = "; it names no recording until this file is saved: name one as CLIP on the command line"


# The stubs take `check` and `invoke` of the mixin for functions that return nothing.
class ExportRecipeOperator(FaultyOperator, bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    bl_idname = OperatorId.EXPORT_RECIPE
    bl_label = "Export Recipe"
    bl_description = (
        "Write pins, constraints, the surfaces of the panel World, the rest of the take and the "
        "keys as a recipe for the command line, with an OBJ file beside it for each mesh that is "
        "no box or ramp"
    )

    filename_ext = ".toml"
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", options=FROM_BLEND)
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return unanalysed(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:  # type: ignore[override]
        if not self.filepath:
            folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path()
            self.filepath = str(folder / f"{required_armature(context).name}.toml")
        return ExportHelper.invoke(self, context, event)  # type: ignore[func-returns-value, return-value]

    def run(self, context: bpy.types.Context) -> OperatorResult:
        if not bpy.path.basename(self.filepath):
            return self.refuse(NO_FILE)
        armature = required_armature(context)
        settings = settings_of(armature)
        complete(take_places(settings, showing_recorded(armature)))
        asked = complete(ask_for(context))
        problem = shortest(_as_adapted(asked.problem, settings.method))
        path = Path(bpy.path.abspath(self.filepath))
        files = mesh_files(problem.scene)
        with Outbox(path.parent) as outbox:
            text = write_recipe(
                problem,
                clip=_clip(path),
                files=files,
                result=shortest(result_options(settings)),
                keys=shortest(key_options(settings)),
                repairs=repairs_to_write(settings),
            )
            outbox.write_text(path.name, text)
            for thing in problem.scene:
                if thing.name in files:
                    outbox.write_text(files[thing.name], obj_text(thing.vertices, thing.triangles))
            written = outbox.deliver()
        said = EXPORTED.format(", ".join(each.name for each in written))
        self.report({"INFO"}, said if bpy.data.filepath else said + NO_CLIP)
        return {"FINISHED"}


def _as_adapted(problem: MotionProblem, method: str) -> MotionProblem:
    """What Adapt solves: by the chosen method, still objects without a frame."""
    requests, solution = problem.requests, problem.requests.solution
    if solution.method is Method.IMPLICIT:
        requests = replace(requests, solution=replace(solution, method=Method[method]))
    return replace(problem, requests=requests, scene=tuple(map(_frameless, problem.scene)))


def _frameless(thing: SceneObject) -> SceneObject:
    return replace(thing, frames=np.zeros(1)) if len(thing.frames) == 1 else thing


def _clip(recipe: Path) -> str | None:
    """The open file, as seen from the recipe; None where it is not saved."""
    if not bpy.data.filepath:
        return None
    blend = Path(bpy.data.filepath).resolve()
    try:
        return Path(os.path.relpath(blend, recipe.resolve().parent)).as_posix()
    except ValueError:  # on another drive
        return blend.as_posix()
