"""Cooperative time slicing: long work on the scene as a generator that yields every 20 to 100 ms.

Between two slices Blender does what else it has to; each leaves the scene as the artist had it.
Whoever has no interface to keep alive completes them at once.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from time import perf_counter
from typing import TypeVar

import bpy
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ..accessors import armature_data
from .poses import Poses, sample

R = TypeVar("R", FloatArray, IntArray)
S = TypeVar("S")
T = TypeVar("T")
Incremental = Generator[float | None, None, T]
"""Long work in parts; where it knows, it yields how much is done, 0 to 1."""

SLICE_S = 0.02  # of frames; and as long as it takes to go to them and back, so that more than half
# of all time is theirs. A slice lasts 0.1 s where that takes 40 ms; where it takes longer, as among
# thousands of objects, the promise of 0.1 s is not kept: shorter slices would last nearly as long,
# and be many times as many.
FEWEST_FRAMES = 4  # a slice; each costs one frame more, to go back
MOST_GROWTH = 8.0  # from slice to slice, for what few frames took may be chance

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
    frames: R,
    look: Callable[[R], T],
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
    fewest: int = FEWEST_FRAMES,
) -> Incremental[list[T]]:
    """What `look` finds at frames (T,), or at rows of a table of them, a few a slice.

    showing: entered for each slice, such as to let an armature perform another action meanwhile.
    fewest: a slice, where each frame takes long.
    """
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
        # To go there takes as long as to go back, but is Blender's first work of the first frame.
        going = 2.0 * (ended - looked)
        of_frames = max(ended - began - going, 1e-9)
        count = max(fewest, int(count * min((SLICE_S + going) / of_frames, MOST_GROWTH)))
        yield min(at / len(frames), 1.0)
    return found


def one_by_one(things: Sequence[S], look: Callable[[S], T]) -> Incremental[list[T]]:
    """What `look`, which changes nothing, finds of each of many things, a slice's time of them at
    once."""
    found: list[T] = []
    began = perf_counter()
    for thing in things:
        found.append(look(thing))
        if perf_counter() - began > SLICE_S:
            yield len(found) / len(things)
            began = perf_counter()
    return found


def sample_incrementally(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[Poses]:
    """Sample poses, a few frames a slice. showing: as of `in_slices`."""
    world = np.empty((len(frames), 4, 4))  # which slices fill: to join them takes long
    matrices = np.empty((len(frames), len(armature_data(armature).bones), 4, 4))

    def look(rows: IntArray) -> Poses:
        seen = sample(armature, frames[rows])
        world[rows], matrices[rows] = seen.object_to_world, seen.matrices
        return seen.first

    found = yield from in_slices(np.arange(len(frames)), look, showing)
    return Poses(found[0].bones, found[0].parents, world, matrices)
