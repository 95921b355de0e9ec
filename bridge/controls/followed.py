"""What acts in a rig at a frame: switches between kinds of controls may be thrown on the way; and
whether the rig is made as it was."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from zlib import crc32

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray
from ..accessors import armature_data, current_action, current_scene, pose_of, present
from ..armature import fcurves
from ..armature.incremental import Incremental, in_slices
from ..armature.keys_digest import curve_digest, keys_digest, stored
from ..armature.poses import evaluated, metres_per_unit
from .driven import constraints_of

LOOKS = 3  # frames at which a rig is looked at, beside one for each state of its switches
FAINT = 1e-3  # influence, below which a switch is off
# How much a constraint acts, and misses, goes with the frame that is shown.
_OF_FRAME = frozenset({"influence", "error_location", "error_rotation"})
_RESTS = (
    *("matrix_local", "use_connect", "use_local_location", "use_inherit_rotation"),
    "inherit_scale",
)
_POSES = ("custom_shape", "lock_", "ik_", "use_ik_")  # what their names begin with


def telling_frames(states: BoolArray) -> IntArray:
    """Indices (L,) of the frames that show all that acts in a rig at any: some that are spread
    evenly, and the middle one of each state of its switches. states: (T, N), as of `acting`."""
    at = np.linspace(0, len(states) - 1, LOOKS).round().astype(int).tolist()
    for state in np.unique(states, axis=0):
        rows = np.flatnonzero((states == state).all(axis=1))
        at.append(int(rows[len(rows) // 2]))
    return np.asarray(np.unique(at))


def acting(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[BoolArray]:
    """(T, N) which constraints of an armature act at frames (T,)."""
    return (yield from influences_over(armature, frames, showing)) > FAINT


def influences_over(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[FloatArray]:
    """(T, N) how much each constraint of an armature acts at frames (T,)."""
    influences = Influences(armature)

    def look(part: FloatArray) -> FloatArray:
        return np.stack([influences.at(float(frame)) for frame in part])

    parts = yield from in_slices(frames, look, showing)
    return np.concatenate(parts)


class Influences:
    """How much each constraint of an armature acts."""

    def __init__(self, armature: bpy.types.Object) -> None:
        self._armature = armature
        self._indices = [
            (bone.name, list(bone.constraints).index(each))
            for bone, each in constraints_of(armature)
        ]

    def at(self, frame: float) -> FloatArray:
        """(N,) as drivers and keys have it at a frame; the scene's is what it was."""
        with evaluated([self._armature]):
            whole = int(np.floor(frame))
            current_scene().frame_set(whole, subframe=frame - whole)
            return self.now()

    def now(self) -> FloatArray:
        """(N,) at the scene's frame."""
        posed = self._armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        bones = pose_of(posed).bones
        return np.array([bones[name].constraints[index].influence for name, index in self._indices])


def rig_digest(armature: bpy.types.Object) -> str:
    """A number for how a rig's bones, constraints and drivers are made, its take is keyed and what
    has no keys is posed; another where something differs that tells which bones move which. How
    much each constraint acts is not in it."""
    action, found = current_action(armature), 0
    for part in _parts(armature):
        found = crc32(repr(part).encode(), found)
    return f"{found} {'' if action is None else keys_digest(action)}"


def _parts(armature: bpy.types.Object) -> Iterator[object]:
    data = armature_data(armature)
    yield metres_per_unit(current_scene()), armature.scale.to_tuple(), data.pose_position
    for rest in data.bones:
        yield rest.name, rest.parent and rest.parent.name, _values(rest, _RESTS)
    keyed = {fcurves.bone_of(curve.data_path) for curve in fcurves.curves_of(armature)}
    for bone in pose_of(armature).bones:
        names = (each.identifier for each in bone.bl_rna.properties)
        yield _values(bone, [name for name in names if name.startswith(_POSES)])
        yield None if bone.name in keyed else repr(bone.matrix_basis)
        for constraint in bone.constraints:
            yield constraint.type, stored(constraint, _OF_FRAME)
    animated = armature.animation_data
    for curve in () if animated is None else animated.drivers:
        driver = present(curve.driver)
        yield curve_digest(curve), driver.is_valid, stored(driver)


def _values(thing: bpy.types.bpy_struct, names: Iterable[str]) -> list[object]:
    values = (getattr(thing, name) for name in names)
    return [tuple(each) if hasattr(each, "__len__") else each for each in values]
