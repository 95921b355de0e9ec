"""Keys of a result, as the panel or the armature's recipe text asks for them."""

import bpy

from ...bridge.accessors import present
from ...bridge.armature import fcurves
from ...bridge.armature.actions import recorded_action
from ...bridge.armature.incremental import Incremental
from ...bridge.controls.driven import is_driven
from ...bridge.keys.events import events_of
from ...bridge.keys.written import KeyedAction, choose_keys
from ...bridge.properties.settings import HangtimeSettings, action_settings, settings_of
from ...bridge.recipe.keys import KeyOptions
from ...bridge.recipe.problem import parse_recipe
from ...bridge.rows.choices import KeyChoice
from ...solver.worker.protocol import Adapted
from ..words.report_text import keys_line


def key_options(settings: HangtimeSettings) -> KeyOptions:
    """The options; [keys] in the armature's text go before the panel. Raises BadRecipe."""
    text = settings.requests
    stated = None if text is None else parse_recipe(text.as_string(), text.name).keys
    if stated is not None:
        return stated
    panel = settings.result_keys
    return KeyOptions(KeyChoice[panel.on], panel.distance / 1000.0, panel.angle)


def write_keys(
    armature: bpy.types.Object,
    performer: bpy.types.Object,
    action: bpy.types.Action,
    answer: Adapted,
) -> Incremental[None]:
    """Give an action that a performer shows the keys that are asked for, and tell what they leave.

    armature: whose settings count. The action has a key on every frame before, and stays so where
    the artist cancels.
    """
    settings = settings_of(armature)
    options = key_options(settings)
    if options.on is KeyChoice.EVERY_FRAME:
        return
    track, rate = answer.track, answer.report.recording.frames_per_second
    take = fcurves.holder_in(present(recorded_action(armature)), fcurves.slot_identifier(armature))
    slot = fcurves.slot_identifier(performer)
    keyed = KeyedAction(action, slot, track.bones, track.frames, take)
    events = events_of(answer.schedule, float(track.frames[0]), rate)
    if is_driven(performer, track.bones):
        line = "Keys: on every frame, as on all rigs that are posed through controls"
    else:
        line = f"Keys: {keys_line((yield from choose_keys(performer, keyed, options, events)))}"
    settings.status = f"{settings.status}\n{line}"
    stored = action_settings(action)
    stored.report = f"{stored.report}\n{line}\n"
