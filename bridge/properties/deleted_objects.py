"""Objects that the artist deleted, of which only what is stored here keeps Blender from freeing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..accessors import attached, snapshot
from ..app_handlers import add_handler

_Pointer = tuple[Any, str, bpy.types.Object]  # a group's, by the property's name


def leave_out_of_files(undo: ExitStack) -> None:
    """Has no file saved with such objects, until `undo` is closed. In the session they stay with
    what they made: undoing the deletion brings back both."""
    released: list[_Pointer] = []

    @persistent  # type: ignore[untyped-decorator]  # any, in the stubs
    def release(*_of_handlers: object) -> None:
        released[:] = _to_deleted()
        for group, name, _ in released:
            setattr(group, name, None)
            if name == "maker":
                group.owned = True  # results of earlier versions do not tell

    @persistent  # type: ignore[untyped-decorator]
    def restore(*_of_handlers: object) -> None:
        for group, name, thing in released:
            setattr(group, name, thing)
        released.clear()

    after = (bpy.app.handlers.save_post, bpy.app.handlers.save_post_fail)
    add_handler(undo, bpy.app.handlers.save_pre, release)
    for handlers in after:
        add_handler(undo, handlers, restore)


def _to_deleted() -> list[_Pointer]:
    """The pointers to objects that have no other user."""
    ours = [each for each in _pointers() if each[2] is not None]
    counts = Counter(thing for *_, thing in ours)
    alone = [each for each in ours if each[2].users == counts[each[2]]]
    return [each for each in alone if _is_deleted(each[2])]


def _is_deleted(thing: bpy.types.Object) -> bool:
    return thing.library is None and not thing.use_fake_user and not thing.users_collection


def _pointers() -> Iterator[_Pointer]:
    for action in bpy.data.actions:
        yield attached(action), "maker", attached(action).maker
    for scene in bpy.data.scenes:
        yield attached(scene), "armature", attached(scene).armature
    for empty in bpy.data.objects:
        if empty.type == "EMPTY" and snapshot(empty):
            yield attached(empty), "marks", attached(empty).marks
