"""Adapt and Refine: a new action in which the contacts are where the artist put them."""

from collections.abc import Generator, Sequence
from dataclasses import replace

import bpy

from ...bridge.accessors import present
from ...bridge.armature.actions import (
    read_recorded_incrementally,
    recorded_action,
    showing_recorded,
)
from ...bridge.armature.incremental import Incremental
from ...bridge.armature.reproportioned import build_reproportioned
from ...bridge.armature.traces_store import keep
from ...bridge.armature.write import write_action
from ...bridge.constraints.bone_mapping import chosen_parts
from ...bridge.constraints.motion_problem import (
    analysis_key,
    problem_of,
    span_of,
    wanted_range,
)
from ...bridge.constraints.status import write_status
from ...bridge.controls.driven import constrained
from ...bridge.controls.refusals import require_posable
from ...bridge.loops.write_loop import (
    Loop,
    root_bone,
    write_loop_incrementally,
)
from ...bridge.properties.settings import HangtimeSettings, action_settings, settings_of
from ...bridge.properties.shown_overlaps import store_overlaps
from ...bridge.properties.shown_times import store_times
from ...bridge.recipe.keys import require_every_frame
from ...bridge.recipe.result import require_return_after
from ...bridge.rows.choices import LoopRoot, WrittenAs
from ...bridge.takes.options import loop_options, result_options
from ...bridge.takes.plan import AdaptedMotion
from ...bridge.takes.takes import adapted_spans, note_made, polished_result
from ...bridge.takes.write_result import combine, write_adapted_incrementally
from ...bridge.worker_client import shared
from ...solver.body.anatomy import map_anatomy
from ...solver.body.proportions import changed_recording
from ...solver.data.faults import ChangedMeanwhile, Fault, NotInLoop
from ...solver.data.recording import BEYOND, Recording, same_motion
from ...solver.data.reports.constraints import ConstraintReport
from ...solver.data.solver_options import Method, ObjectiveKind, SolverOptions
from ...solver.data.status import Status
from ...solver.worker.protocol import Adapted, RequestKind
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..words.report_text import (
    amount,
    as_text,
    certificate_lines,
    durations_lines,
    given_up_lines,
    joint_lines,
    loop_lines,
    retimed,
)
from ..words.take_text import take_lines
from ..words.warning_text import warnings_of
from .common import hindrance, required_armature
from .keys import key_options, mark_contacts, write_keys
from .live import live
from .scene import note_surfaces, read_surfaces, stale_surfaces
from .session import Asked, session
from .solving import SolveState
from .takes import LEFT_BEHIND
from .task import Task, TaskOperator, answered, take_best

NOT_ANALYSED = "Press Analyze first: there are no contacts to hold or move"


def unanalysed(context: bpy.types.Context) -> str | None:
    """Precondition: why there is nothing to adapt, in a sentence; None where there is."""
    why = hindrance(context)
    if why is None and not settings_of(required_armature(context)).contacts:
        return NOT_ANALYSED
    return why


class _Adapting(TaskOperator):
    """Base of Adapt and Refine."""

    # Whether the artist knows that edits made by hand in the last result do not go along.
    leave_edits: bpy.props.BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return unanalysed(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        told = left_behind(required_armature(context))
        if told and not (self.leave_edits or bpy.app.background):
            leave = bpy.ops.hangtime.leave_edits  # type: ignore[attr-defined]  # our own
            # Of an instance Blender tells its own name, "HANGTIME_OT_adapt".
            leave("INVOKE_DEFAULT", then=type(self).bl_idname, text=told)
            return {"CANCELLED"}
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        told = left_behind(required_armature(context))
        if told and not self.leave_edits:
            self.report({"WARNING"}, told)
        return super().execute(context)

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        """Solver options; asked: those of a recipe."""
        raise NotImplementedError

    def task(self, context: bpy.types.Context) -> Task:
        present(context.view_layer).update()  # empties that a script moved
        try:
            asked = yield from self._asked(context)
            job = shared().ask(RequestKind.ADAPT, asked.recording, asked.problem)
            answer = yield from answered(job, Adapted)
        finally:
            live().clear()  # a drag's ghost stays until there is something better, or nothing
        session().best = None
        if answer.fault is not None and answer.fault.reason is not Status.STOPPED:
            session().best = (asked, answer)
            raise answer.fault
        return (yield from write_answer(asked, answer))

    def _asked(self, context: bpy.types.Context) -> Incremental[Asked]:
        asked = yield from ask_for(context)
        session().advance(SolveState.SOLVING)
        settings, requests = settings_of(required_armature(context)), asked.problem.requests
        requests = replace(requests, solution=self.solution(settings, requests.solution))
        return replace(asked, problem=replace(asked.problem, requests=requests))


class AdaptOperator(_Adapting, bpy.types.Operator):
    bl_idname = OperatorId.ADAPT
    bl_label = "Adapt"
    bl_description = (
        "Make a new action that obeys physics, with every contact where you put it. "
        "The recording's action is kept unchanged"
    )
    bl_options = {"UNDO"}

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        if asked.method is not Method.IMPLICIT:  # a recipe's own choice
            return asked
        return replace(asked, method=Method[settings.method])


class RefineOperator(_Adapting, bpy.types.Operator):
    bl_idname = OperatorId.REFINE
    bl_label = "Refine"
    bl_description = (
        "Adapt, then go on to the motion that costs the performer least, as chosen under "
        "Advanced. Takes some seconds more"
    )
    bl_options = {"UNDO"}

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        weights = (
            (ObjectiveKind[settings.objective], 1.0),
            (ObjectiveKind.CLOSENESS, settings.stay_close),
        )
        if asked.method is Method.EXPLICIT:
            return asked
        return replace(asked, method=Method.EXPLICIT, objectives=weights)


class UseBestOperator(TaskOperator, bpy.types.Operator):
    bl_idname = OperatorId.USE_BEST
    bl_label = "Use Best So Far"
    bl_description = (
        "Take the motion as it stands: of the solve under way, or the best that a failed one "
        "found. The report says what it misses"
    )
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, _context: bpy.types.Context) -> str | None:
        solving = session().solving
        possible = session().best is not None or (solving is not None and solving.can_stop)
        return None if possible else "No solve is under way, and none has failed"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        return {"FINISHED"} if take_best() else super().invoke(context, event)

    def task(self, _context: bpy.types.Context) -> Task:
        done = yield from write_answer(*present(session().best))
        session().best = None
        return done


def left_behind(armature: bpy.types.Object) -> str:
    """What is to be said before edits made by hand in the last result do not go along; empty where
    there are none."""
    result = polished_result(armature)
    if result is None:
        return ""
    result.use_fake_user = True
    source = present(recorded_action(armature))
    return LEFT_BEHIND.format(result.name, source.name, result.name)


def ask_for(context: bpy.types.Context) -> Incremental[Asked]:
    """The motion problem that the settings state, with the recording as it is.

    Raises any Fault of reading and of a rig that cannot be written to, and ChangedMeanwhile where
    it is not what was analysed.
    """
    armature = required_armature(context)
    settings = settings_of(armature)
    recording = yield from read_wanted(armature)
    if analysis_key(settings, recording) != settings.analysed:
        raise ChangedMeanwhile(armature.name, while_solving=False)
    require_return_after(result_options(settings), span_of(settings, recording)[1])
    _require_loopable(armature)
    yield from require_writable(armature, recording, span_of(settings, recording))
    scene = yield from read_surfaces(armature, recording.frames)
    problem = problem_of(settings, recording, scene.objects)
    return Asked(armature.name, armature.session_uid, recording, problem, scene)


def require_writable(
    armature: bpy.types.Object, recording: Recording, span: tuple[float, float]
) -> Incremental[None]:
    """Before a solve takes its seconds. span: first and last frame that are adapted.

    Raises NoControls, NotInLoop, and as `map_anatomy`.
    """
    if not constrained(armature):  # keys of their own pose all bones
        return
    settings = settings_of(armature)
    segments = map_anatomy(recording.bones, chosen_parts(settings))
    bodies = tuple(recording.bones[segment.bone].name for segment in segments)
    frames = recording.window(*span).frames
    driven = yield from require_posable(armature, bodies, frames, showing_recorded(armature))
    if driven and loop_options(settings) is not None:
        raise NotInLoop("a rig that is posed through controls")


def _require_loopable(armature: bpy.types.Object) -> None:
    """Before a solve takes its seconds. Raises NotInLoop, NoRootBone."""
    settings = settings_of(armature)
    looped = loop_options(settings)
    if looped is None:
        return
    require_every_frame(key_options(settings))
    if looped.root is LoopRoot.ROOT_BONE:
        pelvis = next((p.bone for p in settings.parts if p.name == "pelvis"), None)
        if pelvis:
            root_bone(armature, pelvis)


def read_wanted(armature: bpy.types.Object) -> Incremental[Recording]:
    """The recording in the artist's range, and beyond where there are keys."""
    first, last = wanted_range(settings_of(armature))
    return (yield from read_recorded_incrementally(armature, first, last, BEYOND))


def write_answer(asked: Asked, answer: Adapted) -> Incremental[str]:
    """Writes an answer as a new action; returns how it went. Raises ChangedMeanwhile.

    Surfaces that changed meanwhile do not void it: it says that it is not about them any more.
    """
    session().advance(SolveState.CHECKING)
    armature = yield from _unchanged(asked)
    stale = yield from stale_surfaces(asked, armature)
    session().advance(SolveState.WRITING)
    limbs = asked.problem.requests.body.limbs
    if limbs:
        within = asked.recording.window(*present(asked.problem.frames))
        done = yield from _write_other(changed_recording(within, limbs), answer, armature)
    else:
        done = yield from _write_own(asked, answer, armature)
    remarks = note_surfaces(armature, asked, answer.report, stale)
    settings = settings_of(armature)
    settings.status = "\n".join([settings.status, *remarks])
    return "; ".join([done, *remarks])


def _write_own(asked: Asked, answer: Adapted, armature: bpy.types.Object) -> Incremental[str]:
    """The answer as a new action of the armature."""
    stood = armature.matrix_world.copy()
    looped, options = loop_options(settings_of(armature)), result_options(settings_of(armature))
    if looped is not None:
        loop = Loop.of(armature, answer.track, looped.root)
        action = yield from write_loop_incrementally(armature, loop)
        keep(action, answer.traces, stood)
        _note(armature, armature, action, answer)
        mark_contacts(armature, action, answer, options)
        note_made(armature, action, None, 0)
        return f"Wrote the loop {action.name}"
    motion = AdaptedMotion(
        answer.track,
        answer.report.times,
        answer.moved,
        options,
        ends=any(hold.ends for hold in asked.problem.requests.holds),
        kept=adapted_spans(present(recorded_action(armature))),
    )
    action, written = yield from write_adapted_incrementally(armature, motion)
    keep(action, answer.traces, stood)
    _note(armature, armature, action, answer, take_lines(written))
    span, later = (written.span, written.later) if written is not None else (None, 0)
    try:
        yield from write_keys(armature, armature, action, answer)
    finally:  # cancelled it has a key on every frame
        mark_contacts(armature, action, answer, options)
        if options.written_as is WrittenAs.COMBINE:
            combine(armature, action, options.after)
        note_made(armature, action, span, later)
    return f"Wrote the action {action.name}"


def _write_other(
    recording: Recording, answer: Adapted, armature: bpy.types.Object
) -> Incremental[str]:
    """The answer on an armature of its own, for the artist's keeps its proportions."""
    other, track, _ = build_reproportioned(recording, answer.track)
    other.name = f"{armature.name} changed"
    action = write_action(other, track, name=f"{recording.name} adapted")
    action_settings(action).recording = recorded_action(armature)
    settings_of(armature).adapted = action
    keep(action, answer.traces, armature.matrix_world)
    _note(armature, other, action, answer)
    yield from write_keys(armature, other, action, answer)
    return f"Made the armature {other.name}, which performs the adapted motion"


def _note(
    armature: bpy.types.Object,
    performer: bpy.types.Object,
    action: bpy.types.Action,
    answer: Adapted,
    told: Sequence[str] = (),
) -> None:
    """Keeps what was found beside the action, and how each constraint came out.

    told: lines about the rest of the take.
    """
    settings = settings_of(armature)
    settings.status = "\n".join([summary(answer), *told])
    write_status(settings, answer.report)
    action_settings(action).report = "\n".join([as_text(answer.report), *told])
    store_times(action, answer.report.times)
    store_overlaps(action, answer.report)
    action_settings(action).warning = "\n".join(warnings_of(answer.report))
    if performer != armature:
        action_settings(action).performer = performer


def _unchanged(asked: Asked) -> Generator[None, None, bpy.types.Object]:
    """The armature, if it and its recording are what they were. Raises ChangedMeanwhile."""
    armature = next((o for o in bpy.data.objects if o.session_uid == asked.uid), None)
    if armature is not None and armature.mode != "EDIT" and recorded_action(armature) is not None:
        frames = asked.recording.frames
        try:
            now = yield from read_recorded_incrementally(armature, frames[0], frames[-1])
        except Fault as fault:  # another action, a scale: whatever it is, it is new
            raise ChangedMeanwhile(asked.armature, while_solving=True) from fault
        if same_motion(now, asked.recording):
            return armature
    raise ChangedMeanwhile(asked.armature, while_solving=True)


def summary(answer: Adapted) -> str:
    """Lines for the sidebar: how well it holds, how long it took, how hard the ground pushes."""
    report = answer.report
    worst = max(report.contacts, key=lambda contact: contact.loaded_slide_mm)
    seconds = sum(stage.seconds for stage in report.stages or ())
    peak = max(report.forces.peaks, key=lambda peak: peak.peak_bw)
    said = "Solved" if answer.fault is None else "Best found, not all is met;"
    return "\n".join(
        [
            f"{said} in {seconds:.1f} s",
            f"Loaded points slide {worst.loaded_slide_mm:.1f} mm at most ({worst.name})",
            *(f"{c.name}: {_held(c)}" for c in report.conditions if not c.kind.guards),
            *(
                f"{p.phase.capitalize()}: {p.adapted_s:.2f} s, was {p.recorded_s:.2f} s"
                for p in retimed(report)
            ),
            *(f"Durations: {line[0].lower()}{line[1:]}" for line in durations_lines(report)),
            f"Peak force: {peak.peak_bw:.1f} body weights (frame {peak.frame:.0f}), "
            f"in the recording {report.forces.recorded_peak_bw:.1f}",
            *given_up_lines(report),
            *loop_lines(report),
            *joint_lines(report),
            *certificate_lines(report),
        ]
    )


def _held(constraint: ConstraintReport) -> str:
    if constraint.met:
        return "held"
    return f"missed by {amount(constraint)}"
