"""Cooperative time slicing: long work on the scene as a generator that yields every 20 to 60 ms.

Between two slices Blender does what else it has to; each leaves the scene as the artist had it.
Whoever has no interface to keep alive completes them at once.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from functools import partial
from time import perf_counter
from typing import TypeVar

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from .poses import Poses, sample

T = TypeVar("T")
Incremental = Generator[float | None, None, T]
"""Long work in parts; where it knows, it yields how much is done, 0 to 1."""

SLICE_S = 0.02
LONGEST_SLICE_S = 0.06  # where it costs as much to go back as the frames do
GOING_BACK = 4.0  # times what that costs is added: entering costs as much, frames twice that
FEWEST_FRAMES = 4  # a slice; each costs one frame more, to go back

_nobody_waits = ContextVar("_nobody_waits", default=False)
_made: ContextVar[set[int] | None] = ContextVar("_made", default=None)


@contextmanager
def at_once() -> Iterator[None]:
    """Context in which one slice has all frames, for each slice that lets an armature perform
    another action has Blender copy all keys of both, which takes as long as 40 frames."""
    token = _nobody_waits.set(True)
    try:
        yield
    finally:
        _nobody_waits.reset(token)


@contextmanager
def noting_made(made: set[int]) -> Iterator[None]:
    """Context in which the actions that a slice makes are noted, by their numbers in this session:
    what else appears meanwhile is others', such as handlers of other extensions."""
    token = _made.set(made)
    try:
        yield
    finally:
        _made.reset(token)


def note_made_action(action: bpy.types.Action) -> None:
    """An action was made by what runs now."""
    made = _made.get()
    if made is not None:
        made.add(action.session_uid)


def complete(slices: Incremental[T]) -> T:
    """Run all slices at once: their result."""
    with at_once():
        while True:
            try:
                next(slices)
            except StopIteration as end:
                result: T = end.value
                return result


def in_slices(
    frames: FloatArray,
    look: Callable[[FloatArray], T],
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
    fewest: int = FEWEST_FRAMES,
) -> Incremental[list[T]]:
    """What `look` finds at frames (T,), a few a slice. showing: entered for each slice, such as to
    let an armature perform another action meanwhile. fewest: a slice, where each frame takes long
    and it takes no longer to go back."""
    found: list[T] = []
    at, count = 0, fewest
    while at < len(frames):
        count = len(frames) if _nobody_waits.get() else count
        began = perf_counter()
        with showing():
            found.append(look(frames[at : at + count]))
            looked = perf_counter()
        at += count
        ended = perf_counter()
        wanted = min(SLICE_S + GOING_BACK * (ended - looked), LONGEST_SLICE_S)
        in_time = int(count * min(wanted / max(ended - began, 1e-9), 8.0))
        to_go_back = round(count * (ended - looked) / max(looked - began, 1e-9))
        count = max(fewest, in_time, min(to_go_back, FEWEST_FRAMES))
        yield min(at / len(frames), 1.0)
    return found


def sample_incrementally(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[Poses]:
    """Sample poses, a few frames a slice. showing: as of `in_slices`."""
    found = yield from in_slices(frames, partial(sample, armature), showing)
    return Poses(
        found[0].bones,
        found[0].parents,
        np.concatenate([part.object_to_world for part in found]),
        np.concatenate([part.matrices for part in found]),
    )
