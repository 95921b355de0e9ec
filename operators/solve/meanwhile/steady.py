"""A scene that is read in parts as it stands, or not at all.

While the artist's recording is read nearly all events go on to Blender, edit mode's key among them.
"""

from collections.abc import Generator
from contextlib import closing, suppress
from typing import TypeVar

import bpy

from ....bridge.worker_requests import PendingRequest
from ....solver.data.faults import ArmatureGone, ChangedWhileRead
from .standing import EDITED, Kept, Standing

A = TypeVar("A")
T = TypeVar("T")


def steady(armature: bpy.types.Object, reading: Generator[A, None, T]) -> Generator[A, None, T]:
    """The same work, which reads an armature. It is free to change while a job is waited for.

    Raises as that does, and ChangedWhileRead.
    """
    kept, before = Kept.of(armature), Standing.of(armature)
    if before.edited:
        raise ChangedWhileRead(kept.name, (EDITED,))
    with closing(reading):
        while True:
            try:
                part = next(reading)
            except StopIteration as end:
                result: T = end.value
                return result
            with suppress(ArmatureGone):  # of which the work tells
                before = Standing.of(kept.found())
            yield part
            changed = () if isinstance(part, PendingRequest) else _changed(kept, before)
            if changed:
                raise ChangedWhileRead(kept.name, changed)


def _changed(kept: Kept, before: Standing) -> tuple[str, ...]:
    """In words; nothing of one that is gone, of which the work tells."""
    try:
        return before.changed(kept.found())
    except ArmatureGone:
        return ()
