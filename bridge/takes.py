"""The recording's action and the actions made from it: which is which, reading and writing them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..solver.recording import PoseTrack, Recording
from . import fcurves
from .read import read_recording
from .write import write_action


def current_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The action that animates the armature now."""
    data = armature.animation_data
    return data.action if data is not None else None


def recorded_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The recording's: the armature's action, or the one that this was adapted from."""
    action = current_action(armature)
    if action is None:
        return None
    return action.hangtime.recording or action


def read_take(
    armature: bpy.types.Object | None, first: float | None, last: float | None
) -> Recording:
    """Reads the recording, whichever of its actions is shown. Raises as `read_recording`."""
    if armature is None or current_action(armature) is None:
        return read_recording(armature, first=first, last=last)
    with _showing(armature, recorded_action(armature)):
        return read_recording(armature, first=first, last=last)


def write_take(armature: bpy.types.Object, track: PoseTrack) -> bpy.types.Action:
    """Writes an adapted performance as a new action, which is assigned and knows its recording."""
    recorded = recorded_action(armature)
    assert recorded is not None
    with _showing(armature, recorded):
        action = write_action(armature, track, name=f"{recorded.name} adapted")
        action.hangtime.recording = recorded
        action.use_fake_user = True  # the next adaptation must not cost the artist this one
        slot = fcurves.slot_identifier(armature)
    show(armature, action, slot)
    armature.hangtime.adapted = action
    return action


def show(armature: bpy.types.Object, action: bpy.types.Action, slot: str | None = None) -> None:
    """Lets the armature perform an action; the pose follows."""
    fcurves.assign(armature, action, slot or fcurves.slot_identifier(armature))
    scene = bpy.context.scene
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


@contextmanager
def _showing(armature: bpy.types.Object, action: bpy.types.Action | None) -> Iterator[None]:
    """The armature performs `action`; what it performed before comes back."""
    before, slot = current_action(armature), fcurves.slot_identifier(armature)
    if action == before:
        yield
        return
    fcurves.assign(armature, action, slot)
    try:
        yield
    finally:
        show(armature, before, slot)
