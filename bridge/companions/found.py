"""Which bones outside of a body go along with it in a take.

A root bone above the pelvis may travel over the floor with it, and bones such as Unreal's
`ik_foot_l` may keep their places on bones of the body, both by keys of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from contextlib import AbstractContextManager
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import armature_data, current_scene
from ..armature import fcurves
from ..armature.incremental import Incremental, one_by_one, sample_incrementally
from ..armature.pose_basis import carrier_of
from ..armature.poses import metres_per_unit
from ..controls.driven import constrained
from .followed import BodyAxes, extent, size_of

_LOOKS = 150  # frames at most at which a take is looked at, spread evenly
_KEYED = 0.001  # m, by which keys of a bone move it at least
_TRAVELS = 0.02  # m, by which a root bone that travels is off its mean place
_BESIDE = 0.5  # of that, by which the hips may be off their mean place over it
_MOVES = 0.05  # m, by which it moves at least: what both rest says nothing


@dataclass(frozen=True)
class Companions:
    """Bones that go along with a body. root: above the pelvis, over the floor; None without one.

    followers: each with the bone of the body on which it keeps its place, parents first.
    """

    root: str | None = None
    followers: tuple[tuple[str, str], ...] = ()

    @property
    def bones(self) -> tuple[str, ...]:
        """All of them."""
        followers = tuple(bone for bone, _ in self.followers)
        return followers if self.root is None else (self.root, *followers)


def found_companions(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    bodies: tuple[str, ...],
    apart: Collection[str],
    showing: Callable[[], AbstractContextManager[object]],
) -> Incremental[Companions]:
    """The companions of bodies, the pelvis first, in a take that these curves animate.

    apart: bones that are posed otherwise. showing: lets the armature perform the take.
    """
    names = [name for name in placed_by_keys(armature, curves, bodies) if name not in apart]
    if not names:
        return Companions()
    poses = yield from sample_incrementally(armature, _frames(curves), showing)
    world = poses.object_to_world[:, None] @ poses.matrices
    world[..., :3, 3] *= metres_per_unit(current_scene())
    places = {name: world[:, poses.bones.index(name), :3, 3] for name in (*names, bodies[0])}
    over_pelvis, over_any = _above(armature, bodies[:1]), _above(armature, bodies)
    roots = [name for name in names if name in over_pelvis]
    root = next((name for name in roots if travels(places[name], places[bodies[0]])), None)
    axes = BodyAxes.of(poses, bodies)

    def followed(name: str) -> str | None:
        return axes.followed(poses.matrices[:, poses.bones.index(name)], _above(armature, (name,)))

    move = [name for name in names if name not in over_any and extent(places[name]) > _MOVES]
    found = yield from one_by_one(move, followed)
    followers = zip(move, found, strict=True)
    return Companions(root, tuple((name, body) for name, body in followers if body is not None))


def holders_of(
    armature: bpy.types.Object, companions: Companions, bodies: tuple[str, ...]
) -> set[str]:
    """Bones on which followers hang, the body and what that hangs on apart."""
    followers = [bone for bone, _ in companions.followers]
    return _above(armature, followers) - _above(armature, bodies) - set(bodies)


def placed_by_keys(
    armature: bpy.types.Object, curves: fcurves.CurveHolder, bodies: tuple[str, ...]
) -> list[str]:
    """Bones, parents first, that keys of their location alone move, and that are neither bodies nor
    what carries the pelvis."""
    rest = armature_data(armature).bones
    unit = metres_per_unit(current_scene()) * size_of(np.array(armature.matrix_world))
    places = [c for c in curves.fcurves if c.data_path.endswith(".location") and not c.mute]
    keyed = {fcurves.bone_of(c.data_path) for c in places if _range(c) * unit > _KEYED}
    carrier = carrier_of(rest[bodies[0]]).name
    keyed -= {*bodies, carrier, *constrained(armature), *_driven(armature)}
    found = [bone for bone in rest if bone.name in keyed and not bone.use_connect]
    return [bone.name for bone in sorted(found, key=lambda bone: len(bone.parent_recursive))]


def _range(curve: bpy.types.FCurve) -> float:
    return float(np.ptp(fcurves.keys(curve)[:, 1])) if len(curve.keyframe_points) else 0.0


def _driven(armature: bpy.types.Object) -> set[str | None]:
    """Bones of which drivers set any channel."""
    data = armature.animation_data
    return set() if data is None else {fcurves.bone_of(each.data_path) for each in data.drivers}


def _above(armature: bpy.types.Object, bones: Iterable[str]) -> set[str]:
    """All ancestors of bones."""
    rest = armature_data(armature).bones
    return {above.name for bone in bones for above in rest[bone].parent_recursive}


def _frames(curves: fcurves.CurveHolder) -> FloatArray:
    """Whole frames from the first key to the last, of which some where there are many."""
    ends = np.array([curve.range() for curve in curves.fcurves if len(curve.keyframe_points)])
    first, last = np.floor(ends.min()), np.ceil(ends.max())
    count = min(int(last - first) + 1, _LOOKS)
    return np.asarray(np.linspace(first, last, count).round())


def travels(root: FloatArray, pelvis: FloatArray) -> bool:
    """Whether a root travels over the floor, and the pelvis with it; places (T, 3), m."""
    way = extent(root[:, :2])
    return bool(way > _TRAVELS and extent((pelvis - root)[:, :2]) < _BESIDE * way)
