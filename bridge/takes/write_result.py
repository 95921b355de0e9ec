"""Results as actions: the whole take with the adapted motion in it, or that motion alone; and as
strips over the take's, or slots (Blender 4.4) beside it."""

from __future__ import annotations

from dataclasses import replace

import bpy

from ...solver.data.faults import NoNewSlot
from ..accessors import ATTRIBUTE, current_action, present, root_of, source_of
from ..action_slots import all_curves, bag_of, home_of, settle
from ..armature import fcurves
from ..armature.actions import note_take, recorded_action, show, slices_showing
from ..armature.incremental import Incremental, complete
from ..armature.played import in_scene_time, scene_copy
from ..armature.strips import lay_strips
from ..armature.write import write_incrementally
from ..companions.found import placed_by_keys
from ..controls.driven import is_driven
from ..fake_users import guard
from ..properties.settings import settings_of
from ..rows.choices import After, WrittenAs
from .difference import difference_of
from .plan import AdaptedMotion
from .span import ResultSpan, WrittenTake
from .takes import derive, free_name
from .whole_take import write_take

_NO_SLOTS = "Blender before 4.5 cannot copy one"
_LINKED = "the action is linked from another file"


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
    lay_strips(armature, present(take), action, slot, more, alone=after is After.CUT)
    show(armature, action, slot)


def require_slot(armature: bpy.types.Object) -> None:
    """Raises NoNewSlot where what results are made from can have no more slots."""
    take = present(recorded_action(armature))
    home = home_of(take)
    action = take if home is None else home[0]
    if bpy.app.version < (4, 5):
        raise NoNewSlot(action.name, _NO_SLOTS)
    if not action.is_editable:
        raise NoNewSlot(action.name, _LINKED)


def lay_in_slot(
    armature: bpy.types.Object, take: bpy.types.Action, result: bpy.types.Action
) -> None:
    """Move the keys of a result that an armature shows into a new slot of the action that holds the
    take it was made from, whose own slots stay as they are. The armature shows this slot.

    The slot starts as a copy of the take's, with its groups and modifiers. Pose markers are the
    whole action's, so those of the result are left out.
    """
    name = fcurves.slot_identifier(armature)
    home = home_of(take)
    action, old = home or (take, next(s for s in take.slots if s.identifier == name))
    beside = next(s for s in action.slots if s.identifier == name)
    made = old.duplicate()
    made.name_display = result.name
    curves = fcurves.holder_in(result, name)
    assert curves is not None
    _become(present(bag_of(action, made)), curves)
    for slot in list(result.slots):
        result.slots.remove(slot)
    for marker in list(result.pose_markers):
        result.pose_markers.remove(marker)
    result.use_frame_range = False
    settle(result, (action, made), beside)
    result.use_fake_user = True  # it lasts as long as its slot
    fcurves.assign(armature, result)
    show(armature, result)


def _become(made: bpy.types.ActionChannelbag, curves: fcurves.CurveHolder) -> None:
    """Let the copy of a take's curves be a result's, which were one too."""
    for curve in list(made.fcurves):
        if curves.fcurves.find(curve.data_path, index=curve.array_index) is None:
            made.fcurves.remove(curve)
    for curve in curves.fcurves:
        group = curve.group.name if curve.group is not None else ""
        own = fcurves.ensured(made, curve.data_path, curve.array_index, group)
        if not len(curve.modifiers):
            for modifier in list(own.modifiers):
                own.modifiers.remove(modifier)
        own.extrapolation, own.mute = curve.extrapolation, curve.mute
        fcurves.put(own, fcurves.table(curve))


def remove_slot(result: bpy.types.Action) -> None:
    """Remove the slot that a result is, if it is one."""
    home = home_of(result)
    if home is not None:
        home[0].slots.remove(home[1])


def _write(
    armature: bpy.types.Object,
    motion: AdaptedMotion,
    recorded: bpy.types.Action,
    slot: str | None,
    name: str,
) -> Incremental[tuple[bpy.types.Action, WrittenTake | None]]:
    cut_off, bones = motion.options.after is After.CUT, motion.track.bones
    if cut_off and not (
        is_driven(armature, bones) or _has_company(armature, recorded, slot, bones)
    ):
        showing = slices_showing(armature, recorded)
        cut = yield from write_incrementally(
            armature,
            motion.track,
            recorded,
            slot,
            name=name,
            frames=motion.recorded_frames,
            showing=showing,
        )
        forget_copied(cut)
        _state_range(cut, motion, None)
        note_take(armature, cut, recorded)
        return cut, None
    action = scene_copy(armature, recorded, name)
    forget_copied(action)
    whole = False
    try:
        written = yield from write_take(armature, action, recorded, slot, motion)
        if cut_off:
            for curve in all_curves(action):
                fcurves.crop(curve, float(motion.track.frames[0]), float(motion.track.frames[-1]))
            written = _alone(written)
        _state_range(action, motion, None if cut_off else written)
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    guard(recorded)
    return action, written


def _alone(written: WrittenTake) -> WrittenTake:
    """What is left of what was done to a take where its adapted frames are cut out of it."""
    first, last = written.span.first, written.span.last
    span = ResultSpan(first, last, first, last, 0.0, 0.0)
    return replace(written, span=span, moved=None, back=None, slide=0.0, blends=())


def _state_range(
    action: bpy.types.Action, motion: AdaptedMotion, written: WrittenTake | None
) -> None:
    """Has a copy's manual frame range, which exports go by, hold the adapted frames; these only
    where nothing is written of the take. A cycle whose ends change is none any more."""
    if not action.use_frame_range:
        return
    first, last = motion.track.frames[[0, -1]].tolist()
    start, end = action.frame_start, action.frame_end
    if written is None:
        start, end, action.use_cyclic = first, last, False
    else:
        left, right = written.span.between
        if left < start or right > end or (written.moved is not None and written.back is None):
            action.use_cyclic = False
        start, end = min(start, first), max(end, last)
    action.frame_start, action.frame_end = start, end


def _has_company(
    armature: bpy.types.Object, take: bpy.types.Action, slot: str | None, bones: tuple[str, ...]
) -> bool:
    """Whether a take moves other bones than the body's, which may have to go along with it."""
    curves = fcurves.holder_in(take, slot)
    return curves is not None and bool(placed_by_keys(armature, curves, bones))


def forget_copied(action: bpy.types.Action) -> None:
    """Remove what a copy has of the take's own history, where that is a result itself."""
    for name in tuple(action.keys()):
        if name.startswith(ATTRIBUTE):
            del action[name]
    settings = getattr(action, ATTRIBUTE, None)  # none without registration
    if settings is not None:
        for each in settings.bl_rna.properties:
            settings.property_unset(each.identifier)
