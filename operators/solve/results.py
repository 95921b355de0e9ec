"""Operators on the result: show it or the recording, Accept, Discard, Show Report, Cancel."""

import bpy

from ...bridge.accessors import current_action, present, source_of
from ...bridge.action_slots import lost_slot
from ...bridge.armature.actions import recorded_action, show
from ...bridge.armature.played import why_no_action
from ...bridge.armature.strips import strips_of
from ...bridge.libraries import lost_file
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import settings_of
from ...bridge.results.combined import bake_shown
from ...bridge.results.look_again import unphysical_since
from ...bridge.takes.takes import results_from
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from .common import (
    BUSY,
    TWEAK_MODE,
    at_work,
    chosen_armature,
    required_armature,
    said,
    tweaked,
    why_no_armature,
)
from .meanwhile.removal import remove_result
from .session import session

NOTHING_ADAPTED = "Nothing has been adapted yet"
BESIDE = "The armature {} performs the result beside the recording; there is nothing to switch"
NOT_SHOWN = "{} is shown; show the result that is to {}"
NOT_COMPARED = "Nothing that {} was made from is there to compare it with"
BUILT_ON = "{} was made from this result; discard that one first"
TWEAKED_BY = "{} plays this result, too, and is in tweak mode; leave that first (Tab in the NLA)"
REPORT = "{} report"
_LONGEST = 63 - len(REPORT.format(""))  # bytes of a name of which the rest is ours
SURE = "Accept this result?"
ACCEPTED = "The result is accepted already"


def result_of(armature: bpy.types.Object | None) -> bpy.types.Action | None:
    """The result that is shown, else the one that was adapted last, else of those that are left of
    the same take the last."""
    if armature is None:
        return None
    shown = current_action(armature)
    adapted: bpy.types.Action | None = settings_of(armature).adapted
    beside = adapted is not None and action_settings(adapted).performer not in (None, armature)
    if shown is not None and source_of(shown) is not None and not beside:
        return shown
    if adapted is not None and lost_slot(adapted):
        adapted = None
    if adapted is not None or shown is None:
        return adapted
    left = results_from(shown, armature)
    return left[-1] if left else None


def required_result(context: bpy.types.Context) -> bpy.types.Action:
    """The same of the chosen armature, where `poll` has seen to it that there is one."""
    return present(result_of(required_armature(context)))


def compared(armature: bpy.types.Object) -> tuple[bpy.types.Action, bpy.types.Action] | None:
    """What a result was made from, and the result; None where another armature performs it, or the
    result itself is what the next one is made from."""
    result, recorded = result_of(armature), recorded_action(armature)
    if result is None or recorded in (None, result) or performer_of(armature) != armature:
        return None
    return present(recorded), result


def performer_of(armature: bpy.types.Object) -> bpy.types.Object:
    """Who performs the result: the armature, or one of other proportions."""
    performer: bpy.types.Object | None = action_settings(present(result_of(armature))).performer
    return performer if performer is not None else armature


def _not_shown(context: bpy.types.Context, fate: str) -> str | None:
    """What the armature shows in the place of its result, of which nobody then sees that it is to
    "be kept" or "go"; None where it is shown, or performed by another armature."""
    armature, result = required_armature(context), required_result(context)
    shown = current_action(armature)
    if performer_of(armature) != armature or shown == result:
        return None
    if shown is None:
        return NOT_SHOWN.format("No action", fate)
    return NOT_SHOWN.format("The recording" if shown == source_of(result) else shown.name, fate)


class _OfResult(PolledOperator):
    """Mixin: needs a result."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        if armature is None or result_of(armature) is None:
            return NOTHING_ADAPTED
        return TWEAK_MODE if tweaked(armature) else None


class _OfSettledResult(_OfResult):
    """Mixin: needs a result, while nothing is at work that may be writing the next one."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return BUSY if at_work() else super().obstacle(context)


class CompareOperator(_OfResult, bpy.types.Operator):
    bl_idname = OperatorId.COMPARE
    bl_label = "Compare"
    bl_description = "Switch between the recording and the adapted motion at this frame"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is not None:
            return why
        armature = required_armature(context)
        performer = performer_of(armature)
        if performer != armature:
            return BESIDE.format(performer.name)
        result = required_result(context)
        pair = compared(armature)
        if pair is None:
            return NOT_COMPARED.format(result.name)
        lost = lost_file(pair[0])
        return said(lost) if lost is not None else None

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        recorded, adapted = present(compared(armature))
        show(armature, recorded if current_action(armature) == adapted else adapted)
        return {"FINISHED"}


class ShowRecordingOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.SHOW_RECORDING
    bl_label = "Show Recording"
    bl_description = "Go back to the recording's action; the adapted one is kept"
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        if armature is None:
            return said(why_no_armature(context))
        if current_action(armature) is None:
            return said(why_no_action(armature))
        if current_action(armature) == recorded_action(armature):
            return "The recording is what is shown"
        lost = lost_file(recorded_action(armature))
        if lost is not None:
            return said(lost)
        return TWEAK_MODE if tweaked(armature) else None

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        show(armature, present(recorded_action(armature)))
        return {"FINISHED"}


class ShowAdaptedOperator(_OfResult, bpy.types.Operator):
    bl_idname = OperatorId.SHOW_ADAPTED
    bl_label = "Show Adapted"
    bl_description = "Go to the action that was adapted last"
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is None and current_action(required_armature(context)) == required_result(context):
            return "The adapted motion is what is shown"
        return why

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        show(required_armature(context), required_result(context))
        return {"FINISHED"}


class AcceptOperator(_OfSettledResult, bpy.types.Operator):
    bl_idname = OperatorId.ACCEPT
    bl_label = "Accept"
    bl_description = (
        "Keep the result that is shown, for export. When the file is saved and opened again, of "
        "results that are not accepted only the one that was shown is left"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is None and action_settings(required_result(context)).accepted:
            return ACCEPTED
        return why or _not_shown(context, "be kept")

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        result = required_result(context)
        told = unphysical_since(required_armature(context), result), action_settings(result).warning
        warning = "\n".join(filter(None, told))
        if not warning or bpy.app.background:
            return self.execute(context)
        return present(context.window_manager).invoke_confirm(
            self,
            event,
            title=SURE,
            message=warning,
            confirm_text="Accept Anyway",
            icon="WARNING",
        )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, result = required_armature(context), required_result(context)
        bake_shown(performer_of(armature), result)
        action_settings(result).accepted = result.use_fake_user = True
        self.report({"INFO"}, f"Accepted {result.name}")
        return {"FINISHED"}


class DiscardOperator(_OfSettledResult, bpy.types.Operator):
    bl_idname = OperatorId.DISCARD
    bl_label = "Discard"
    bl_description = (
        "Delete the result that is shown and show what it was made from; what you asked for stays"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        why = why or _not_shown(context, "go")
        if why is not None:
            return why
        result = required_result(context)
        for each in bpy.data.objects:  # Blender would not let it perform another action
            if tweaked(each) and (current_action(each) == result or strips_of(each, result)):
                return TWEAKED_BY.format(each.name)
        built = results_from(result)
        return BUILT_ON.format(built[0].name) if built else None

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, result = required_armature(context), required_result(context)
        name = result.name
        remove_result(armature, result)
        self.report({"INFO"}, f"Discarded {name}")
        return {"FINISHED"}


class ShowReportOperator(_OfResult, bpy.types.Operator):
    bl_idname = OperatorId.SHOW_REPORT
    bl_label = "Show Report"
    bl_description = (
        "What changed, and how well physics and everything asked for hold; also kept as a text"
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        self._write(required_result(context))
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        """In a window of its own, whose letters are of one width, as the columns need them."""
        text = self._write(required_result(context))
        bpy.ops.wm.window_new()
        area = present(context.window_manager).windows[-1].screen.areas[0]
        area.type = "TEXT_EDITOR"
        editor = area.spaces.active
        assert isinstance(editor, bpy.types.SpaceTextEditor)
        editor.text = text
        editor.top = 0
        editor.show_line_numbers = editor.show_syntax_highlight = False
        return {"FINISHED"}

    def _write(self, result: bpy.types.Action) -> bpy.types.Text:
        """The result's text, anew; of a long name the beginning goes, as Blender would cut off by
        what results of one take are told apart."""
        called = result.name.encode()[-_LONGEST:].decode(errors="ignore")
        name = REPORT.format(called)
        text = bpy.data.texts.get(name) or bpy.data.texts.new(name)
        text.from_string(action_settings(result).report)
        text.current_line_index = 0  # else it is shown from its end
        self.report({"INFO"}, f"The report is the text {name}")
        return text


class CancelOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.CANCEL
    bl_label = "Cancel"
    bl_description = "End what Hangtime is doing; nothing is changed"

    @classmethod
    def obstacle(cls, _context: bpy.types.Context) -> str | None:
        return None if session().running else "Nothing is under way"

    def execute(self, _context: bpy.types.Context) -> OperatorResult:
        solving = session().solving
        for operator in list(session().running):
            operator.leave()
        self.report({"INFO"}, "The drag was ended" if solving is None else solving.cancelled)
        return {"FINISHED"}
