"""Writes an answer of the solver as a result: an action, its strip or slot, marks and report."""

from dataclasses import replace
from math import isclose

import bpy

from ...bridge.accessors import current_action, current_scene, present, root_of, source_of
from ...bridge.armature.actions import read_recorded_incrementally, recorded_action
from ...bridge.armature.incremental import Incremental, complete
from ...bridge.armature.poses import frames_per_second, require_unstretched
from ...bridge.armature.traces_store import keep
from ...bridge.armature.write import write_action
from ...bridge.controls.missed.aimed import without
from ...bridge.files.reproportioned import build_reproportioned, in_new_axes
from ...bridge.loops.write_loop import Loop, write_loop_incrementally
from ...bridge.polish.renewal import Renewal
from ...bridge.properties.action import action_settings
from ...bridge.properties.of_actions.known_contacts import SolvedContacts, keep_contacts
from ...bridge.properties.settings import settings_of
from ...bridge.recipe.result import require_return_after
from ...bridge.repairs.analysed_state import AnalysedState, posed_otherwise
from ...bridge.repairs.analysis_key import SAME_RATE
from ...bridge.results.made import adapted_spans, note_made
from ...bridge.rows.choices import After, ContactMarkers, WrittenAs
from ...bridge.rows.phases import roles_in
from ...bridge.scene.played_end import play_longer
from ...bridge.takes.owned import owned_channels
from ...bridge.takes.plan import AdaptedMotion
from ...bridge.takes.span import ResultSpan
from ...bridge.takes.take_time import TakeTime
from ...bridge.takes.takes import derive, free_name
from ...bridge.takes.write_result import combine, lay_in_slot, write_adapted_incrementally
from ...solver.analysis.motion_sketch import MotionSketch
from ...solver.body.proportions import changed_recording
from ...solver.data.faults import ChangedMeanwhile, EditedMeanwhile, Fault, RateChanged
from ...solver.data.recording import Recording, same_motion
from ...solver.data.solver_options import Method
from ...solver.worker.protocol import Adapted
from ..words.headline import blend_lines, slide_lines
from ..words.take_text import take_lines
from .meanwhile.standing import Kept
from .meanwhile.steady import steady
from .meanwhile.undisturbed import undisturbed
from .scene import note_surfaces, stale_surfaces
from .session import Asked, session
from .solving import SolveState
from .watch import look_soon
from .written.keys import mark_contacts, write_keys
from .written.told import (
    layers_lines,
    note,
    tell_aimed,
    tell_missed,
    tell_polish,
    tell_unmet,
    warn,
    warn_of_controls,
)

ALONE = (
    "The rest of the take is left out: {} has other limbs, and performs the adapted frames alone"
)
FORMS = {
    WrittenAs.ACTION: "action",
    WrittenAs.STRIP: "strip",
    WrittenAs.COMBINE: "strip",
    WrittenAs.SLOT: "slot",
}
SCENE_LONGER = "{} scene now ends at frame {}"
MARKERS_LEFT_OUT = (
    "Contact markers are left out: an action's are those of all of its slots, the take's included; "
    "choose Timeline"
)


def write_answer(asked: Asked, answer: Adapted) -> Incremental[str]:
    """Writes an answer as a new action; returns how it went. Raises RateChanged,
    ChangedMeanwhile, ArmatureGone, EditedMeanwhile, ActionGone, ReturnTooEarly,
    ChangedWhileRead.

    Surfaces that changed meanwhile do not void it: it says that it is not about them any more.
    """
    session().advance(SolveState.CHECKING)
    armature = yield from _unchanged(asked)
    stale = yield from steady(armature, stale_surfaces(asked, armature))
    session().advance(SolveState.WRITING)
    return (yield from undisturbed(armature, _write(asked, answer, armature, stale)))


def _write(
    asked: Asked, answer: Adapted, armature: bpy.types.Object, stale: tuple[str, ...]
) -> Incremental[str]:
    """The answer as a result, and all that is told of it."""
    if asked.problem.requests.body.limbs:
        done = yield from _write_other(asked, answer, armature)
    else:
        written = replace(answer, track=without(answer.track, asked.aimed))
        done = yield from _write_own(asked, written, armature)
        if asked.aimed:
            tell_aimed(armature, asked.aimed, asked.window, asked.problem, answer.track)
    remarks = note_surfaces(armature, asked, answer.report, stale)
    settings = settings_of(armature)
    scene, told = current_scene(), [settings.status, *remarks]
    if play_longer(scene, armature, present(settings.adapted)):
        told.append(SCENE_LONGER.format("The", scene.frame_end))
        remarks.append(SCENE_LONGER.format("the", scene.frame_end))
    refined = asked.problem.requests.solution.method is Method.EXPLICIT
    action_settings(present(settings.adapted)).refined = refined
    settings.status = "\n".join(told)
    look_soon()  # the result before has its own settings again
    return "; ".join([done, *remarks])


def _write_own(asked: Asked, answer: Adapted, armature: bpy.types.Object) -> Incremental[str]:
    """The answer as a new action of the armature. Raises ReturnTooEarly."""
    stood = armature.matrix_world.copy()
    looped, options = asked.loop, asked.result
    if looped is not None:
        loop = Loop.of(armature, answer.track, looped.root)
        action, made = yield from write_loop_incrementally(armature, loop)
        keep(action, answer.traces, stood)
        told = [*take_lines(made), *layers_lines(armature, action)]
        note(armature, armature, action, answer, told)
        warn_of_controls(action, made.controls)
        if loop.travels:
            complete(tell_missed(armature, armature, action, answer))
        mark_contacts(armature, action, answer, options)
        keep_contacts(action, _solved_contacts(asked, answer))
        note_made(armature, action, None, 0, asked.settings)
        return f"Wrote the loop {action.name}"
    require_return_after(options, answer.report.times.recorded_frame[-1])
    renewal = Renewal.of(armature)
    motion = AdaptedMotion(
        answer.track,
        answer.report.times,
        answer.moved,
        options,
        ends=any(hold.ends for hold in asked.problem.requests.holds),
        kept=adapted_spans(present(recorded_action(armature))),
        touching=answer.schedule.bones,
    )
    action, written = yield from write_adapted_incrementally(armature, motion)
    present(session().solving).written = True
    keep(action, answer.traces, stood)
    told = take_lines(written, roles_in(settings_of(armature), answer.report))
    if options.written_as is WrittenAs.SLOT and options.markers is ContactMarkers.ACTION:
        told = [*told, MARKERS_LEFT_OUT]
    if options.written_as in (WrittenAs.ACTION, WrittenAs.SLOT):
        in_slot = options.written_as is WrittenAs.SLOT
        told = [*told, *layers_lines(armature, action, in_slot=in_slot)]
    note(armature, armature, action, answer, told)
    if written is not None:
        warn_of_controls(action, written.controls)
        warn(armature, action, [*blend_lines(written.blends), *slide_lines(written.slide)])
    times = answer.report.times
    time = written.time if written is not None else TakeTime.of(times, 1.0)
    span = written.span if written is not None else None
    keep_contacts(action, _solved_contacts(asked, answer), asked.recording.known, time.later)
    finishing = _finish(armature, action, asked, answer, renewal, span, time)
    try:
        yield from tell_missed(armature, armature, action, answer)
        rate = answer.report.recording.frames_per_second
        own = owned_channels(armature, answer.track.bones)
        owned = {channel.path for channel in own} if written is None else written.owned
        moved = yield from renewal.put_on(action, owned, time, answer.schedule, rate)
        tell_polish(armature, action, renewal, moved)
        rig = written.rig if written is not None else None
        yield from write_keys(armature, armature, action, answer, asked.keys, rig)
        yield from tell_unmet(armature, action, answer.track)
        for _ in finishing:  # not "yield from", which would close it with what it is part of
            yield None
    except (Fault, ReferenceError):  # by which the result goes
        finishing.close()
        raise
    finally:
        complete(finishing)  # cancelled, the result has a key on every frame
    return f"Wrote the {FORMS[options.written_as]} {action.name}"


def _finish(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    asked: Asked,
    answer: Adapted,
    renewal: Renewal,
    span: ResultSpan | None,
    time: TakeTime,
) -> Incremental[None]:
    """What makes written keys a result: its contacts, its form, and what it was made of."""
    options = asked.result
    mark_contacts(armature, action, answer, options)
    yield None
    match options.written_as:
        case WrittenAs.COMBINE:
            combine(armature, action, options.after)
        case WrittenAs.SLOT:
            lay_in_slot(armature, present(source_of(action)), action)
    yield None
    note_made(armature, action, span, time.later, asked.settings)
    yield None
    frames = answer.report.times.recorded_frame
    renewal.note(action, time, (frames[0], frames[-1]))


def _solved_contacts(asked: Asked, answer: Adapted) -> SolvedContacts:
    rate = answer.report.recording.frames_per_second
    return SolvedContacts(answer.schedule, answer.track.frames, rate, asked.problem.scene)


def _write_other(asked: Asked, answer: Adapted, armature: bpy.types.Object) -> Incremental[str]:
    """The answer on an armature of its own, for the artist's keeps its proportions."""
    recording = changed_recording(asked.window, asked.problem.requests.body.limbs)
    other, track, turns = build_reproportioned(recording, answer.track)
    other.name = f"{armature.name} changed"
    source = present(recorded_action(armature))
    scaffold = present(current_action(other))  # poses that only the result is written from
    action = write_action(other, track, name=free_name(root_of(source).name, "adapted"))
    derive(action, source, armature)
    bpy.data.actions.remove(scaffold)
    settings_of(armature).adapted = action
    present(session().solving).written = True
    keep(action, answer.traces, armature.matrix_world)
    options = asked.result
    left_out = [] if options.after is After.CUT else [ALONE.format(other.name)]
    note(armature, other, action, answer, left_out)
    turned = replace(answer, schedule=in_new_axes(answer.schedule, turns))
    yield from tell_missed(armature, other, action, turned)
    yield from write_keys(armature, other, action, answer, asked.keys)
    mark_contacts(other, action, answer, options)
    return f"Made the armature {other.name}, which performs the adapted motion"


def _unchanged(asked: Asked) -> Incremental[bpy.types.Object]:
    """The armature, if it and its recording are what they were. Raises RateChanged,
    ChangedMeanwhile, ArmatureGone, EditedMeanwhile, TimeStretched."""
    require_unstretched(current_scene())
    before, rate = asked.recording.rate, frames_per_second(current_scene())
    if not isclose(before, rate, rel_tol=SAME_RATE):
        raise RateChanged(before, rate, while_solving=True)
    armature = Kept(asked.uid, asked.armature).found()
    if armature.mode == "EDIT":
        raise EditedMeanwhile(armature.name)
    if recorded_action(armature) is not None:
        frames = asked.recording.frames
        try:
            reading = read_recorded_incrementally(armature, frames[0], frames[-1])
            now = yield from steady(armature, reading)
        except Fault as fault:  # another action, a scale: whatever it is, it is new
            raise _changed(asked, armature, None) from fault
        if same_motion(replace(now, times=asked.recording.times), asked.recording):
            return armature
        raise _changed(asked, armature, now)
    raise _changed(asked, armature, None)


def _changed(asked: Asked, armature: bpy.types.Object, now: Recording | None) -> ChangedMeanwhile:
    """What is to be said of an armature, by its present name, that is another than was asked about.
    now: its recording, where that can be read."""
    parts = () if asked.state is None else AnalysedState.of(armature).since(asked.state)
    if now is not None and not parts:
        parts = posed_otherwise(MotionSketch.of(asked.recording), now)
    return ChangedMeanwhile(armature.name, while_solving=True, changed=parts)
