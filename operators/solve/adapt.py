"""Adapt and Refine: a new action in which the contacts are where the artist put them."""

from collections.abc import Mapping
from dataclasses import replace

import bpy

from ...bridge.accessors import present
from ...bridge.armature.actions import read_recorded_incrementally, showing_recorded
from ...bridge.armature.incremental import Incremental
from ...bridge.armature.read import last_keyed
from ...bridge.constraints.bone_mapping import chosen_parts
from ...bridge.constraints.leaps import leaps_of, timed_phases
from ...bridge.constraints.motion_problem import problem_of
from ...bridge.controls.driven import beside_keys, is_driven, turned_by_drivers
from ...bridge.controls.missed.aimed import led_bones
from ...bridge.controls.refusals import require_posable
from ...bridge.loops.write_loop import root_bone
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.recipe.keys import require_every_frame
from ...bridge.recipe.result import require_return_after, require_return_within
from ...bridge.repairs.analysed_state import AnalysedState, changed_since_analysis
from ...bridge.repairs.analysis_key import (
    analysis_is_of,
    analysis_key,
    rates_since,
    repaired_since,
    span_of,
    spans_since,
    wanted_range,
)
from ...bridge.repairs.stored import undoubted
from ...bridge.results.made import AskedSettings
from ...bridge.rows.aimed_requests import apart_from_aimed, require_unaimed
from ...bridge.rows.choices import LoopRoot, WrittenAs
from ...bridge.rows.phases import listed
from ...bridge.scene.moving_empties import take_places
from ...bridge.takes.options import loop_options, result_options
from ...bridge.takes.write_result import require_slot
from ...bridge.worker_client import shared
from ...solver.body.anatomy import map_anatomy
from ...solver.data.faults import (
    ChangedMeanwhile,
    DrivenBones,
    FramesReversed,
    HeldBones,
    RateChanged,
    SpanChanged,
)
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import BEYOND, Recording
from ...solver.data.solver_options import SolverOptions
from ...solver.data.status import Status
from ...solver.worker.protocol import Adapted, RequestKind
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..words.doubt_text import distance_doubts, doubts_of, empty_doubts
from .common import chosen_armature, hindrance, quick_solution, refined_solution, required_armature
from .live import live
from .meanwhile.steady import steady
from .scene import read_bound, read_surfaces
from .session import Asked, session
from .solving import SolveState
from .takes import left_behind
from .task import Task, TaskOperator, answered, take_best
from .write_answer import write_answer
from .written.keys import key_options

# Of every frame, to write it: as the take and the result have it; and of controls, which are tried
# some 16 times where they reach what was solved.
LOOKS_AT_BONES, LOOKS_AT_CONTROLS = 3.0, 20.0
NOT_ANALYSED = "Press Analyze first: there are no contacts to hold or move"


def unanalysed(context: bpy.types.Context) -> str | None:
    """Precondition: why there is nothing to adapt, in a sentence; None where there is."""
    why = hindrance(context)
    if why is None and not listed(settings_of(required_armature(context))):
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

    def looks(self) -> Mapping[SolveState, float]:
        return looks_to_write(chosen_armature(bpy.context))

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
        armature = required_armature(context)  # another may be chosen by the time it is read
        left = yield from take_places(settings_of(armature), showing_recorded(armature))
        asked = yield from ask_for(context)
        session().advance(SolveState.SOLVING)
        settings, requests = settings_of(armature), asked.problem.requests
        requests = replace(requests, solution=self.solution(settings, requests.solution))
        requests = apart_from_aimed(requests, asked.aimed, asked.recording.bones)
        first, last = wanted_range(settings)
        frames = None if first is None or last is None else (first, last)
        meant = replace(asked.problem, frames=frames)
        for doubt in (*window_doubts(settings, asked.recording, meant), *empty_doubts(left)):
            self.report({"WARNING"}, doubt)
        asked = replace(asked, problem=replace(asked.problem, requests=requests))
        yield None  # on large rigs the rest takes long
        return replace(asked, state=AnalysedState.of(armature))


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

    def looks(self) -> Mapping[SolveState, float]:
        return looks_to_write(chosen_armature(bpy.context))

    def task(self, context: bpy.types.Context) -> Task:
        done = yield from write_answer(*present(session().best_of(chosen_armature(context))))
        session().best = None
        return done


def looks_to_write(armature: bpy.types.Object | None) -> Mapping[SolveState, float]:
    """How often every frame is looked at, to check that a recording is as it was, and to write."""
    parts = [] if armature is None else settings_of(armature).parts
    bodies = [part.bone for part in parts if part.bone]
    driven = armature is not None and is_driven(armature, bodies)
    return {
        SolveState.CHECKING: 1.0,
        SolveState.WRITING: LOOKS_AT_CONTROLS if driven else LOOKS_AT_BONES,
    }


def ask_for(context: bpy.types.Context) -> Incremental[Asked]:
    """The motion problem that the settings state, with the recording as it is.

    Raises any Fault of reading and of a rig that cannot be written to, AimedBone, ReturnTooEarly,
    ReturnTooLate, NoNewSlot, and RateChanged, SpanChanged or ChangedMeanwhile where it is not what
    was analysed, and ChangedWhileRead.
    """
    armature = required_armature(context)
    return (yield from steady(armature, _ask_for(armature)))


def _ask_for(armature: bpy.types.Object) -> Incremental[Asked]:
    settings = settings_of(armature)
    recording = yield from read_wanted(armature)
    _require_analysed(armature, recording)
    _require_loopable(armature)
    aimed = yield from require_writable(armature, recording, span_of(settings, recording))
    scene = yield from read_surfaces(armature, recording.frames)
    skin = (yield from read_bound(armature, recording.frames)).skin
    problem = problem_of(settings, recording, scene.objects, skin=skin)
    require_unaimed(problem.requests, aimed, recording.bones)
    for row in settings.surfaces:
        row.name = row.called  # by which it is told if its object goes
    options, looped = result_options(settings), loop_options(settings)
    apart = looped is not None or problem.requests.body.limbs
    if not apart:  # those are actions of their own
        if not problem.pins_alone:  # of these it is known where the range that is solved ends
            require_return_after(options, span_of(settings, recording)[1])
        with showing_recorded(armature)():
            end = last_keyed(armature)
        require_return_within(options, end)
        if options.written_as is WrittenAs.SLOT:
            require_slot(armature)
    return Asked(
        armature.name,
        armature.session_uid,
        recording,
        problem,
        AskedSettings.of(settings),
        options,
        key_options(settings),
        looped,
        scene,
        aimed,
    )


def window_doubts(
    settings: HangtimeSettings, recording: Recording, problem: MotionProblem
) -> list[str]:
    """What is hardly meant: lines. problem: as it was asked for."""
    height = settings.measured_height
    jumped = leaps_of(settings, recording, problem.height / height if problem.height else 1.0)
    return [
        *doubts_of(problem, height, recording.frames, timed_phases(settings, recording), jumped),
        *distance_doubts(problem, recording.heads),
    ]


def followed_problem(settings: HangtimeSettings, asked: Asked, held: str) -> MotionProblem:
    """What the settings ask by now of what was read for `asked`, as a drag follows it: points'
    targets are where they were then, for to look again would evaluate the scene at every move.

    held: name of the contact that the mouse holds. Raises AimedBone, and as `problem_of`.
    """
    recording, skin = asked.recording, asked.problem.skin
    points = asked.problem.requests.points
    paths = {each.name: each.path for each in points if each.path is not None}
    problem = problem_of(
        settings, recording, asked.scene.objects, skin=skin, held=held, paths=paths
    )
    require_unaimed(problem.requests, asked.aimed, recording.bones)
    requests = apart_from_aimed(problem.requests, asked.aimed, recording.bones)
    return replace(problem, requests=requests)


def _require_analysed(armature: bpy.types.Object, recording: Recording) -> None:
    """Raises RateChanged, SpanChanged, ChangedMeanwhile."""
    settings = settings_of(armature)
    if analysis_is_of(settings, recording):
        return
    if not repaired_since(settings):  # which sets the clock and cuts frames off, too
        rates, spans = rates_since(settings), spans_since(settings, recording)
        if rates is not None:
            raise RateChanged(*rates, while_solving=False)
        if spans is not None:
            raise SpanChanged(*spans)
    changed = changed_since_analysis(armature, recording)
    raise ChangedMeanwhile(armature.name, while_solving=False, changed=changed)


def require_writable(
    armature: bpy.types.Object, recording: Recording, span: tuple[float, float]
) -> Incremental[tuple[str, ...]]:
    """Before a solve takes its seconds. span: first and last frame that are adapted.

    Returns bones of neck and head that constraints or drivers aim, and that stay so (`aimed.py`).
    Controls are tried once for a recording, as that takes long and a drag's ghost waits for it.
    Raises PulledFromOutside, NoControls, DrivenBones, HeldBones, and as `map_anatomy`.
    """
    if not beside_keys(armature):
        return ()
    settings = settings_of(armature)
    frames = recording.window(*span).frames
    segments = map_anatomy(recording.bones, chosen_parts(settings))
    showing = showing_recorded(armature)
    led = yield from led_bones(armature, recording.bones, segments, frames, showing)
    named = (recording.bones[segment.bone].name for segment in segments)
    bodies = tuple(name for name in named if name not in led.aimed)
    trying = armature.session_uid, analysis_key(settings, recording), bodies
    driven = session().tried == trying
    if not driven:
        driven = yield from require_posable(armature, bodies, frames, showing)
        session().tried = trying if driven else None
    if driven:
        return led.aimed
    turned = turned_by_drivers(armature, bodies)
    if turned:
        raise DrivenBones(tuple(turned))
    if led.held:
        raise HeldBones(tuple(led.held), min(led.held.values()))
    return led.aimed


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
    """The recording in the artist's range, and beyond where there are keys that belong to it.

    Raises FramesReversed, and as `read_recording`.
    """
    settings = settings_of(armature)
    first, last = wanted_range(settings)
    if first is not None and last is not None and last < first:
        raise FramesReversed(first, last)
    recording = yield from read_recorded_incrementally(armature, first, last, BEYOND)
    if first is None or last is None:
        return recording
    return recording.window(*undoubted(settings, (first, last)))
