"""Snapping of a dragged contact to the faces of the ground."""

from __future__ import annotations

from functools import cached_property

import bpy

from ...bridge.armature.poses import metres_per_unit
from ...bridge.properties.contact import HangtimeContact
from ...bridge.properties.settings import scene_settings, settings_of
from ...bridge.scene.ground import GroundFaces, ground_faces
from ...bridge.scene.members import Member, ground_members
from . import rays
from .drag_state import Landing


class Snapping:
    """Where a contact lands, when it begins to touch.

    The faces are read when they are first needed, for a click needs none. floor: its height, m,
    beside all of them, where it stood on one; None elsewhere.
    """

    def __init__(self, ground: tuple[Member, ...], contact: HangtimeContact, metres: float) -> None:
        self._ground, self._frame, self._metres = ground, contact.start_frame, metres
        stood = contact.on is not None
        self.floor = float(metres * contact.found_at[2]) if stood else None

    @staticmethod
    def of(
        armature: bpy.types.Object, contact: HangtimeContact, scene: bpy.types.Scene
    ) -> Snapping | None:
        """None where it is switched off, or there is no ground."""
        ground = ground_members(settings_of(armature), scene)
        if not ground or not scene_settings(scene).snap:
            return None
        return Snapping(ground, contact, metres_per_unit(scene))

    def lands(self, x: float, y: float) -> Landing | None:
        """The highest face at a place (m, world)."""
        found = self._faces.below(x / self._metres, y / self._metres)
        if found is None:
            return None
        return Landing(self._metres * found.place.z, found.object.name_full)

    def seen(self, ray: rays.Ray) -> tuple[float, float] | None:
        """x and y (Blender units, world) of the face under the mouse, if it is the first there and
        could be stood on."""
        found = self._faces.seen(ray.origin, ray.along)
        return (found.place.x, found.place.y) if found is not None else None

    @cached_property
    def _faces(self) -> GroundFaces:
        return ground_faces(self._ground, self._frame)
