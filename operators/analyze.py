"""Analyze and Fit: what touches when in a recording, and how near physics comes to it."""

from __future__ import annotations

import bpy

from ..bridge.parts_of_body import find_parts, missing_parts
from ..bridge.settings import problem_of, wanted_range, write_analysis
from ..bridge.takes import read_take_in_parts
from ..bridge.traces_store import keep
from ..bridge.worker import shared
from ..solver.faults import MissingPart
from ..solver.messages import Analysed, Failed, Fitted, Kind
from .adapt import ask_for
from .common import FaultyOperator, chosen_armature, hindrance
from .names import OperatorId
from .session import session
from .solving import State
from .task import Task, TaskOperator, answered

# rms of the joint centres' distance, cm
WORDS = ((1.5, "very close to the recording"), (3.0, "close to the recording"))
LOOSE = "only roughly like the recording: check the contacts' frames, and the scale"


class FindBonesOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.FIND_BONES
    bl_label = "Find Bones"
    bl_description = "Find by their names which bone moves which part of the body"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None:
            cls.poll_message_set("Choose or select an armature first")
        return armature is not None

    def run(self, context: bpy.types.Context) -> set[str]:
        armature = chosen_armature(context)
        find_parts(armature)
        missing = missing_parts(armature.hangtime)
        if missing:
            self.report({"WARNING"}, f"No bone was found for the {', '.join(missing)}")
        return {"FINISHED"}


class _OnRecording(TaskOperator):
    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = hindrance(context)
        if why is not None:
            cls.poll_message_set(why)
        return why is None


class AnalyzeOperator(_OnRecording, bpy.types.Operator):
    bl_idname = OperatorId.ANALYZE
    bl_label = "Analyze"
    bl_description = (
        "Find when and where heels and toes touch the ground. Contacts that are found again keep "
        "what you changed about them"
    )
    bl_options = {"UNDO"}  # noqa: RUF012 - Blender reads a set

    def task(self, context: bpy.types.Context) -> Task:
        armature = chosen_armature(context)
        settings = armature.hangtime
        recording = yield from read_take_in_parts(armature, *wanted_range(settings))
        find_parts(armature)
        for missing in missing_parts(settings):
            raise MissingPart(missing)
        problem = problem_of(settings, recording, with_contacts=False)
        solving = session().solving
        assert solving is not None
        solving.advance(State.SOLVING)
        answer = yield from answered(shared().ask(Kind.ANALYSE, recording, problem))
        if isinstance(answer, Failed):
            raise answer.fault
        assert isinstance(answer, Analysed)
        write_analysis(settings, recording, answer)
        keep(armature, answer.traces, armature.matrix_world)
        context.scene.hangtime.armature = armature
        contacts, flights = len(answer.schedule.contacts), len(answer.schedule.flights)
        return f"Found {contacts} contacts and {flights} flights"


class FitOperator(_OnRecording, bpy.types.Operator):
    bl_idname = OperatorId.FIT
    bl_label = "Fit"
    bl_description = (
        "Find the motion nearest to the recording that obeys physics, and say how near it is. "
        "Adapt does this by itself where it is not done yet"
    )
    bl_options = {"UNDO"}  # noqa: RUF012 - Blender reads a set

    def task(self, context: bpy.types.Context) -> Task:
        armature = chosen_armature(context)
        solving = session().solving
        assert solving is not None
        asked = yield from ask_for(context)
        solving.advance(State.SOLVING)
        answer = yield from answered(shared().ask(Kind.FIT, asked.recording, asked.problem))
        if isinstance(answer, Failed):
            raise answer.fault
        assert isinstance(answer, Fitted)
        armature.hangtime.fit_quality = quality(answer.closeness)
        return f"Fitted in {answer.seconds:.1f} s: {in_words(answer.closeness)}"


def in_words(closeness: dict[str, float]) -> str:
    """How near a fit is (report.closeness)."""
    off = closeness["joint_centres_rms_cm"]
    return next((words for limit, words in WORDS if off < limit), LOOSE)


def quality(closeness: dict[str, float]) -> str:
    """Lines for the sidebar."""
    words = in_words(closeness)
    return (
        f"{words[0].upper()}{words[1:]}\n"
        f"Joints {closeness['joint_centres_rms_cm']:.1f} cm apart, "
        f"apex {closeness['pelvis_apex_difference_cm']:+.1f} cm"
    )


CLASSES = (FindBonesOperator, AnalyzeOperator, FitOperator)
