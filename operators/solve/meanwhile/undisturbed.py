"""A result that is written in parts, or not at all.

The window in which the work began lets no event through meanwhile (`Solving.passes`); but a second
window, or another extension's timer, may rename, delete and edit between two parts.
"""

from __future__ import annotations

from collections.abc import Set
from contextlib import suppress
from typing import TypeVar

import bpy

from ....bridge.armature.actions import recorded_action
from ....bridge.armature.incremental import Incremental, noting_made
from ....solver.data.faults import (
    ActionGone,
    ChangedMeanwhile,
    EditedMeanwhile,
    Fault,
)
from .replaced import end_with
from .shown import Shown
from .standing import EDITED, Kept, Standing

T = TypeVar("T")


def undisturbed(armature: bpy.types.Object, writing: Incremental[T]) -> Incremental[T]:
    """The same work, which makes a result of an armature; where it ends with a fault, the armature
    shows what it showed, and what was made is gone.

    Raises as that does, and, where something came in between, ArmatureGone, EditedMeanwhile,
    ChangedMeanwhile, ActionGone.
    """
    shown, needed, made = Shown.by(armature), _Needed(armature), set[int]()
    try:
        while True:
            try:
                with noting_made(made):
                    part = next(writing)
            except StopIteration as end:
                result: T = end.value
                return result
            needed.note(made)
            yield part
            needed.require()
    except (Fault, ReferenceError) as why:
        end_with(writing, why)
        shown.restore(made)
        raise
    finally:
        with suppress(ReferenceError):
            writing.close()


class _Needed:
    """What each part takes for granted of what the one before left: the armature as it stood, the
    recording's action, and those that were made."""

    def __init__(self, armature: bpy.types.Object) -> None:
        self._kept, self._standing = Kept.of(armature), Standing.of(armature)
        source = recorded_action(armature)
        self._source = {} if source is None else {source.session_uid: source.name}
        self._made: dict[int, str] = {}

    def note(self, made: Set[int]) -> None:
        """A part has ended. made: numbers of the actions that were made so far, of which some may
        have served."""
        self._standing = Standing.of(self._kept.found())
        self._made = {uid: name for uid, name in _actions().items() if uid in made}

    def require(self) -> None:
        """Raises ArmatureGone, EditedMeanwhile, ChangedMeanwhile, ActionGone."""
        armature, actions = self._kept.found(), _actions()
        for uid, name in (self._source | self._made).items():
            if uid not in actions:
                raise ActionGone(name)
        changed = self._standing.changed(armature)
        if EDITED in changed:
            raise EditedMeanwhile(armature.name)
        if changed:
            raise ChangedMeanwhile(armature.name, while_solving=True, changed=changed)


def _actions() -> dict[int, str]:
    """Names of all actions by their numbers in this session."""
    return {each.session_uid: each.name for each in bpy.data.actions}
