"""What an armature shows, to be shown again where a result of it cannot be finished."""

from __future__ import annotations

from collections.abc import Iterator, Set
from contextlib import suppress
from dataclasses import dataclass

import bpy

from ....bridge.accessors import assigned_action, attached, current_action
from ....bridge.armature import fcurves
from ....bridge.armature.actions import evaluate
from ....bridge.armature.strips import reach_as_strip, remove_strips_but
from ....bridge.properties.settings import settings_of
from .removal import remove_result

_Muted = dict[int, bool]
"""Whether tracks and strips are muted, by their addresses, which last until data is replaced."""


@dataclass(frozen=True)
class Shown:
    """What an armature shows: an action that is assigned, in a slot, and strips, marks of those of
    its takes among them. adapted, status: its settings'."""

    armature: bpy.types.Object
    action: bpy.types.Action | None
    slot: str | None
    muted: _Muted
    marks: str
    adapted: bpy.types.Action | None
    status: str

    @staticmethod
    def by(armature: bpy.types.Object) -> Shown:
        settings, slot = settings_of(armature), fcurves.slot_identifier(armature)
        muted = {each.as_pointer(): each.mute for each in _parts(armature)}
        marks = attached(armature).take_strips
        action = assigned_action(armature)
        return Shown(armature, action, slot, muted, marks, settings.adapted, settings.status)

    def restore(self, made: Set[int]) -> None:
        """Remove the actions of these numbers as far as they are left, whoever shows them."""
        with suppress(ReferenceError):  # of what was shown something is gone, too
            self._show_again(made)
        for each in [each for each in bpy.data.actions if each.session_uid in made]:
            bpy.data.actions.remove(each)

    def _show_again(self, made: Set[int]) -> None:
        settings = settings_of(self.armature)
        result = settings.adapted
        if result == self.adapted and current_action(self.armature) is not None:
            return  # nothing else was shown yet
        if result is not None and result.session_uid in made:
            remove_result(self.armature, result)
        settings.status, settings.adapted = self.status, self.adapted
        self._put_strips_back()
        if assigned_action(self.armature) != self.action:
            fcurves.assign(self.armature, self.action, self.slot)
        reach_as_strip(self.armature)
        evaluate()

    def _put_strips_back(self) -> None:
        remove_strips_but(self.armature, self.muted.keys())
        for each in _parts(self.armature):
            each.mute = self.muted.get(each.as_pointer(), each.mute)
        attached(self.armature).take_strips = self.marks


def _parts(armature: bpy.types.Object) -> Iterator[bpy.types.NlaTrack | bpy.types.NlaStrip]:
    """An armature's tracks and their strips."""
    data = armature.animation_data
    for track in data.nla_tracks if data is not None else ():
        yield track
        yield from track.strips
