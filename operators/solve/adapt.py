"""Adapt and Refine: a new action in which the contacts are where the artist put them."""

from collections.abc import Generator, Sequence
from dataclasses import replace

import bpy

from ...bridge.accessors import current_scene, play_to_end, present, shown_range, source_of
from ...bridge.armature.actions import (
    read_recorded_incrementally,
    recorded_action,
    showing_recorded,
)
from ...bridge.armature.incremental import Incremental
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
from ...bridge.files.reproportioned import build_reproportioned
from ...bridge.loops.write_loop import (
    Loop,
    root_bone,
    write_loop_incrementally,
)
from ...bridge.polish.pins import MovedPin
from ...bridge.polish.renewal import Renewal
from ...bridge.properties.settings import HangtimeSettings, action_settings, settings_of
from ...bridge.properties.shown_overlaps import store_overlaps
from ...bridge.properties.shown_times import store_times
from ...bridge.recipe.keys import require_every_frame
from ...bridge.recipe.result import require_return_after
from ...bridge.rows.choices import After, ContactMarkers, LoopRoot, WrittenAs
from ...bridge.rows.phases import roles
from ...bridge.takes.options import loop_options, result_options
from ...bridge.takes.plan import AdaptedMotion
from ...bridge.takes.take_time import TakeTime
from ...bridge.takes.takes import (
    adapted_spans,
    derive,
    free_name,
    note_made,
    root_of,
)
from ...bridge.takes.write_result import (
    combine,
    lay_in_slot,
    require_slot,
    write_adapted_incrementally,
)
from ...bridge.worker_client import shared
from ...solver.body.anatomy import map_anatomy
from ...solver.body.proportions import changed_recording
from ...solver.data.faults import ChangedMeanwhile, Fault
from ...solver.data.recording import BEYOND, Recording, same_motion
from ...solver.data.solver_options import Method, SolverOptions
from ...solver.data.status import Status
from ...solver.worker.protocol import Adapted, RequestKind
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..words.doubt_text import doubts_of
from ..words.report_text import as_text
from ..words.summary_text import summary
from ..words.take_text import pin_lines, polish_lines, take_lines
from ..words.warning_text import warnings_of
from .common import chosen_armature, hindrance, quick_solution, refined_solution, required_armature
from .keys import key_options, mark_contacts, write_keys
from .live import live
from .scene import note_surfaces, read_bound, read_surfaces, stale_surfaces
from .session import Asked, session
from .solving import SolveState
from .takes import left_behind
from .task import Task, TaskOperator, answered, take_best

ALONE = (
    "The rest of the take is left out: {} has other limbs, and performs the adapted frames alone"
)
MARKERS_LEFT_OUT = (
    "Contact markers are left out: an action's are those of all of its slots, the take's included; "
    "choose Timeline"
)
NOT_ANALYSED = "Press Analyze first: there are no contacts to hold or move"


def unanalysed(context: bpy.types.Context) -> str | None:
    """Precondition: why there is nothing to adapt, in a sentence; None where there is."""
    why = hindrance(context)
    if why is None and not settings_of(required_armature(context)).contacts:
        return NOT_ANALYSED
    return why


class Adapting(TaskOperator):
    """Base of Adapt, Refine and Update."""

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
        first, last = wanted_range(settings)
        frames = None if first is None or last is None else (first, last)
        meant = replace(asked.problem, frames=frames)
        for doubt in doubts_of(meant, settings.measured_height, asked.recording.frames):
            self.report({"WARNING"}, doubt)
        return replace(asked, problem=replace(asked.problem, requests=requests))


class AdaptOperator(Adapting, bpy.types.Operator):
    bl_idname = OperatorId.ADAPT
    bl_label = "Adapt"
    bl_description = (
        "Make a new action that obeys physics, with every contact where you put it. "
        "The recording's action is kept unchanged"
    )
    bl_options = {"UNDO"}

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        return quick_solution(settings, asked)


class RefineOperator(Adapting, bpy.types.Operator):
    bl_idname = OperatorId.REFINE
    bl_label = "Refine"
    bl_description = (
        "Adapt, then go on to the motion that costs the performer least, as chosen under "
        "Advanced. Takes some seconds more"
    )
    bl_options = {"UNDO"}

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        return refined_solution(settings, asked)


class UseBestOperator(TaskOperator, bpy.types.Operator):
    bl_idname = OperatorId.USE_BEST
    bl_label = "Use Best So Far"
    bl_description = (
        "Take the motion as it stands: of the solve under way, or the best that a failed one "
        "found. The report says what it misses"
    )
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        solving, best = session().solving, session().best_of(chosen_armature(context))
        possible = best is not None or (solving is not None and solving.can_stop)
        return None if possible else "No solve is under way, and none has failed"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        return {"FINISHED"} if take_best() else super().invoke(context, event)

    def task(self, context: bpy.types.Context) -> Task:
        done = yield from write_answer(*present(session().best_of(chosen_armature(context))))
        session().best = None
        return done


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
    options = result_options(settings)
    require_return_after(options, span_of(settings, recording)[1])
    if options.written_as is WrittenAs.SLOT:
        require_slot(armature)
    _require_loopable(armature)
    yield from require_writable(armature, recording, span_of(settings, recording))
    scene = yield from read_surfaces(armature, recording.frames)
    skin = (yield from read_bound(armature, recording.frames)).skin
    problem = problem_of(settings, recording, scene.objects, skin=skin)
    return Asked(armature.name, armature.session_uid, recording, problem, scene)


def require_writable(
    armature: bpy.types.Object, recording: Recording, span: tuple[float, float]
) -> Incremental[None]:
    """Before a solve takes its seconds. span: first and last frame that are adapted.

    Controls are tried once for a recording, as that takes long and a drag's ghost waits for it.
    Raises NoControls, and as `map_anatomy`.
    """
    if not constrained(armature):  # keys of their own pose all bones
        return
    settings = settings_of(armature)
    segments = map_anatomy(recording.bones, chosen_parts(settings))
    bodies = tuple(recording.bones[segment.bone].name for segment in segments)
    frames = recording.window(*span).frames
    trying = armature.session_uid, analysis_key(settings, recording), bodies
    driven = session().tried == trying
    if not driven:
        driven = yield from require_posable(armature, bodies, frames, showing_recorded(armature))
        session().tried = trying if driven else None


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
    ends = (present(each) for each in (recorded_action(armature), settings.adapted))
    play_to_end(current_scene(), *(shown_range(armature, each)[1] for each in ends))
    refined = asked.problem.requests.solution.method is Method.EXPLICIT
    action_settings(present(settings.adapted)).refined = refined
    settings.status = "\n".join([settings.status, *remarks])
    return "; ".join([done, *remarks])


def _write_own(asked: Asked, answer: Adapted, armature: bpy.types.Object) -> Incremental[str]:
    """The answer as a new action of the armature."""
    stood = armature.matrix_world.copy()
    looped, options = loop_options(settings_of(armature)), result_options(settings_of(armature))
    if looped is not None:
        loop = Loop.of(armature, answer.track, looped.root)
        action, controls = yield from write_loop_incrementally(armature, loop)
        keep(action, answer.traces, stood)
        _note(armature, armature, action, answer, take_lines(controls))
        mark_contacts(armature, action, answer, options)
        note_made(armature, action, None, 0)
        return f"Wrote the loop {action.name}"
    renewal = Renewal.of(armature)
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
    told = take_lines(written)
    if options.written_as is WrittenAs.SLOT and options.markers is ContactMarkers.ACTION:
        told = [*told, MARKERS_LEFT_OUT]
    _note(armature, armature, action, answer, told)
    times = answer.report.times
    time = written.time if written is not None else TakeTime.of(times, 1.0)
    span = written.span if written is not None else None
    try:
        rate = answer.report.recording.frames_per_second
        moved = yield from renewal.put_on(action, answer.track.bones, time, answer.schedule, rate)
        _tell_polish(armature, action, renewal, moved)
        rig = written.rig if written is not None else None
        yield from write_keys(armature, armature, action, answer, rig)
    finally:  # cancelled it has a key on every frame
        mark_contacts(armature, action, answer, options)
        match options.written_as:
            case WrittenAs.COMBINE:
                combine(armature, action, options.after)
            case WrittenAs.SLOT:
                lay_in_slot(armature, present(source_of(action)), action)
        note_made(armature, action, span, time.later)
        renewal.note(action, time, (times.recorded_frame[0], times.recorded_frame[-1]))
    return f"Wrote the action {action.name}"


def _tell_polish(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    renewal: Renewal,
    moved: Sequence[MovedPin],
) -> None:
    """What became of hand polish: in the sidebar, the report, and among the warnings."""
    settings, made = settings_of(armature), action_settings(action)
    told, warned = polish_lines(renewal.put), pin_lines(moved)
    settings.status = "\n".join([settings.status, *told, *warned])
    made.report = "\n".join([made.report, *told, *warned])
    made.warning = "\n".join([line for line in (made.warning, *warned) if line])


def _write_other(
    recording: Recording, answer: Adapted, armature: bpy.types.Object
) -> Incremental[str]:
    """The answer on an armature of its own, for the artist's keeps its proportions."""
    other, track, _ = build_reproportioned(recording, answer.track)
    other.name = f"{armature.name} changed"
    source = present(recorded_action(armature))
    action = write_action(other, track, name=free_name(root_of(source).name, "adapted"))
    derive(action, source, armature)
    settings_of(armature).adapted = action
    keep(action, answer.traces, armature.matrix_world)
    options = result_options(settings_of(armature))
    left_out = [] if options.after is After.CUT else [ALONE.format(other.name)]
    _note(armature, other, action, answer, left_out)
    yield from write_keys(armature, other, action, answer)
    mark_contacts(other, action, answer, options)
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
    settings.status = "\n".join([summary(answer, roles(settings)), *told])
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
