"""The open file in Blender: made for a case, and what must be the same after it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import bpy
import hangtime
import numpy as np

from ....bridge.accessors import attached, current_action, current_scene, present, source_of
from ....bridge.action_slots import all_curves
from ....bridge.files.import_clip import import_clip
from ....bridge.properties.settings import settings_of
from .case import Changed, Said

MARK = "campaign"  # custom property of the actions that must stay as they are


@cache
def enable() -> None:
    """The extension, once a process."""
    hangtime.register()


def empty_file() -> None:
    """A new file with nothing in it."""
    enable()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def recorded_file(clip: Path, first: int, last: int) -> bpy.types.Object:
    """The recording in a new file, with another action beside it; both are marked."""
    empty_file()
    armature = import_clip(clip).armature
    settings = settings_of(armature)
    settings.use_range, settings.first_frame, settings.last_frame = True, first, last
    other = bpy.data.actions.new("Another")
    other.use_fake_user = True
    for name, action in (("recording", present(current_action(armature))), ("other", other)):
        action[MARK] = name
    return armature


def marked() -> dict[str, bytes]:
    """The keys of the marked actions that are there, by their marks; what was made from them bears
    their marks too, even once they are deleted."""
    own = [a for a in bpy.data.actions if a.get(MARK) and not _made(a)]
    return {str(a[MARK]): _keys(a) for a in own}


def _made(action: bpy.types.Action) -> bool:
    """Whether it is a result, or a recording with frames put in."""
    kept: Any = attached(action)
    return bool(kept.own_key) or kept.unfilled is not None or source_of(action) is not None


def _keys(action: bpy.types.Action) -> bytes:
    """Every key's place, curve by curve."""
    rows = []
    for curve in all_curves(action):
        places = np.empty(2 * len(curve.keyframe_points))
        curve.keyframe_points.foreach_get("co", places)
        rows.append(places.tobytes())
    return b"".join(sorted(rows))


def must_be_same(before: dict[str, bytes], after: dict[str, bytes]) -> None:
    """Raises Changed where a marked action that is still there has other keys."""
    for name, keys in after.items():
        if name in before and keys != before[name]:
            raise Changed(f"the {name} has other keys")


@dataclass(frozen=True)
class View:
    """What an operator that fails must leave alone."""

    blocks: frozenset[str]
    selected: frozenset[str]
    active: str | None
    mode: str
    frame: float

    @staticmethod
    def now() -> View:
        layer = present(bpy.context.view_layer)
        layer.update()  # else it may still list what has just been removed
        kinds = (bpy.data.objects, bpy.data.actions, bpy.data.meshes, bpy.data.armatures)
        return View(
            frozenset(f"{type(block).__name__} {block.name}" for kind in kinds for block in kind),
            frozenset(o.name for o in layer.objects if o.select_get()),
            layer.objects.active.name if layer.objects.active is not None else None,
            bpy.context.mode,
            current_scene().frame_current_final,
        )


@contextmanager
def refusals() -> Iterator[None]:
    """Context of operators: raises Said for a refusal in words, after which all must be as it was.

    A traceback, which Blender reports as an error too, goes on as what it is.
    """
    before = View.now()
    try:
        yield
    except RuntimeError as error:
        told = str(error)
        if "Traceback" in told:
            raise
        after = View.now()
        if after != before:
            raise Changed(f"{told}\nbefore: {before}\nafter: {after}") from error
        raise Said(told) from error
