"""Recorded and adapted actions: lookup, reading and writing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack, Recording
from ..accessors import current_action, current_scene
from ..properties.settings import action_settings, settings_of
from . import fcurves
from .incremental import Incremental, complete, sample_incrementally
from .poses import Poses, sample
from .read import recording_of, whole_frames
from .write import write_incrementally


def recorded_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """Recorded action: the armature's own, or the one that this was adapted from."""
    action = current_action(armature)
    if action is None:
        return None
    return action_settings(action).recording or action


def read_recorded(
    armature: bpy.types.Object | None,
    first: float | None,
    last: float | None,
    beyond: float = 0.0,
) -> Recording:
    """Read the recording, whichever of its actions is shown. Arguments and faults are those of
    `read_recording`."""
    return complete(read_recorded_incrementally(armature, first, last, beyond))


def read_recorded_incrementally(
    armature: bpy.types.Object | None,
    first: float | None,
    last: float | None,
    beyond: float = 0.0,
) -> Incremental[Recording]:
    """Read the recording, a few frames a slice."""
    if armature is None or current_action(armature) is None:
        whole_frames(armature, first, last)
    assert armature is not None
    showing = showing_recorded(armature)
    with showing():
        frames = whole_frames(armature, first, last, beyond)
    poses = yield from sample_incrementally(armature, frames, showing)
    with showing():
        return recording_of(armature, frames, poses)


def showing_recorded(armature: bpy.types.Object) -> Callable[[], AbstractContextManager[None]]:
    """Contexts in which the armature performs the recording, whichever action is shown."""
    return partial(_showing, armature, recorded_action(armature))


def recorded_poses(armature: bpy.types.Object, frames: FloatArray) -> Poses:
    """The recording's poses at frames (T,), whichever of its actions is shown."""
    with showing_recorded(armature)():
        return sample(armature, frames)


def write_adapted_incrementally(
    armature: bpy.types.Object, track: PoseTrack
) -> Incremental[bpy.types.Action]:
    """Write an adapted performance as a new action, which is assigned and knows its recording.

    Before the last slice the armature is as it was.
    """
    original = recorded_action(armature)
    assert original is not None
    slot = fcurves.slot_identifier(armature)
    action = yield from write_incrementally(
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


def show(
    armature: bpy.types.Object, action: bpy.types.Action | None, slot: str | None = None
) -> None:
    """Let the armature perform an action; the pose follows."""
    fcurves.assign(armature, action, slot or fcurves.slot_identifier(armature))
    scene = current_scene()
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


@contextmanager
def _showing(armature: bpy.types.Object, action: bpy.types.Action | None) -> Iterator[None]:
    """Context in which the armature performs `action`; afterwards what it performed before."""
    before, slot = current_action(armature), fcurves.slot_identifier(armature)
    if action == before:
        yield
        return
    fcurves.assign(armature, action, slot)
    try:
        yield
    finally:
        show(armature, before, slot)
