"""Cooperative time slicing: long work on the scene as a generator that yields every 20 ms.

Between two slices Blender does what else it has to; each leaves the scene as the artist had it.
Whoever has no interface to keep alive completes them at once.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, nullcontext
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
FEWEST_FRAMES = 4  # a slice; each costs one frame more, to go back


def complete(slices: Incremental[T]) -> T:
    """Run all slices at once: their result."""
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
) -> Incremental[list[T]]:
    """What `look` finds at frames (T,), a few a slice. showing: entered for each slice, such as to
    let an armature perform another action meanwhile."""
    found: list[T] = []
    at, count = 0, FEWEST_FRAMES
    while at < len(frames):
        began = perf_counter()
        with showing():
            found.append(look(frames[at : at + count]))
        at += count
        spent = perf_counter() - began
        count = max(FEWEST_FRAMES, int(count * min(SLICE_S / spent, 8.0)))
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
