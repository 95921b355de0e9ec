"""Operators on the takes: which is shown, what the next result starts from, edits left behind."""

import bpy

from ...bridge.accessors import armature_data, current_action, present, source_of
from ...bridge.action_slots import all_curves
from ...bridge.armature.actions import recorded_action, show
from ...bridge.armature.fcurves import bone_of
from ...bridge.libraries import lost_file
from ...bridge.polish.renewal import is_kept
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import settings_of
from ...bridge.results.look_again import look_again, polished_result
from ...bridge.results.start import start_from_recording, start_from_result
from ...bridge.takes.options import loop_options
from ...bridge.takes.takes import show_take, takes_of
from ...solver.data.faults import BadRecipe
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from .common import ReadyOperator, required_armature, said, unready

NO_RESULT_SHOWN = "The recording is shown; show the result to start from"
BESIDE = "The armature {} performs {}, as its limbs are others"
GONE = "The action “{}” is not there any more"
UNNAMED = "No action is named; give the name of a take"
NO_KEYS = "The action {} has no keys for bones of {}; choose one of its takes"
LEFT_BEHIND = (
    "Keys of {} were edited by hand. The next result starts from {} again, without these edits; "
    "{} is kept. {}"
)
TO_KEEP = "To take them along, tick Keep Polish under Rest of the Take"
TO_BUILD_ON = "To build on them, choose Start From: This Result"
IN_LOOP = "A loop cannot take them along"


def left_behind(armature: bpy.types.Object) -> str:
    """What is to be said before edits made by hand in the last result do not go along; empty where
    they do, or there are none."""
    result = polished_result(armature)
    try:
        if result is None or is_kept(armature, result):
            return ""
        looped = loop_options(settings_of(armature)) is not None
    except BadRecipe:  # nothing is made, and the solve says why
        return ""
    result.use_fake_user = True
    source, chosen = present(recorded_action(armature)), settings_of(armature).result.keep_polish
    way = IN_LOOP if looped else TO_BUILD_ON if chosen else TO_KEEP
    return LEFT_BEHIND.format(result.name, source.name, result.name, way)


class ShowTakeOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.SHOW_TAKE
    bl_label = "Show Take"
    bl_description = "Show this take, with the settings it was made with"
    bl_options = {"UNDO"}

    # By its full name, which tells the library; by its name alone among the armature's takes.
    action: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    # Between a result and what it was made from nothing else changes.
    switch: bpy.props.BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return unready(context)

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        action = _named(armature, self.action)
        if action is None:
            return self.refuse(GONE.format(self.action) if self.action else UNNAMED)
        lost = lost_file(action)
        if lost is not None:
            return self.refuse(said(lost))
        if not _could_show(armature, action):
            return self.refuse(NO_KEYS.format(action.name, armature.name))
        performer = action_settings(action).performer
        if performer not in (None, armature):
            return self.refuse(BESIDE.format(performer.name, action.name))
        if self.switch:
            show(armature, action)
        else:
            show_take(armature, action)
        look_again(armature)
        return {"FINISHED"}


def _named(armature: bpy.types.Object, name: str) -> bpy.types.Action | None:
    """The action of a name, which another character may have, too: the armature's take first."""
    own = [take.action for take in takes_of(armature)]
    found = [a for a in own if a.name_full == name] or [a for a in own if a.name == name]
    found = found or [a for a in bpy.data.actions if a.name_full == name]
    return found[0] if found else None


def _could_show(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Whether an action is a take of an armature, or could be one by its keys."""
    if action in [take.action for take in takes_of(armature)]:
        return True
    bones = set(armature_data(armature).bones.keys())
    return any(bone_of(curve.data_path) in bones for curve in all_curves(action))


class StartFromOperator(ReadyOperator, bpy.types.Operator):
    bl_idname = OperatorId.START_FROM
    bl_label = "Start From"
    bl_options = {"UNDO"}

    result: bpy.props.BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(
        cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        if properties.result:
            return (
                "Make the next results from the result that is shown: another jump builds on it, "
                "and what you edited by hand stays. Analyze it next"
            )
        return "Make the next results from the recording, with the settings that belong to it"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        shown = current_action(armature)
        if not self.result:
            start_from_recording(armature)
        elif shown is None or source_of(shown) is None:
            return self.refuse(NO_RESULT_SHOWN)
        elif shown != recorded_action(armature):
            start_from_result(armature, shown)
        look_again(armature)
        return {"FINISHED"}


class LeaveEditsOperator(ReadyOperator, bpy.types.Operator):
    bl_idname = OperatorId.LEAVE_EDITS
    bl_label = "Adapt without the edits made by hand?"
    bl_description = "Adapt, though the last result was edited by hand; that result is kept"
    bl_options = {"INTERNAL"}

    then: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    text: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        manager = context.window_manager
        assert manager is not None
        return manager.invoke_confirm(
            self,
            event,
            title=self.bl_label,
            message=self.text,
            confirm_text="Adapt Anyway",
            icon="WARNING",
        )

    def execute(self, _context: bpy.types.Context) -> OperatorResult:
        return self.go_on_with(self.then, leave_edits=True)
