"""Analyze: finds the recording's contacts and lists them."""

from __future__ import annotations

import bpy

from ..bridge.settings import problem_of, wanted_range, write_analysis
from ..bridge.takes import read_take
from ..bridge.worker import Kind, shared
from ..solver.messages import Analysed, Failed
from .common import FaultyOperator, chosen_armature, hindrance
from .names import OperatorId


class AnalyzeOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.ANALYZE
    bl_label = "Analyze"
    bl_description = (
        "Find when and where heels and toes touch the ground. Contacts that are found again keep "
        "what you changed about them"
    )
    bl_options = {"UNDO"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = hindrance(context)
        if why is not None:
            cls.poll_message_set(why)
        return why is None

    def run(self, context: bpy.types.Context) -> set[str]:
        armature = chosen_armature(context)
        settings = armature.hangtime
        recording = read_take(armature, *wanted_range(settings))
        problem = problem_of(settings, recording, with_contacts=False)
        answer = shared().ask(Kind.ANALYSE, recording, problem).wait()
        if isinstance(answer, Failed):
            raise answer.fault
        assert isinstance(answer, Analysed)
        write_analysis(settings, recording, answer)
        context.scene.hangtime.armature = armature
        contacts, flights = len(answer.schedule.contacts), len(answer.schedule.flights)
        self.report({"INFO"}, f"Found {contacts} contacts and {flights} flights")
        return {"FINISHED"}


CLASSES = (AnalyzeOperator,)
