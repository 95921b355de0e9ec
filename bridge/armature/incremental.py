"""Long work on the artist's scene in parts, between which Blender does what else it has to.

A part leaves the scene as the artist had it. Whoever has no interface to keep alive completes them.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, nullcontext
from time import perf_counter
from typing import TypeVar

import bpy
import numpy as np

from .poses import FloatArray, Poses, sample

T = TypeVar("T")
Parts = Generator[None, None, T]

PART_S = 0.02
FEWEST = 4  # frames a part; each part costs one frame more, to go back


def complete(parts: Parts[T]) -> T:
    """All parts at once: what they return."""
    while True:
        try:
            next(parts)
        except StopIteration as end:
            result: T = end.value
            return result


def sample_in_parts(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Parts[Poses]:
    """`poses.sample`, a few frames a part. showing: entered for each part, such as to let the
    armature perform another action meanwhile."""
    found: list[Poses] = []
    at, count = 0, FEWEST
    while at < len(frames):
        began = perf_counter()
        with showing():
            found.append(sample(armature, frames[at : at + count]))
        at += count
        spent = perf_counter() - began
        count = max(FEWEST, int(count * min(PART_S / spent, 8.0)))
        yield
    return Poses(
        found[0].bones,
        found[0].parents,
        np.concatenate([part.object_to_world for part in found]),
        np.concatenate([part.matrices for part in found]),
    )
