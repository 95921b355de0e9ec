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
from ..armature.channels import proper
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.pose_basis import carrier_of
from ..armature.poses import Poses, metres_per_unit
from ..controls.driven import constrained
from .moves import is_hidden

_LOOKS = 150  # frames at most at which a take is looked at, spread evenly
_KEYED = 0.001  # m, by which keys of a bone move it at least
_TRAVELS = 0.02  # m, by which a root bone that travels is off its mean place
_BESIDE = 0.5  # of that, by which the hips may be off their mean place over it
_FOLLOWS = 0.005  # m, by which what follows a bone may move in its axes: exporters round
_LEVER = 0.1  # m, by which turns count as places
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
    followers = [
        (name, body)
        for name in names
        if name not in over_any and _extent(places[name]) > _MOVES
        for body in _followed(armature, poses, name, bodies)
    ]
    return Companions(root, tuple(followers))


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
    unit = metres_per_unit(current_scene()) * _size(np.array(armature.matrix_world))
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
    ends = [fcurves.keys(c)[[0, -1], 0] for c in curves.fcurves if len(c.keyframe_points)]
    first, last = np.floor(np.min(ends)), np.ceil(np.max(ends))
    count = min(int(last - first) + 1, _LOOKS)
    return np.asarray(np.linspace(first, last, count).round())


def travels(root: FloatArray, pelvis: FloatArray) -> bool:
    """Whether a root travels over the floor, and the pelvis with it; places (T, 3), m."""
    way = _extent(root[:, :2])
    return way > _TRAVELS and _extent((pelvis - root)[:, :2]) < _BESIDE * way


def _extent(places: FloatArray) -> float:
    """How far places (T, n) are off their mean at most."""
    return float(np.linalg.norm(places - places.mean(axis=0), axis=1).max())


def _followed(
    armature: bpy.types.Object, poses: Poses, name: str, bodies: tuple[str, ...]
) -> list[str]:
    """The bone of the body in whose axes a bone keeps its place, and turn, best, the nearest of
    equal ones; none where it keeps no place. What hangs on a bone follows it anyway."""
    hangs_on = _above(armature, (name,))
    own = poses.matrices[:, poses.bones.index(name)]
    found = []
    for body in (each for each in bodies if each not in hangs_on):
        matrices = poses.matrices[:, poses.bones.index(body)]
        if is_hidden(own, matrices):
            continue
        unit = metres_per_unit(current_scene()) * _size(poses.object_to_world[0] @ matrices[0])
        beside = np.linalg.solve(matrices, own)
        places, turns = unit * beside[:, :3, 3], proper(beside[:, :3, :3]).reshape(-1, 9)
        if _extent(places) < _FOLLOWS:
            apart = _extent(places) + _LEVER * _extent(turns)
            found.append((apart + _FOLLOWS * float(np.linalg.norm(places[0])), body))
    return [min(found)[1]] if found else []


def _size(matrix: FloatArray) -> float:
    """Scale of a transformation (4, 4)."""
    return float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
