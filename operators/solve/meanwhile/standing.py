"""How an armature stands, to tell between two parts whether others have changed it."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ....bridge.accessors import armature_data
from ....bridge.repairs.analysed_state import BONES, PLACE
from ....bridge.scene.surfaces_digest import Conditions, is_moved
from ....solver.arrays import FloatArray
from ....solver.data.faults import ArmatureGone

EDITED = "edit mode"
RATE = "the scene's frame rate"

_SAME = 1e-3  # Blender units, and of axes, which going in and out of edit mode turns by 1e-6


@dataclass(frozen=True)
class Kept:
    """An armature that is to be found again, for an undo puts another in its place: its number in
    this session, and its name then."""

    uid: int
    name: str

    @staticmethod
    def of(armature: bpy.types.Object) -> Kept:
        return Kept(armature.session_uid, armature.name)

    def found(self) -> bpy.types.Object:
        """Raises ArmatureGone."""
        numbered = (each for each in bpy.data.objects if each.session_uid == self.uid)
        armature = next(numbered, None)
        # What was deleted is in the file until that is saved, but in no scene; which Blender looks
        # for among all objects of all scenes, so that it is asked of this one alone.
        if armature is None or not armature.users_scene:
            raise ArmatureGone(self.name)
        return armature


@dataclass(frozen=True)
class Standing:
    """What poses are read by: whether an armature is edited, its bones' names and where they are at
    rest, (16 n,), and its place in the frame that is shown."""

    edited: bool
    bones: tuple[str, ...]
    rest: FloatArray
    conditions: Conditions

    @staticmethod
    def of(armature: bpy.types.Object) -> Standing:
        bones = armature_data(armature).bones
        rest = np.empty(16 * len(bones), np.float32)
        bones.foreach_get("matrix_local", rest)
        names = tuple(each.name for each in bones)
        edited = armature.mode == "EDIT"
        return Standing(edited, names, rest.astype(float), Conditions.seen(armature))

    def changed(self, armature: bpy.types.Object) -> tuple[str, ...]:
        """In words, what of the armature is another now; of edit mode only that it was entered."""
        standing = Standing.of(armature)
        if standing.edited and not self.edited:
            return (EDITED,)
        now, then = standing.conditions, self.conditions
        # What moves it is asked last, for that is asked of all curves of all strips.
        placed = now.resized(then) or (now.moved(then) and not is_moved(armature))
        found = {BONES: not self._has_bones_of(standing), PLACE: placed, RATE: now.replayed(then)}
        return tuple(part for part, changed in found.items() if changed)

    def _has_bones_of(self, other: Standing) -> bool:
        named = self.bones == other.bones
        return named and np.allclose(self.rest, other.rest, rtol=0.0, atol=_SAME)
