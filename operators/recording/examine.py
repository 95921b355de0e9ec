"""Examine: what is wrong with a recording, before anything is fitted."""

import bpy

from ...bridge.accessors import present, shown_range
from ...bridge.armature.actions import recorded_action
from ...bridge.constraints.bone_mapping import chosen_parts, find_parts, missing_parts
from ...bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ...bridge.repairs.analysis_key import span_of, wanted_range
from ...bridge.repairs.renamed_bones import require_keyed
from ...bridge.repairs.stored import (
    applied,
    finding_of,
    findings,
    is_applied,
    unreadable,
    write_diagnosis,
)
from ...bridge.worker_client import shared
from ...solver.data.faults import MissingPart
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import Recording
from ...solver.worker.protocol import Examined, RequestKind
from ..names import OperatorId
from ..solve.adapt import read_wanted
from ..solve.common import required_armature, said
from ..solve.live import redraw
from ..solve.meanwhile.standing import Kept
from ..solve.meanwhile.steady import steady
from ..solve.scene import read_bound, read_surfaces
from ..solve.session import session
from ..solve.solving import SolveState
from ..solve.task import Task, TaskOperator, answered
from ..words.doctor_text import HEALTHY
from ..words.doubt_text import frame_doubts

FOUND = "Found {} in the recording; the panel Recording tells what, and the remedies"
FORGOTTEN = "The repairs that this file held could not be read and are left out; repair anew"


class ExamineOperator(TaskOperator, bpy.types.Operator):
    bl_idname = OperatorId.EXAMINE
    bl_label = "Examine"
    bl_description = (
        "Look for what is wrong with the recording: frame rate, size, single frames, trembling, "
        "feet that slide. Nothing is changed; remedies are offered"
    )
    bl_options = {"UNDO"}

    def task(self, context: bpy.types.Context) -> Task:
        armature = required_armature(context)
        return (yield from steady(armature, self._examined(context, armature)))

    def _examined(self, context: bpy.types.Context, armature: bpy.types.Object) -> Task:
        kept, settings = Kept.of(armature), settings_of(armature)
        recording = yield from read_wanted(armature)
        self._tell_of_range(settings, recording)
        dead = require_keyed(armature)
        find_parts(armature)
        yield None
        for missing in missing_parts(settings):
            raise MissingPart(missing)
        skin = (
            yield from read_bound(armature, recording.frames)
        ).skin  # with whose soles it stands
        scene = yield from read_surfaces(armature, recording.frames)
        session().advance(SolveState.SOLVING)
        if unreadable(settings):
            settings.repairs = ""
            self.report({"WARNING"}, FORGOTTEN)
        repairs = applied(settings)
        problem = MotionProblem(
            frames=recording.ends,
            mass=settings.mass,
            bones=chosen_parts(settings),
            mend=repairs.mend,
            drift=repairs.drift,
            rise=repairs.rise,
            skin=skin,
            scene=scene.objects,
        )
        whole = shown_range(armature, present(recorded_action(armature)))
        job = shared().ask(RequestKind.EXAMINE, recording, problem, repairs)
        answer = yield from answered(job, Examined)
        yield None
        armature = kept.found()
        settings = settings_of(armature)
        diagnosis = answer.diagnosis.counted_in(whole, recording.ends)
        write_diagnosis(armature, diagnosis, answer.feet)
        scene_settings(context.scene).armature = armature
        redraw("VIEW_3D", "DOPESHEET_EDITOR")
        wrong = [
            row
            for row in findings(settings)
            if not (finding_of(row).kind.note or is_applied(settings, row))
        ]
        if dead is not None:
            self.report({"WARNING"}, said(dead))
        return FOUND.format(faults(len(wrong))) if wrong else HEALTHY

    def _tell_of_range(self, settings: HangtimeSettings, recording: Recording) -> None:
        for doubt in frame_doubts(wanted_range(settings), span_of(settings, recording)):
            self.report({"WARNING"}, doubt)


def faults(count: int) -> str:
    """Such as "3 faults"."""
    return "1 fault" if count == 1 else f"{count} faults"
