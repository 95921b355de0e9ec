"""The fake user that keeps a recording's action while only its result is performed."""

from __future__ import annotations

import bpy

GUARDED = "hangtime_guarded"  # of actions that had no fake user; needs no registration


def guard(action: bpy.types.Action) -> None:
    """Have Blender keep an action in the file though nothing performs it.

    Who afterwards takes the fake user away and gives it again by hand is not told from this:
    `unguard` takes it back all the same.
    """
    if not action.use_fake_user:
        action.use_fake_user = action[GUARDED] = True


def free_copy(copy: bpy.types.Action) -> None:
    """Let a copy of an action go with the last that uses it, whatever keeps the action itself."""
    copy.use_fake_user = False
    copy.pop(GUARDED, None)


def unguard(action: bpy.types.Action) -> None:
    """Take back what `guard` changed, once nothing is made from the action; but an action that
    nothing else uses stays guarded, as Blender would drop it."""
    if action.get(GUARDED) and action.users > 1:
        action.use_fake_user = False
        del action[GUARDED]
