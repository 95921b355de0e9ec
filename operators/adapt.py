"""Adapt: a new action in which the contacts are where the artist put them."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ..bridge.other_figure import other_figure
from ..bridge.settings import problem_of, wanted_range
from ..bridge.takes import read_take, recorded_action, write_take
from ..bridge.worker import Job, Kind, shared
from ..bridge.write import write_action
from ..solver.digest import digest
from ..solver.faults import ChangedMeanwhile, Fault
from ..solver.messages import Adapted, Failed, Progress
from ..solver.proportions import changed_recording
from ..solver.recording import Recording
from .common import FaultyOperator, chosen_armature, hindrance, said
from .names import OperatorId

LOOK_EVERY = 0.05  # s
NOT_ANALYSED = "Press Analyze first: there are no contacts to hold or move"
STAGES = {"fit": "fitting the physics", "refine": "refining", "adapt": "adapting"}


@dataclass(frozen=True)
class Asked:
    """A request under way: of which armature, and what its recording was then."""

    armature: str
    content: str
    job: Job


class AdaptOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADAPT
    bl_label = "Adapt"
    bl_description = (
        "Make a new action that obeys physics, with every contact where you put it. "
        "The recording's action is kept unchanged"
    )
    bl_options = {"UNDO"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = hindrance(context)
        if why is None and not chosen_armature(context).hangtime.contacts:
            why = NOT_ANALYSED
        if why is not None:
            cls.poll_message_set(why)
        return why is None

    def run(self, context: bpy.types.Context) -> set[str]:
        """In scripts and without a window: waits for the answer."""
        asked = ask(context)
        try:
            asked.job.wait()
        finally:
            if asked.job.answer is None:  # interrupted
                shared().close()
        self.report({"INFO"}, finish(asked))
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """In the interface: looks for news now and then, so that nothing freezes."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            self._asked = ask(context)
        except Fault as fault:
            self.report({"ERROR"}, said(fault))
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(LOOK_EVERY, window=context.window)
        self._workspace = context.workspace
        self._workspace.status_text_set("Hangtime: starting (Esc cancels)")
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, "Cancelled; nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        for message in self._asked.job.news():
            if isinstance(message, Progress):
                self._workspace.status_text_set(progress_text(message))
        if self._asked.job.answer is None:
            return {"PASS_THROUGH"}
        self._end_waiting(context)
        try:
            self.report({"INFO"}, finish(self._asked))
        except Fault as fault:
            self.report({"ERROR"}, said(fault))
            return {"CANCELLED"}
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender when it opens another file or quits meanwhile."""
        shared().close()
        self._end_waiting(context)

    def _end_waiting(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        self._workspace.status_text_set(None)


def ask(context: bpy.types.Context) -> Asked:
    """Requests what the settings ask. Raises any Fault of reading, and ChangedMeanwhile."""
    context.view_layer.update()  # empties that a script moved
    armature = chosen_armature(context)
    settings = armature.hangtime
    recording = read_take(armature, *wanted_range(settings))
    content = digest(recording)
    if content != settings.analysed:
        raise ChangedMeanwhile(armature.name, while_solving=False)
    job = shared().ask(Kind.ADAPT, recording, problem_of(settings, recording))
    return Asked(armature.name, content, job)


def finish(asked: Asked) -> str:
    """Writes the answer as a new action; says how it went. Raises any Fault, writing nothing."""
    answer = asked.job.answer
    if isinstance(answer, Failed):
        raise answer.fault
    assert isinstance(answer, Adapted)
    armature = _unchanged(asked)
    limbs = asked.job.request.problem.requests.body.limbs
    if limbs:
        return _write_other(changed_recording(asked.job.request.recording, limbs), answer, armature)
    write_take(armature, answer.track)
    armature.hangtime.status = summary(answer)
    return f"Wrote the action {armature.animation_data.action.name}"


def _write_other(recording: Recording, answer: Adapted, armature: bpy.types.Object) -> str:
    """The answer on an armature of its own, for the artist's keeps its proportions."""
    other, track, _ = other_figure(recording, answer.track)
    other.name = f"{armature.name} changed"
    write_action(other, track, name=f"{recording.name} adapted")
    armature.hangtime.status = summary(answer)
    return f"Made the armature {other.name}, which performs the adapted motion"


def _unchanged(asked: Asked) -> bpy.types.Object:
    """The armature, if it and its recording are what they were. Raises ChangedMeanwhile."""
    armature = bpy.data.objects.get(asked.armature)
    if armature is not None and armature.mode != "EDIT" and recorded_action(armature) is not None:
        first, *_, last = asked.job.request.recording.frames
        if digest(read_take(armature, first, last)) == asked.content:
            return armature
    raise ChangedMeanwhile(asked.armature, while_solving=True)


def summary(answer: Adapted) -> str:
    """Lines for the sidebar: how well it holds, how long it took, how hard the ground pushes."""
    report = answer.report
    contacts = report["contacts"]
    worst = max(contacts, key=lambda contact: contact["worst_violation_mm"])
    seconds = sum(stage["seconds"] for stage in report["stages"])
    peak = max(report["forces"]["peaks"], key=lambda peak: peak["peak_bw"])
    return "\n".join(
        [
            f"Solved in {seconds:.1f} s",
            f"Pins: {worst['worst_violation_mm']:.2f} mm off at most ({worst['name']})",
            *(
                f"{each['name']}: {'held' if each['met'] else 'missed a little'}"
                for each in report["conditions"]
            ),
            f"Peak force: {peak['peak_bw']:.1f} body weights (frame {peak['frame']:.0f})",
        ]
    )


def progress_text(message: Progress) -> str:
    """For the status bar."""
    stage = STAGES.get(message.stage, message.stage)
    return (
        f"Hangtime: {stage}, step {message.step}, worst violation "
        f"{message.violation:.3g} × allowed (Esc cancels)"
    )


CLASSES = (AdaptOperator,)
