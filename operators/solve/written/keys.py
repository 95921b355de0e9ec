"""Keys of a result, as the panel or the armature's recipe text asks for them."""

from math import degrees, radians

import bpy

from ....bridge.accessors import present
from ....bridge.armature import fcurves
from ....bridge.armature.actions import recorded_action
from ....bridge.armature.incremental import Incremental
from ....bridge.armature.played import in_scene_time
from ....bridge.controls.control_rig import ControlRig
from ....bridge.keys.contact_marks import limb_contacts, write_contact_channels, write_markers
from ....bridge.keys.events import events_of
from ....bridge.keys.written import KeyedAction, choose_keys
from ....bridge.properties.action import action_settings
from ....bridge.properties.settings import HangtimeSettings, settings_of
from ....bridge.recipe.keys import KeyOptions
from ....bridge.recipe.result import ResultOptions
from ....bridge.rows.choices import KeyChoice
from ....bridge.takes.options import text_of
from ....solver.worker.protocol import Adapted
from ...words.report_text import keys_line


def key_options(settings: HangtimeSettings) -> KeyOptions:
    """The options; [keys] in the armature's text go before the panel. Raises BadRecipe."""
    text = text_of(settings)
    if text is not None and text.keys is not None:
        return text.keys
    panel = settings.result_keys
    # As the panel shows it: Blender's single precision is not what a person asked for.
    angle = radians(round(degrees(panel.angle), 4))
    return KeyOptions(KeyChoice[panel.on], panel.distance / 1000.0, angle)


def mark_contacts(
    armature: bpy.types.Object, action: bpy.types.Action, answer: Adapted, options: ResultOptions
) -> None:
    """Tell contacts of a result that an armature shows by markers and channels, as is asked for."""
    frames, rate = answer.track.frames, answer.report.recording.frames_per_second
    found = limb_contacts(answer.schedule, float(frames[0]), rate)
    between = round(frames[0]), round(frames[-1])
    write_markers(action, found, between, options.markers)
    curves = fcurves.holder_in(action, fcurves.slot_identifier(armature))
    if options.contact_channels and curves is not None:
        write_contact_channels(armature, curves, found, between)


def write_keys(
    armature: bpy.types.Object,
    performer: bpy.types.Object,
    action: bpy.types.Action,
    answer: Adapted,
    options: KeyOptions,
    rig: ControlRig | None = None,
) -> Incremental[None]:
    """Give an action that a performer shows the keys that are asked for, and tell what they leave.

    armature: who has the recording. rig: the controls that pose the performer, if such do. The
    action has a key on every frame before, and stays so where the artist cancels.
    """
    settings = settings_of(armature)
    if options.on is KeyChoice.EVERY_FRAME:
        return
    track, rate = answer.track, answer.report.recording.frames_per_second
    slot = fcurves.slot_identifier(performer)
    events = events_of(answer.schedule, float(track.frames[0]), rate)
    with in_scene_time(armature, present(recorded_action(armature))) as recording:
        take = fcurves.holder_in(recording, fcurves.slot_identifier(armature))
        keyed = KeyedAction(action, slot, track.bones, track.frames, take, rig)
        report = yield from choose_keys(performer, keyed, options, events)
    line = f"Keys: {keys_line(report)}"
    settings.status = f"{settings.status}\n{line}"
    stored = action_settings(action)
    stored.report = f"{stored.report}\n{line}\n"
