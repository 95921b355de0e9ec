"""The operators' common base: target armature, preconditions, fault reporting, solver options."""

from dataclasses import replace

import bpy

from ...bridge.accessors import current_action, present
from ...bridge.action_slots import without_slot
from ...bridge.armature.actions import recorded_action
from ...bridge.armature.played import why_no_action
from ...bridge.libraries import lost_character, lost_file
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ...bridge.worker_client import shared
from ...solver.data.faults import Fault, NoArmature, NotInScene
from ...solver.data.solver_options import Method, ObjectiveKind, SolverOptions
from ..operator_types import OperatorResult, PolledOperator
from ..words.failure_text import Failure, failure_of
from ..words.messages import sentence
from .session import session

BUSY = "Hangtime is at work; wait for it, or press Esc in the viewport"
EDIT_MODE = "Leave edit mode first"
LINKED = "The armature is linked; make a library override of it first"  # else nothing is saved
NO_SLOT = (
    "{} uses no slot of its action, so nothing moves it: choose one beside the action's name in "
    "the Action editor, or a take in Hangtime's list"
)
NO_FILE = "No file is given; give the path of one"
TWEAK_MODE = "Leave tweak mode first (Tab in the Nonlinear Animation editor)"


def chosen_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """The target armature: the one pinned in the sidebar, else the active object if that is one,
    else, while something else is active, the one that was worked on last."""
    scene = present(context.scene)
    own = scene_settings(scene)
    chosen: bpy.types.Object | None = own.armature
    if chosen is not None and not _is_in(chosen, scene):
        chosen = None
    active = present(context.view_layer).objects.active
    if active is None or active.type != "ARMATURE":
        return chosen
    stays = chosen is not None and (own.pinned or active == _beside(chosen))
    return chosen if stays else active


def _is_in(thing: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """By its name first: to look through all scenes takes long, and every panel asks."""
    return scene.objects.get(thing.name) == thing or scene in thing.users_scene


def _beside(armature: bpy.types.Object) -> bpy.types.Object | None:
    """Who performs an armature's last result in its stead, with other limbs; it has no settings."""
    result = settings_of(armature).adapted
    performer: bpy.types.Object | None = (
        action_settings(result).performer if result is not None else None
    )
    return performer


def required_armature(context: bpy.types.Context) -> bpy.types.Object:
    """The same. Raises NoArmature and NotInScene, for it may have gone since the button was
    pressed."""
    armature = chosen_armature(context)
    if armature is None:
        raise why_no_armature(context)
    return armature


def why_no_armature(context: bpy.types.Context) -> Fault:
    """Why there is no target armature."""
    scene = present(context.scene)
    chosen = scene_settings(scene).armature
    if chosen is not None and chosen.users_scene and not _is_in(chosen, scene):
        return NotInScene(chosen.name, scene.name)
    active = present(context.view_layer).objects.active
    return NoArmature(active.name if active is not None else None)


def hindrance(context: bpy.types.Context) -> str | None:
    """Precondition: a sentence why the armature cannot be read now; None where it can."""
    why = unready(context)
    if why is not None:
        return why
    armature = required_armature(context)
    lost = lost_file(recorded_action(armature))
    if lost is not None:
        return said(lost)
    return NO_SLOT.format(armature.name) if without_slot(armature) else None


def unready(context: bpy.types.Context) -> str | None:
    """Precondition: a sentence why no take of an armature can be shown now; None where one can."""
    armature = chosen_armature(context)
    if at_work():
        return BUSY
    if armature is None or armature.type != "ARMATURE":
        return said(why_no_armature(context))
    lost = lost_character(armature)
    if lost is not None:
        return said(lost)
    if not armature.is_editable:
        return LINKED
    if armature.mode == "EDIT":
        return EDIT_MODE
    if tweaked(armature):
        return TWEAK_MODE
    if current_action(armature) is None:
        return said(why_no_action(armature))
    return None


def at_work() -> bool:
    """Whether something is under way that the artist waits for."""
    return shared().busy or session().solving is not None


def tweaked(armature: bpy.types.Object) -> bool:
    """Whether a strip's keys are being edited, while Blender lets no other action be assigned."""
    return armature.animation_data is not None and armature.animation_data.use_tweak_mode


def said(fault: Fault) -> str:
    """The fault's sentence, in the language of Blender's reports."""
    # The stubs do not know what it returns.
    return sentence(fault, bpy.app.translations.pgettext_rpt)  # type: ignore[arg-type]


def failed(fault: Fault, uid: int, of: str) -> Failure:
    """The fault for the sidebar. uid: the armature's number; of: the operator's bl_idname."""
    return failure_of(fault, uid, of, bpy.app.translations.pgettext_rpt)  # type: ignore[arg-type]


class ReadyOperator(PolledOperator):
    """Mixin: an operator that may run where the armature can be read and nothing is at work."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return hindrance(context)


class FaultyOperator(PolledOperator):
    """Mixin: `run` may raise what an artist can mend; that is reported, and nothing finished."""

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        try:
            return self.run(context)
        except Fault as fault:
            return self.refuse(said(fault))

    def run(self, context: bpy.types.Context) -> OperatorResult:
        """Does the work. Raises any Fault, having changed nothing."""
        raise NotImplementedError


def quick_solution(settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
    """Solver options by the method that is chosen, or that a recipe asks for."""
    if asked.method is not Method.IMPLICIT:  # a recipe's own choice
        return asked
    return replace(asked, method=Method[settings.method])


def refined_solution(settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
    """Solver options for the objective that is chosen, or that a recipe asks for."""
    weights = (
        (ObjectiveKind[settings.objective], 1.0),
        (ObjectiveKind.CLOSENESS, settings.stay_close),
    )
    if asked.method is Method.EXPLICIT:
        return asked
    return replace(asked, method=Method.EXPLICIT, objectives=weights)
