"""The objects that the rows of surfaces name, one by one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ...solver.data.faults import ObjectGone
from ...solver.data.scene import SceneRole
from ..movable import bending_armature
from ..properties.settings import HangtimeSettings
from ..properties.surface import SOLID_TYPES, HangtimeSurface
from ..rows.choices import SurfaceRole


@dataclass(frozen=True)
class Member:
    """A solid object, by the row that names it first. clearance: Blender units, of a hurdle.
    bent_by: another armature than the performer's, whose bones an obstacle is made of."""

    object: bpy.types.Object
    role: SceneRole
    clearance: float | None = None
    bent_by: bpy.types.Object | None = None

    @property
    def name(self) -> str:
        """The object's; with its file's where it is linked, so that no two are called the same."""
        return str(self.object.name_full)


def members(settings: HangtimeSettings, scene: bpy.types.Scene) -> tuple[Member, ...]:
    """What the rows that are used name, each object once.

    Raises ObjectGone for a row whose object or collection is not in the scene any more.
    """
    for row in settings.surfaces:
        if row.used and is_gone(row, scene):
            raise ObjectGone(row.called)
    return present_members(settings, scene)


def present_members(settings: HangtimeSettings, scene: bpy.types.Scene) -> tuple[Member, ...]:
    """The same without rows whose object is gone; the first row that names an object counts."""
    found: dict[str, Member] = {}
    for row in settings.surfaces:
        if row.used and not is_gone(row, scene):
            for each in objects_of(row):
                found.setdefault(each.name_full, _member(each, row))
    return tuple(found.values())


def _member(thing: bpy.types.Object, row: HangtimeSurface) -> Member:
    role, bent_by = SurfaceRole[row.role], bending_armature(thing)
    if role is SurfaceRole.CLEAR:
        return Member(thing, role.solid, row.clearance)
    bends = role.solid is SceneRole.OBSTACLE and bent_by != row.id_data
    return Member(thing, role.solid, bent_by=bent_by if bends else None)


def ground_members(settings: HangtimeSettings, scene: bpy.types.Scene) -> tuple[Member, ...]:
    """The ground that counts and is there."""
    found = present_members(settings, scene)
    return tuple(member for member in found if member.role is SceneRole.GROUND)


def is_gone(row: HangtimeSurface, scene: bpy.types.Scene) -> bool:
    """Whether what a row names was deleted, from the scene at least; such data lives on."""
    if row.object is not None:
        return scene not in tuple(row.object.users_scene)
    collections = (scene.collection, *scene.collection.children_recursive)
    return row.collection not in collections


def objects_of(
    row: HangtimeSurface, performer: bpy.types.Object | None = None
) -> Iterator[bpy.types.Object]:
    """Objects that a row names; of a collection those with faces, without the performer's own.

    performer: None for who has the row.
    """
    if row.object is not None:
        yield row.object
    elif row.collection is not None:
        for each in row.collection.all_objects:
            if each.type in SOLID_TYPES and not _hangs_on(each, performer or row.id_data):
                yield each


def _hangs_on(thing: bpy.types.Object, armature: bpy.types.ID | None) -> bool:
    """Whether an object is the armature's child, or deformed by it."""
    above: bpy.types.Object | None = thing
    while above is not None:
        if above == armature:
            return True
        above = above.parent
    return any(getattr(modifier, "object", None) == armature for modifier in thing.modifiers)
