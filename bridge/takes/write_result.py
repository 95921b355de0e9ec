"""Results as actions: the whole take with the adapted motion in it, or that motion alone."""

from __future__ import annotations

from functools import partial

import bpy

from ..accessors import ATTRIBUTE, current_action, present, source_of
from ..action_slots import all_curves
from ..armature import fcurves
from ..armature.actions import recorded_action, show, showing_action
from ..armature.incremental import Incremental, complete
from ..armature.played import in_scene_time, scene_copy
from ..armature.strips import lay_strips, strips_of
from ..armature.write import write_incrementally
from ..controls.driven import is_driven
from ..properties.settings import settings_of
from ..rows.choices import After, WrittenAs
from .difference import difference_of
from .plan import AdaptedMotion
from .span import WrittenTake
from .takes import derive, free_name, root_of
from .whole_take import write_take


def write_result(
    armature: bpy.types.Object, motion: AdaptedMotion, *, name: str
) -> tuple[bpy.types.Action, WrittenTake | None]:
    """Write a motion that was made from the armature's action, and assign the result.

    Returns what was done to the take, None where the adapted frames are alone.
    """
    recorded, slot = present(current_action(armature)), fcurves.slot_identifier(armature)
    action, written = complete(_write(armature, motion, recorded, slot, name))
    fcurves.assign(armature, action, slot)
    return action, written


def write_adapted_incrementally(
    armature: bpy.types.Object, motion: AdaptedMotion
) -> Incremental[tuple[bpy.types.Action, WrittenTake | None]]:
    """Write an adapted performance as a new action, which is assigned and knows its recording.

    Before the last slice the armature is as it was. Returns as `write_result`.
    """
    original, slot = present(recorded_action(armature)), fcurves.slot_identifier(armature)
    name = free_name(root_of(original).name, "adapted")
    action, written = yield from _write(armature, motion, original, slot, name)
    derive(action, original, armature)
    if motion.options.written_as is WrittenAs.STRIP:
        lay_strips(armature, original, action, slot)
    show(armature, action, slot)
    settings_of(armature).adapted = action
    return action, written


def combine(armature: bpy.types.Object, action: bpy.types.Action, after: After) -> None:
    """Lay a result that is shown, with the keys that it is to have, as its difference from what it
    was made from into a strip on top of that."""
    take, slot = source_of(action), fcurves.slot_identifier(armature)
    with in_scene_time(armature, present(take)) as played:
        more = difference_of(armature, played, action, slot)
    lay_strips(armature, present(take), action, slot, more)
    if after is After.CUT:  # nothing of it is left beside the adapted frames
        for _, strip in strips_of(armature, action):
            strip.extrapolation = "NOTHING"
    show(armature, action, slot)


def _write(
    armature: bpy.types.Object,
    motion: AdaptedMotion,
    recorded: bpy.types.Action,
    slot: str | None,
    name: str,
) -> Incremental[tuple[bpy.types.Action, WrittenTake | None]]:
    cut_off = motion.options.after is After.CUT
    if cut_off and not is_driven(armature, motion.track.bones):
        showing = partial(showing_action, armature, recorded)
        cut = yield from write_incrementally(
            armature, motion.track, recorded, slot, name=name, showing=showing
        )
        forget_copied(cut)
        return cut, None
    action = scene_copy(armature, recorded, name)
    forget_copied(action)
    whole = False
    try:
        written = yield from write_take(armature, action, slot, motion)
        if cut_off:
            for curve in all_curves(action):
                fcurves.crop(curve, float(motion.track.frames[0]), float(motion.track.frames[-1]))
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    recorded.use_fake_user = True
    return action, written


def forget_copied(action: bpy.types.Action) -> None:
    """Remove what a copy has of the take's own history, where that is a result itself."""
    for name in tuple(action.keys()):
        if name.startswith(ATTRIBUTE):
            del action[name]
    settings = getattr(action, ATTRIBUTE, None)  # none without registration
    if settings is not None:
        for each in settings.bl_rna.properties:
            settings.property_unset(each.identifier)
