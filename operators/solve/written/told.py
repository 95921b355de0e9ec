"""What is told of a result: in the sidebar, in its report, and before it is accepted."""

from collections.abc import Sequence

import bpy

from ....bridge.accessors import present, source_of
from ....bridge.armature.incremental import Incremental
from ....bridge.armature.strips import hidden_beyond, layers_above
from ....bridge.constraints.standing import missed_contacts
from ....bridge.constraints.status import retimed_frames, write_status
from ....bridge.controls.driven import is_driven
from ....bridge.controls.missed.aimed import aimed_in
from ....bridge.controls.missed.held import held_bones
from ....bridge.controls.missed.kept import KeptByControls
from ....bridge.polish.pins import MovedPin
from ....bridge.polish.renewal import Renewal
from ....bridge.properties.action import action_settings
from ....bridge.properties.of_actions.shown_overlaps import store_overlaps
from ....bridge.properties.of_actions.shown_times import store_times
from ....bridge.properties.settings import settings_of
from ....bridge.rows.phases import roles_in
from ....solver.body.character import build_character
from ....solver.data.problem import MotionProblem
from ....solver.data.recording import PoseTrack, Recording
from ....solver.worker.protocol import Adapted
from ...words.headline import missed_body_lines, missed_line
from ...words.report_text import as_text
from ...words.summary_text import summary
from ...words.take_text import LEAST_SHIFT_MM, aimed_line, apart_lines, pin_lines, polish_lines
from ...words.warning_text import warnings_of

HELD = (
    "Constraints keep {} from the result (frame {:g}), so it is not what was solved; mute them and "
    "press Update"
)
LAYERS_HIDDEN = (
    "Strips above the take's ({}) do not add to this result, for an action goes before all strips; "
    "choose NLA Strip, Replace or Combine, under Written As"
)
OTHERS_HIDDEN = (
    "Before and after its own frames this result hides other strips of the shot, which the take's "
    "strip ({}) does not; choose NLA Strip, Replace, under Written As"
)


def note(
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
    called = roles_in(settings, answer.report)
    said = summary(answer, called, retimed_frames(settings, answer.report.times))
    settings.status = "\n".join([said, *told])
    write_status(settings, answer.report)
    action_settings(action).report = "\n".join([as_text(answer.report), *told])
    store_times(action, answer.report.times)
    store_overlaps(action, answer.report)
    action_settings(action).warning = "\n".join(warnings_of(answer.report))
    if performer != armature:
        action_settings(action).performer = performer


def layers_lines(
    armature: bpy.types.Object, action: bpy.types.Action, *, in_slot: bool = False
) -> list[str]:
    """Which of the artist's strips acted on what a result was made from, and do not on it, and
    whether it hides others of the shot."""
    layers = layers_above(armature, present(source_of(action)))
    hiding = hidden_beyond(armature, action, in_slot=in_slot)
    lines = [LAYERS_HIDDEN.format(", ".join(layers))] if layers else []
    return lines if hiding is None else [*lines, OTHERS_HIDDEN.format(hiding)]


def tell_aimed(
    armature: bpy.types.Object,
    bones: tuple[str, ...],
    recording: Recording,
    problem: MotionProblem,
    track: PoseTrack,
) -> None:
    """How far bones that stay aimed are from the solution's track, as a warning where that counts,
    and which poses leave them out. recording: its frames that are adapted."""
    action = present(settings_of(armature).adapted)
    figure = build_character(
        recording, mass=problem.mass, table=problem.mass_table, chosen=problem.bones
    )
    aimed = aimed_in(armature, bones, track, figure.bodies)
    if aimed is not None:
        far, line = aimed.mm > LEAST_SHIFT_MM, aimed_line(aimed)
        apart = apart_lines(problem.requests.poses, track.bones)
        warn(armature, action, [line] * far, [*[line] * (not far), *apart])


def tell_unmet(
    armature: bpy.types.Object, action: bpy.types.Action, track: PoseTrack
) -> Incremental[None]:
    """Which bones constraints keep from the result, such as a limit that the take did not reach."""
    if is_driven(armature, track.bones):  # what controls miss is told as they are written
        return
    held = yield from held_bones(armature, track.bones, track.frames)
    if held:
        warn(armature, action, [HELD.format(", ".join(held), min(held.values()))])


def tell_missed(
    armature: bpy.types.Object,
    performer: bpy.types.Object,
    action: bpy.types.Action,
    answer: Adapted,
) -> Incremental[None]:
    """Where points that stand are not where they were solved to be: before all else, and among the
    warnings. performer: who shows the action."""
    missed = yield from missed_contacts(performer, answer.schedule, answer.traces)
    if missed:
        settings, made, line = settings_of(armature), action_settings(action), missed_line(missed)
        settings.status, made.report = f"{line}\n{settings.status}", f"{line}\n{made.report}"
        made.warning = "\n".join([line for line in (line, made.warning) if line])


def tell_polish(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    renewal: Renewal,
    moved: Sequence[MovedPin],
) -> None:
    """What became of hand polish: in the sidebar, the report, and among the warnings."""
    warn(armature, action, pin_lines(moved), polish_lines(renewal.put))


def warn_of_controls(action: bpy.types.Action, kept: KeptByControls | None) -> None:
    """Warn, before a result is accepted, of bones that controls, if there are any, leave far from
    the solution; status and report tell what controls miss, with the take."""
    if kept is not None:
        made = action_settings(action)
        lines = (made.warning, *missed_body_lines(kept.lost))
        made.warning = "\n".join([line for line in lines if line])


def warn(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    warned: Sequence[str],
    told: Sequence[str] = (),
) -> None:
    """Say more of a result in the sidebar and its report, and warn before it is accepted."""
    settings, made = settings_of(armature), action_settings(action)
    settings.status = "\n".join([settings.status, *told, *warned])
    made.report = "\n".join([made.report, *told, *warned])
    made.warning = "\n".join([line for line in (made.warning, *warned) if line])
