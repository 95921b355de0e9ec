"""Analyze and Fit: what touches when in a recording, and how near physics comes to it."""

from collections.abc import Generator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

import bpy

from ...bridge.accessors import current_action, present, shown_range, source_of
from ...bridge.armature.actions import recorded_action
from ...bridge.armature.incremental import Incremental
from ...bridge.armature.played import wrong_speed
from ...bridge.armature.traces_store import keep
from ...bridge.constraints.bone_mapping import evidence_of, find_parts, missing_parts
from ...bridge.constraints.motion_problem import problem_of, write_analysis
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ...bridge.properties.stances import active_contact
from ...bridge.repairs.analysed_state import AnalysedState
from ...bridge.repairs.analysis_key import analysis_is_of, span_of, wanted_range
from ...bridge.repairs.renamed_bones import require_keyed
from ...bridge.worker_client import shared
from ...bridge.worker_requests import PendingRequest
from ...solver.analysis.take import require_inside
from ...solver.data.contacts import ContactSchedule
from ...solver.data.faults import (
    Fault,
    LostEdits,
    MissingPart,
    OddHeight,
    OffBalance,
    OutsideKeys,
    SourceOutsideKeys,
    UnseenSupport,
)
from ...solver.data.loop import Cycle
from ...solver.data.problem import Mend, MotionProblem
from ...solver.data.recording import Recording
from ...solver.data.reports.constraints import FitNeeds
from ...solver.data.reports.report import FitQuality
from ...solver.data.scene import SceneRole
from ...solver.data.solver_options import SolverOptions
from ...solver.doctor.figure import figure_of
from ...solver.doctor.noise import find_noise
from ...solver.skeleton.bind_pose import bind_frames
from ...solver.skeleton.mapping import UNSURE
from ...solver.unseen.offered import OfferedSupport
from ...solver.worker.protocol import Analysed, Fitted, RequestKind
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..words.doctor_text import finding_sentence
from ..words.doubt_text import range_words
from ..words.headline import accepted_lines
from ..words.messages import together
from ..words.report_text import apex_words
from ..words.shape_text import shapes_told
from .adapt import Adapting, ask_for, followed_problem, read_wanted, require_writable
from .common import (
    FaultyOperator,
    chosen_armature,
    quick_solution,
    refined_solution,
    required_armature,
    said,
)
from .meanwhile.standing import Kept
from .meanwhile.steady import steady
from .scene import read_bound, read_surfaces
from .session import session
from .solving import SolveState
from .task import Task, TaskOperator, answered

# rms of the joint centres' distance, cm
CLOSENESS_WORDS = ((1.5, "very close to the recording"), (3.0, "close to the recording"))
USUAL_HEIGHT = 1.75  # m
MOST_SNAPS = 3  # of the frame range to a cycle; the last only confirms
ORPHAN = (
    "What {} was made from is not there any more, so it cannot be made anew. To adapt it as it is, "
    "press Analyze"
)
SMOOTH_FIRST = "Examine, and smooth them first, for noise breaks contacts into pieces"
LOOSE = "only roughly like the recording: check the contacts' frames, and the scale"


class FindBonesOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.FIND_BONES
    bl_label = "Find Bones"
    bl_description = (
        "Find which bone moves which part of the body, by the bones' names and the skeleton's "
        "shape. What you chose yourself stays"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return "Choose or select an armature first" if chosen_armature(context) is None else None

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        find_parts(armature)
        settings = settings_of(armature)
        missing = missing_parts(settings)
        unsure = [p.name for p in settings.parts if evidence_of(p) in UNSURE]
        if missing:
            self.report({"WARNING"}, f"No bone was found for the {', '.join(missing)}")
        elif unsure:
            told = "by the skeleton's shape alone; look through them in the panel Bones"
            self.report({"WARNING"}, f"{len(unsure)} bones were found {told}")
        elif settings.convention:
            self.report({"INFO"}, f"The bones are named as by {settings.convention}")
        return {"FINISHED"}


class AnalyzeOperator(TaskOperator, bpy.types.Operator):
    bl_idname = OperatorId.ANALYZE
    bl_label = "Analyze"
    bl_description = (
        "Find when and where heels and toes touch the ground. Contacts that are found again keep "
        "what you changed about them"
    )
    bl_options = {"UNDO"}

    def looks(self) -> Mapping[SolveState, float]:
        return {SolveState.PREPARING: 1.0}

    def task(self, context: bpy.types.Context) -> Task:
        done = yield from analysis(context)
        if not bpy.app.background:
            session().advance(SolveState.PREPARING)
            yield from _prepare_drag(context)
        return done.told


class UpdateOperator(Adapting, bpy.types.Operator):
    bl_idname = OperatorId.UPDATE
    bl_label = "Update"
    bl_description = (
        "Make the result anew from the take and the settings as they are now: analyzes where the "
        "take below has changed, and adapts, or refines what was refined"
    )
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is not None:
            return why
        armature = required_armature(context)
        made, shown = settings_of(armature).adapted, present(current_action(armature))
        # Made anew from itself it would have the edit twice.
        return ORPHAN.format(shown.name) if shown == made and source_of(shown) is None else None

    def solution(self, settings: HangtimeSettings, asked: SolverOptions) -> SolverOptions:
        if settings.adapted is not None and action_settings(settings.adapted).refined:
            return refined_solution(settings, asked)
        return quick_solution(settings, asked)

    def task(self, context: bpy.types.Context) -> Task:
        armature = required_armature(context)
        recording = yield from read_wanted(armature)
        if not analysis_is_of(settings_of(armature), recording):
            lost = (yield from analysis(context)).lost
            present(session().solving).again()
            if lost:
                raise LostEdits(lost)
        return (yield from super().task(context))


@dataclass(frozen=True)
class AnalysisOutcome:
    """What to tell of an analysis. lost: contacts that were edited and are not found any more."""

    told: str
    lost: tuple[str, ...]


def analysis(
    context: bpy.types.Context,
) -> Generator[PendingRequest | float | None, None, AnalysisOutcome]:
    """Finds contacts, and keeps them with the armature. Raises any Fault of a recording,
    ChangedWhileRead, ArmatureGone."""
    armature = required_armature(context)
    return (yield from steady(armature, _analysis(context, armature)))


def _analysis(
    context: bpy.types.Context, armature: bpy.types.Object
) -> Generator[PendingRequest | float | None, None, AnalysisOutcome]:
    kept, settings = Kept.of(armature), settings_of(armature)
    recording = yield from read_wanted(armature)
    yield None
    bind = _leave_out_bind_pose(settings, recording)
    if bind:
        recording = yield from read_wanted(armature)
    # Now, as it may be moved while it is analysed.
    state, stood = AnalysedState.of(armature), armature.matrix_world.copy()
    recorded = shown_range(armature, present(recorded_action(armature)))
    wanted, span = wanted_range(settings), span_of(settings, recording)
    _require_inside(armature, span, recorded)
    dead = require_keyed(armature)
    find_parts(armature)
    yield None
    for missing in missing_parts(settings):
        raise MissingPart(missing)
    bound = yield from read_bound(armature, recording.frames)
    asked = partial(problem_of, skin=bound.skin, with_contacts=False)
    problem = asked(settings, recording)
    yield from require_writable(armature, recording, span_of(settings, recording))
    yield None
    session().advance(SolveState.SOLVING)
    session().support = None
    answer = yield from _analysed(kept, recording, problem)
    for _ in range(MOST_SNAPS):
        if answer.cycle is None or answer.cycle.as_asked:
            break
        armature = kept.found()
        _take_cycle(settings_of(armature), answer.cycle)
        recording = yield from steady(armature, read_wanted(armature))
        state, stood = AnalysedState.of(armature), armature.matrix_world.copy()
        problem = asked(settings_of(armature), recording)
        answer = yield from _analysed(kept, recording, problem)
    armature = kept.found()
    settings = settings_of(armature)
    contacts, flights = len(answer.schedule.contacts), len(answer.schedule.flights)
    factor = answer.odd_size
    odd = None if factor is None else OddHeight(armature.name, answer.height, factor)
    if odd is not None and (_is_carried(answer) or not flights):
        raise odd
    unseen = [each for each in answer.unseen if isinstance(each, UnseenSupport)]
    for each in unseen:
        if each.rate is not None:  # nothing carries: the scene plays it at a wrong speed
            raise wrong_speed(armature, present(recorded_action(armature)), each)
    offer = OfferedSupport.of(answer.unseen, problem.requests.points)
    session().support = (armature.session_uid, offer)
    yield None
    lost = write_analysis(settings, recording, answer)
    settings.analysed_state = state.as_text()
    keep(armature, answer.traces, stood)
    settings.shapes_told = shapes_told(bound, answer.bones, answer.fleshed)
    scene_settings(context.scene).armature = armature
    found = f"Found {contacts} contacts and {flights or 'no'} flight{'s' if flights > 1 else ''}"
    ranged = range_words(wanted, span, span_of(settings, recording))
    found = f"{found}{bind}{ranged}{_noise(recording, problem)}{_unseen(answer)}"
    if dead is not None:
        found += f". {said(dead).rstrip('.')}"
    if answer.cycle is None:
        found += _cut_flights(answer.schedule, span, recorded)
    if lost:
        found = f"{found}. {said(LostEdits(lost)).rstrip('.')}"
    return AnalysisOutcome(f"{found}; but {said(odd)}" if odd is not None else found, lost)


def _prepare_drag(context: bpy.types.Context) -> Incremental[None]:
    """Has the worker make meanwhile what the first drag would wait for, most likely of the contact
    that is chosen. What is wrong with what is asked is no fault of the analysis: Adapt tells."""
    settings = settings_of(required_armature(context))
    chosen = active_contact(settings)
    with suppress(Fault):
        asked = session().dragged = yield from ask_for(context)
        held = chosen.name if chosen is not None else ""
        shared().prepare(asked.recording, followed_problem(settings, asked, held))


def _cut_flights(
    schedule: ContactSchedule, span: tuple[float, float], recorded: tuple[float, float]
) -> str:
    """Words on a flight that goes on beyond the chosen frames, which only what is blended with the
    rest of the take would take along. recorded: first and last frame that there are."""
    begins = span[0] > recorded[0] and any(f.start == 0.0 for f in schedule.flights)
    ends = span[1] < recorded[1] and any(f.end == schedule.duration for f in schedule.flights)
    if not (begins or ends):
        return ""
    where = " and ".join(["begin"] * begins + ["end"] * ends)
    sooner = " and ".join(["before its take-off"] * begins + ["after its landing"] * ends)
    return (
        f". The frames {where} in the air, and what is moved bends the rest of that flight; "
        f"choose some that {where} {sooner}"
    )


def _noise(recording: Recording, problem: MotionProblem) -> str:
    """Words on noise that is not smoothed, which makes the fit long and bad."""
    if Mend.NOISE in problem.mend:
        return ""
    found = find_noise(recording, figure_of(recording, problem.bones))
    return f". {finding_sentence(found)} {SMOOTH_FIRST}" if found is not None else ""


def _unseen(answer: Analysed) -> str:
    """Words on where something unseen carries the body: everywhere."""
    return "".join(f". {said(each).rstrip('.')}" for each in together(answer.unseen))


def _leave_out_bind_pose(settings: HangtimeSettings, recording: Recording) -> str:
    """Where the artist chose no range, one that begins after a bind pose; and words that say so."""
    count = 0 if settings.use_range else bind_frames(recording)
    if count == 0:
        return ""
    frames = recording.frames
    settings.first_frame, settings.last_frame = int(frames[count]), int(frames[-1])
    settings.use_range = True
    held = (
        f"Frames {frames[0]:g} to {frames[count - 1]:g} hold"
        if count > 1
        else "The first frame holds"
    )
    return f". {held} the rest pose; the range begins at frame {frames[count]:g}"


def _require_inside(
    armature: bpy.types.Object, span: tuple[float, float], recorded: tuple[float, float]
) -> None:
    """Raises as `require_inside`, and SourceOutsideKeys where the result that is shown has keys."""
    shown, source = present(current_action(armature)), present(recorded_action(armature))
    try:
        require_inside(span, armature.name, recorded)
    except OutsideKeys:
        first, last = shown_range(armature, shown)
        if shown == source or span[0] >= last or span[1] <= first:
            raise
        raise SourceOutsideKeys(shown.name, source.name, *recorded) from None


def _take_cycle(settings: HangtimeSettings, cycle: Cycle) -> None:
    settings.first_frame, settings.last_frame = map(round, cycle.frames)
    settings.use_range = True


def _is_carried(answer: Analysed) -> bool:
    """Whether something that is not seen carries the body, or a floor that moves."""
    return any(not isinstance(each, OffBalance) for each in answer.unseen)


def _analysed(
    kept: Kept, recording: Recording, problem: MotionProblem
) -> Generator[PendingRequest | float | None, None, Analysed]:
    """The analysis; in the scene where without it something unseen carries the body, or a floor
    that moves.

    kept: whose it is. Raises any Fault of an analysis, and of reading the scene.
    """
    found = yield from answered(_ask(recording, problem), Analysed)
    if not _is_carried(found):
        return found
    armature = kept.found()
    scene = yield from steady(armature, read_surfaces(armature, recording.frames))
    if not any(thing.role is SceneRole.GROUND for thing in scene.objects):
        return found
    problem = replace(problem, scene=scene.objects)
    return (yield from answered(_ask(recording, problem), Analysed))


def _ask(recording: Recording, problem: MotionProblem) -> PendingRequest:
    return shared().ask(RequestKind.ANALYSE, recording, problem)


class FitOperator(TaskOperator, bpy.types.Operator):
    bl_idname = OperatorId.FIT
    bl_label = "Fit"
    bl_description = (
        "Find the motion nearest to the recording that obeys physics, and say how near it is. "
        "Adapt does this by itself where it is not done yet"
    )
    bl_options = {"UNDO"}

    def task(self, context: bpy.types.Context) -> Task:
        kept = Kept.of(required_armature(context))
        asked = yield from ask_for(context)
        session().advance(SolveState.SOLVING)
        job = shared().ask(RequestKind.FIT, asked.recording, asked.problem)
        answer = yield from answered(job, Fitted)
        settings_of(kept.found()).fit_quality = quality(answer.quality, answer.needs)
        return f"Fitted in {answer.seconds:.1f} s: {in_words(answer.quality, answer.needs)}"


def in_words(fit: FitQuality, needs: FitNeeds) -> str:
    """Quality of a fit in words."""
    off = fit.joint_centres_rms_cm
    words = next((words for limit, words in CLOSENESS_WORDS if off < limit), LOOSE)
    if words != LOOSE and fit.is_far_somewhere:
        words += ", but far from it in one place"
    told = accepted_lines(needs)
    return f"{words}. {'. '.join(told)}" if told else words


def quality(fit: FitQuality, needs: FitNeeds) -> str:
    """Lines for the sidebar."""
    words = in_words(fit, FitNeeds())
    return "\n".join(
        [
            f"{words[0].upper()}{words[1:]}",
            f"Joints {fit.joint_centres_rms_cm:.1f} cm apart"
            f"{apex_words(fit.pelvis_apex_difference_cm)}",
            f"At worst {fit.worst_frame_rms_cm:.1f} cm (frame {fit.worst_frame:.0f})",
            *accepted_lines(needs),
        ]
    )
