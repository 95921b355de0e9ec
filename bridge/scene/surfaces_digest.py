"""Whether surfaces are what they were when a result was made among them."""

from __future__ import annotations

from collections.abc import Iterator
from zlib import crc32

import bpy
import numpy as np

from ..action_slots import all_curves
from ..armature.keys_digest import keys_digest
from ..properties.settings import HangtimeSettings
from .bone_parts import bending_armature
from .members import objects_of

_PLACED_BY = (
    *("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale"),
    *("delta_location", "delta_rotation_euler", "delta_rotation_quaternion", "delta_scale"),
)
_DIGITS = 5  # Blender units, and of factors; less is the same place


def surfaces_digest(
    settings: HangtimeSettings, performer: bpy.types.Object, known: dict[bpy.types.Object, str]
) -> str:
    """A number for vertices, places and movements of the surfaces that count; another where one of
    these differs. What modifiers, shape keys, constraints and physics make of it is left out, as
    finding that takes a look at every frame. Empty where there are none.

    performer: whose surfaces they are. known: numbers of objects, to which new ones are added.
    """
    things = {each for row in settings.surfaces if row.used for each in objects_of(row, performer)}
    shapes: dict[bpy.types.ID | None, int] = {}
    for each in things - set(known):
        known[each] = _digest(each, performer, shapes)
    return str(crc32(repr(sorted(known[each] for each in things)).encode())) if things else ""


def _digest(
    thing: bpy.types.Object, performer: bpy.types.Object, shapes: dict[bpy.types.ID | None, int]
) -> str:
    """Of an object's shape, and of all that moves it but the performer, who shows now one take and
    now another. shapes: numbers of meshes, which many objects may share; new ones are added."""
    shape = shapes.get(thing.data)
    if shape is None:
        shape = shapes[thing.data] = _shape(thing.data)
    return repr((shape, [_movement(each) for each in _movers(thing) if each != performer]))


def _shape(data: bpy.types.ID | None) -> int:
    if not isinstance(data, bpy.types.Mesh):
        return 0
    vertices = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", vertices)
    return crc32(vertices.tobytes())


def _movers(thing: bpy.types.Object) -> list[bpy.types.Object]:
    """An object, and what it hangs on or follows."""
    found = [thing]
    for each in found:  # which grows
        targets = (getattr(constraint, "target", None) for constraint in each.constraints)
        more = dict.fromkeys((each.parent, bending_armature(each), *targets))
        found += [other for other in more if other is not None and other not in found]
    return found


def _movement(thing: bpy.types.Object) -> tuple[object, ...]:
    """An object's keys, when strips play them, and the rest of its place."""
    data, actions, times = thing.animation_data, [], []
    driven = set[str]()
    if data is not None:
        strips = [s for track in data.nla_tracks if not track.mute for s in track.strips]
        actions = [each for each in (data.action, *(s.action for s in strips)) if each is not None]
        times = [(s.frame_start, s.frame_end, s.action_frame_start, s.scale) for s in strips]
        curves = (*data.drivers, *(curve for each in actions for curve in all_curves(each)))
        driven = {curve.data_path for curve in curves}
    place = [(name, *_rounded(thing, name)) for name in _PLACED_BY if name not in driven]
    hangs: list[object] = []
    if thing.parent is not None:
        inverse = np.round(np.array(thing.matrix_parent_inverse), _DIGITS) + 0.0  # no -0.0
        hangs = [*inverse.tolist(), thing.parent_bone]
    return [keys_digest(each) for each in actions], times, place, hangs


def _rounded(thing: bpy.types.Object, name: str) -> Iterator[float]:
    return (round(float(value), _DIGITS) + 0.0 for value in getattr(thing, name))
