"""Recorded and adapted actions: lookup, reading and writing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from functools import partial

import bpy

from ...solver.arrays import FloatArray
from ...solver.data.recording import Recording
from ..accessors import (
    assigned_action,
    current_action,
    current_scene,
    mapped_strip,
    played_source,
    root_of,
)
from ..properties.settings import settings_of
from ..unkeyed import PutBack, note_unkeyed
from . import fcurves
from .incremental import Incremental, complete
from .played import adopt_strip, playing_strip
from .poses import Poses, sample
from .read import record_incrementally, whole_frames
from .strips import reach_as_strip, show_strip, strips_of, without_strips


def recorded_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """Recorded action: the armature's own, or the one that this was adapted from.

    A result counts as the recording where the artist starts from it, and in another shot.
    """
    action = current_action(armature)
    if action is None or action == settings_of(armature).source:
        return action
    return played_source(armature, action)


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
    frames = recorded_frames(armature, first, last, beyond)
    assert armature is not None
    return (yield from record_incrementally(armature, frames, showing_recorded(armature)))


def recorded_frames(
    armature: bpy.types.Object | None,
    first: float | None,
    last: float | None,
    beyond: float = 0.0,
) -> FloatArray:
    """Whole frames of the recording (T,), whichever of its actions is shown. Arguments and faults
    are those of `whole_frames`."""
    if armature is None or current_action(armature) is None:
        return whole_frames(armature, first, last)  # raises why
    with showing_recorded(armature)():
        return whole_frames(armature, first, last, beyond)


def showing_recorded(armature: bpy.types.Object) -> Callable[[], AbstractContextManager[None]]:
    """Contexts in which the armature performs the recording, whichever action is shown."""
    return slices_showing(armature, recorded_action(armature))


def recorded_poses(armature: bpy.types.Object, frames: FloatArray) -> Poses:
    """The recording's poses at frames (T,), whichever of its actions is shown."""
    with showing_recorded(armature)():
        return sample(armature, frames)


def show(
    armature: bpy.types.Object, action: bpy.types.Action | None, slot: str | None = None
) -> None:
    """Let the armature perform an action, in its strip where it has one, Hangtime's or the
    artist's; the pose follows."""
    slot, shown = slot or fcurves.slot_identifier(armature), current_action(armature)
    if action is not None and shown is not None:
        _note_again(armature, action, shown)
    if action is not None and strips_of(armature, action):
        if shown is not None:
            adopt_strip(armature, shown)
        fcurves.assign(armature, None)
        show_strip(armature, action)
    elif action == assigned_action(armature) or action != shown:
        fcurves.assign(armature, action, slot)
    reach_as_strip(armature)
    evaluate()


def evaluate() -> None:
    """Have the pose follow what is shown now."""
    scene = current_scene()
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)


def note_take(armature: bpy.types.Object, result: bpy.types.Action, take: bpy.types.Action) -> None:
    """Keep with a result, before it is ever performed, what its recording leaves alone."""
    with showing_action(armature, take):
        note_unkeyed(armature, result, take, root_of(take))


def _note_again(
    armature: bpy.types.Object, result: bpy.types.Action, shown: bpy.types.Action
) -> None:
    """Keep that with a result that is to be shown, too: the artist may have set it anew since."""
    recording = root_of(result)
    if result not in (shown, recording) and recording == root_of(shown) and result.library is None:
        note_unkeyed(armature, result, shown, recording)


def slices_showing(
    armature: bpy.types.Object, action: bpy.types.Action | None
) -> Callable[[], AbstractContextManager[None]]:
    """Contexts as of `showing_action`, for the slices of one reading."""
    return partial(showing_action, armature, action, PutBack())


@contextmanager
def showing_action(
    armature: bpy.types.Object, action: bpy.types.Action | None, put_back: PutBack | None = None
) -> Iterator[None]:
    """Context in which the armature performs `action`, where a strip plays it elsewhere than at its
    own frames in that strip; afterwards what it performed before. put_back: knows what that has
    keys for, from other such contexts."""
    assigned = assigned_action(armature)
    if action == assigned and assigned is not None:
        yield
        return
    slot = fcurves.slot_identifier(armature)
    strip = mapped_strip(armature, action) if action is not None else None
    if strip is not None:
        with playing_strip(armature, strip, put_back):
            yield
        evaluate()
        return
    put_back = put_back or PutBack()
    with without_strips(armature, put_back):
        fcurves.assign(armature, action, slot, put_back)
        try:
            yield
        finally:
            fcurves.assign(armature, assigned, slot, put_back)
    evaluate()
