"""Remedies of how a recording is read: frame rate, the object's scale, the range, bones' names."""

import bpy

from ...bridge.accessors import current_scene, present, shown_range
from ...bridge.armature.actions import recorded_action, recorded_frames
from ...bridge.armature.poses import set_frame_rate
from ...bridge.files.object_scale import scale_object
from ...bridge.properties.settings import settings_of
from ...bridge.repairs.renamed_bones import (
    moved_by_old_names,
    rename_keys,
    renamed_bones,
    takes_to_rename,
)
from ...solver.analysis.take import require_inside
from ...solver.data.faults import Fault
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import ReadyOperator, required_armature, said
from ..solve.live import redraw
from ..solve.session import session
from ..words.doubt_text import frame_doubts

LINKED = "“{}” is linked: rename its keys in its own file, or give the bones their old names"
SHARED = (
    "“{}” shares the action, and has bones of the old names: give it its own action (Object > "
    "Relations > Make Single User > Object Animation), or give the bones the same names in both"
)
NOT_RENAMED = (
    "It is not known which bones were renamed: give them the names that the recording's keys have"
)
RATES = 1.0, 1000.0  # frames a second that Blender's scenes can have, and captures do
NO_RATE = "A scene cannot have {:g} frames a second; give {:g} to {:g}"
FACTORS = 1e-6, 1e6  # beyond any two units of length that figures come in
NO_FACTOR = "{} cannot be made {:g} times as large; give a factor from {:g} to {:,.0f}"


class MendingOperator(ReadyOperator):
    """Mixin: `mend` changes what is read, after which the last failure says nothing any more."""

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        try:
            done = self.mend(required_armature(context))
        except Fault as fault:
            return self.refuse(said(fault))
        if "FINISHED" in done:
            session().failure = None
            session().support = None  # what would carry is elsewhere; the next analysis tells where
            redraw("VIEW_3D", "DOPESHEET_EDITOR")
        return done

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        """Does it, or refuses. Raises any Fault, having changed nothing."""
        raise NotImplementedError

    def done(self, told: str) -> OperatorResult:
        """It is done, which is told."""
        self.report({"INFO"}, told)
        return {"FINISHED"}


class SetFrameRateOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.SET_FRAME_RATE
    bl_label = "Set Frame Rate"
    bl_description = (
        "Play the scene at the frame rate at which the body falls as gravity has it; keys stay at "
        "their frames. Analyze again next"
    )
    bl_options = {"REGISTER", "UNDO"}

    rate: bpy.props.FloatProperty(
        name="Frame Rate", default=24.0, soft_min=RATES[0], soft_max=RATES[1]
    )

    def mend(self, _armature: bpy.types.Object) -> OperatorResult:
        if not RATES[0] <= self.rate <= RATES[1]:
            return self.refuse(NO_RATE.format(self.rate, *RATES))
        set_frame_rate(current_scene(), self.rate)
        return self.done(f"The scene has {self.rate:.5g} frames a second now")


class ScaleToHumanOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.SCALE_TO_HUMAN
    bl_label = "Scale to Human Size"
    bl_description = (
        "Scale the armature's object, and its keys of scale and location where an importer made "
        "some, to a person's height. Analyze again next"
    )
    bl_options = {"REGISTER", "UNDO"}

    factor: bpy.props.FloatProperty(
        name="Factor", default=1.0, soft_min=FACTORS[0], soft_max=FACTORS[1]
    )

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        if not FACTORS[0] <= self.factor <= FACTORS[1]:
            return self.refuse(NO_FACTOR.format(armature.name, self.factor, *FACTORS))
        scale_object(armature, recorded_action(armature), self.factor)
        return self.done(f"{armature.name} is {self.factor:.3g} times as large now")


class TrimOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.TRIM
    bl_label = "Trim"
    bl_description = "Make the frame range these frames, without what cannot be held. Analyze next"
    bl_options = {"REGISTER", "UNDO"}

    first: bpy.props.IntProperty(name="First")
    last: bpy.props.IntProperty(name="Last", default=1)

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        if self.last <= self.first:
            return self.refuse(f"Frames {self.first} to {self.last} are no range")
        asked = float(self.first), float(self.last)
        first, last = recorded_frames(armature, *asked)[[0, -1]].tolist()
        whole = shown_range(armature, present(recorded_action(armature)))
        require_inside((first, last), armature.name, whole)
        settings = settings_of(armature)
        settings.first_frame, settings.last_frame = round(first), round(last)
        settings.use_range = True
        told = f"The range is frames {first:g} to {last:g} now"
        return self.done(". ".join([told, *frame_doubts(asked, (first, last))]))


class RenameKeysOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.RENAME_KEYS
    bl_label = "Rename Keys"
    bl_description = (
        "Let the keys of bones that were renamed while their action was not shown move these bones "
        "again, in the recording and the results made from it. Analyze next"
    )
    bl_options = {"REGISTER", "UNDO"}

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        names = renamed_bones(armature)
        if not names:
            return self.refuse(NOT_RENAMED)
        takes = takes_to_rename(armature, names)
        for take in takes:
            if take.library is not None:
                return self.refuse(LINKED.format(take.name))
        other = moved_by_old_names(armature, takes, names)
        if other is not None:
            return self.refuse(SHARED.format(other.name))
        rename_keys((curve for curves in takes.values() for curve in curves), names)
        who = f"{len(names)} bones have" if len(names) > 1 else "1 bone has"
        return self.done(f"{who} keys again")
