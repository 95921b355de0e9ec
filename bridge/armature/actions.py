"""The recording's action and the actions made from it: which is which, reading and writing them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack, Recording
from ..accessors import current_action, current_scene
from ..properties.settings import action_settings, settings_of
from . import fcurves
from .incremental import Parts, complete, sample_in_parts
from .poses import Poses, sample
from .read import recorded, whole_frames
from .write import write_in_parts


def recorded_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The recording's: the armature's action, or the one that this was adapted from."""
    action = current_action(armature)
    if action is None:
        return None
    return action_settings(action).recording or action


def read_take(
    armature: bpy.types.Object | None, first: float | None, last: float | None
) -> Recording:
    """Reads the recording, whichever of its actions is shown. Raises as `read_recording`."""
    return complete(read_take_in_parts(armature, first, last))


def read_take_in_parts(
    armature: bpy.types.Object | None, first: float | None, last: float | None
) -> Parts[Recording]:
    """The same, a few frames a part."""
    if armature is None or current_action(armature) is None:
        whole_frames(armature, first, last)
    assert armature is not None
    showing = partial(_showing, armature, recorded_action(armature))
    with showing():
        frames = whole_frames(armature, first, last)
    poses = yield from sample_in_parts(armature, frames, showing)
    with showing():
        return recorded(armature, frames, poses)


def recorded_poses(armature: bpy.types.Object, frames: FloatArray) -> Poses:
    """The recording's poses at frames (T,), whichever of its actions is shown."""
    with _showing(armature, recorded_action(armature)):
        return sample(armature, frames)


def write_take_in_parts(armature: bpy.types.Object, track: PoseTrack) -> Parts[bpy.types.Action]:
    """Write an adapted performance as a new action, which is assigned and knows its recording.

    Before the last part the armature is as it was.
    """
    original = recorded_action(armature)
    assert original is not None
    slot = fcurves.slot_identifier(armature)
    action = yield from write_in_parts(
        armature,
        track,
        original,
        slot,
        name=f"{original.name} adapted",
        showing=partial(_showing, armature, original),
    )
    action_settings(action).recording = original
    show(armature, action, slot)
    settings_of(armature).adapted = action
    return action


def show(armature: bpy.types.Object, action: bpy.types.Action, slot: str | None = None) -> None:
    """Lets the armature perform an action; the pose follows."""
    fcurves.assign(armature, action, slot or fcurves.slot_identifier(armature))
    scene = current_scene()
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
