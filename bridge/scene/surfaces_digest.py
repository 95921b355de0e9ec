"""Whether what a result was made among is what it was: surfaces, the scene's clock and lengths, and
the armature's place."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from math import isclose
from typing import Any
from zlib import crc32

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..action_slots import all_curves
from ..armature.keys_digest import keys_digest
from ..armature.poses import frames_per_second, metres_per_unit
from ..hidden_texts import entries, listed, number
from ..movable import may_move, movers
from ..properties.settings import HangtimeSettings
from .members import objects_of

_PLACED_BY = (
    *("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale"),
    *("delta_location", "delta_rotation_euler", "delta_rotation_quaternion", "delta_scale"),
)
_DIGITS = 5  # Blender units, and of factors; less is the same place
# Relative, of clocks and sizes. NTSC's rates are 1e-3 from whole ones, and are meant; clips round
# their frame time by half of that.
_SAME = 5e-4
_STILL = 1e-4  # m, and of a turn's sines; an armature that has moved by less stands where it was

OTHER_RATE = "The scene plays {:.5g} frames a second, and this was made for {:.5g}"
OTHER_SIZE = "The armature is {:.4g} times as large as this was made for, by its scale or the unit"
ELSEWHERE = "The armature, or what it hangs on, was moved among the surfaces"


@dataclass(frozen=True)
class Conditions:
    """Of what a result's physics depends on beside keys, settings and surfaces.

    rate: frames a second. metres: of a unit of the armature's own space. place: (12,) the
    armature's, lengths in m; nothing where keys, drivers, constraints or what it hangs on move it.
    """

    rate: float
    metres: float
    place: tuple[float, ...]

    @staticmethod
    def of(armature: bpy.types.Object) -> Conditions:
        """What they are now."""
        seen = Conditions.seen(armature)
        return replace(seen, place=()) if is_moved(armature) else seen

    @staticmethod
    def seen(armature: bpy.types.Object) -> Conditions:
        """What they are in the frame that is shown: the place, too, of an armature that moves."""
        scene = current_scene()
        metres = metres_per_unit(scene)
        scale = float(armature.matrix_world.median_scale)
        place = tuple((metres * _matrix(armature)).ravel().tolist())
        return Conditions(frames_per_second(scene), scale * metres, place)

    @staticmethod
    def read(text: str) -> Conditions:
        """As `as_text` wrote them."""
        return Conditions.told(json.loads(text))

    @staticmethod
    def told(content: Any) -> Conditions:
        """Of a table that holds them. Raises TypeError and LookupError where that is another."""
        found = entries(content)
        place = tuple(map(number, listed(found["place"])))
        return Conditions(number(found["rate"]), number(found["metres"]), place)

    def as_text(self) -> str:
        return json.dumps(asdict(self))

    def since(self, before: Conditions, *, among_surfaces: bool) -> str:
        """In words, what makes a result unphysical that was made in those before; "" for nothing.

        among_surfaces: whether it matters where the armature stands.
        """
        if self.replayed(before):
            return OTHER_RATE.format(self.rate, before.rate)
        if self.resized(before):
            return OTHER_SIZE.format(self.metres / before.metres)
        return ELSEWHERE if among_surfaces and self.moved(before) else ""

    def replayed(self, before: Conditions) -> bool:
        """Whether the scene plays at another rate."""
        return not isclose(self.rate, before.rate, rel_tol=_SAME)

    def resized(self, before: Conditions) -> bool:
        """Whether the armature has another size."""
        return not isclose(self.metres, before.metres, rel_tol=_SAME)

    def moved(self, before: Conditions) -> bool:
        """Whether the armature was put elsewhere, or scaled."""
        told = bool(self.place) and bool(before.place)
        return told and not np.allclose(self.place, before.place, rtol=0.0, atol=_STILL)


def _matrix(thing: bpy.types.Object) -> FloatArray:
    return np.array(thing.matrix_world, float)[:3]


def is_moved(armature: bpy.types.Object) -> bool:
    """Whether an armature's place is another at other frames, or with another take on show; which
    takes a look at each curve of each take."""
    data, parent = armature.animation_data, armature.parent
    if len(armature.constraints) or (parent is not None and may_move(parent)):
        return True
    if data is None:
        return False
    strips = [strip for track in data.nla_tracks for strip in track.strips]
    actions = [each for each in (data.action, *(s.action for s in strips)) if each is not None]
    curves = (*data.drivers, *(curve for each in actions for curve in all_curves(each)))
    return any(curve.data_path in _PLACED_BY for curve in curves)


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
    return repr((shape, [_movement(each) for each in movers(thing) if each != performer]))


def _shape(data: bpy.types.ID | None) -> int:
    if not isinstance(data, bpy.types.Mesh):
        return 0
    vertices = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", vertices)
    return crc32(vertices.tobytes())


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
