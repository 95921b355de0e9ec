"""Whether a rig's bodies are moved by controls, and which bones may be those."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import bpy

from ..accessors import armature_data, pose_of
from ..armature import fcurves
from ..armature.played import leaders_of
from ..armature.pose_basis import carrier_of
from ..armature.write import rotation_channel

_INNER = ("ORG-", "DEF-", "MCH-", "VIS_", "WGT-")  # Rigify's, which are no controls
_FEWEST_SHAPES = 5  # bones with shapes of their own, by which a rig shows what its controls are
_PASSIVE = ("LIMIT_", "MAINTAIN_VOLUME", "CACHE")  # constraints that move nothing by themselves
_CHAINS = (bpy.types.KinematicConstraint, bpy.types.SplineIKConstraint)


def is_driven(armature: bpy.types.Object, bones: Iterable[str]) -> bool:
    """Whether constraints, more than keys of their own, pose some of these bones."""
    return bool(driven_of(armature, bones))


def beside_keys(armature: bpy.types.Object) -> bool:
    """Whether there is anything beside keys that could pose bones: constraints or drivers."""
    data = armature.animation_data
    driven = data is not None and len(data.drivers) > 0
    return driven or any(len(bone.constraints) for bone in pose_of(armature).bones)


def turned_by_drivers(armature: bpy.types.Object, bones: Sequence[str]) -> list[str]:
    """Those of these bones, the pelvis first, whose rotations drivers set, or the location that
    carries the pelvis. A driver that is in error sets nothing, and keys count."""
    data, posed = armature.animation_data, pose_of(armature).bones
    if data is None:
        return []
    driven = {d.data_path for d in data.drivers if not d.mute and d.driver and d.driver.is_valid}
    carrier = posed[carrier_of(armature_data(armature).bones[bones[0]]).name]
    paths = {name: posed[name].path_from_id(rotation_channel(posed[name])) for name in bones}
    found = [name for name, path in paths.items() if path in driven]
    if carrier.path_from_id("location") in driven:
        found.append(carrier.name)
    return list(dict.fromkeys(found))


def driven_of(armature: bpy.types.Object, bones: Iterable[str]) -> list[str]:
    """Those of these bones that constraints pose, and no keys of their own; or inverse kinematics,
    whatever keys they have."""
    moved, chained = constrained(armature), set[str]()
    for bone, constraint in _acting(armature):
        chained.update(chain_of(bone, constraint))
    keyed = {fcurves.bone_of(curve.data_path) for curve in fcurves.curves_of(armature)}
    return [name for name in bones if name in moved and (name in chained or name not in keyed)]


def moved_beside_keys(armature: bpy.types.Object) -> set[str]:
    """Bones that drivers or constraints may move."""
    driven = (fcurves.bone_of(path) for path in _driven_paths(armature))
    return {*constrained(armature), *(name for name in driven if name is not None)}


def constrained(armature: bpy.types.Object) -> set[str]:
    """Bones with constraints that may act, and those of inverse kinematics' chains."""
    found: set[str] = set()
    for bone, constraint in _acting(armature):
        found.update((bone.name, *chain_of(bone, constraint)))
    return found


def acting_on(armature: bpy.types.Object, bones: Iterable[str]) -> tuple[str, ...]:
    """Names of the constraints, limits among them, that may act on some of these bones."""
    on, found = set(bones), list[str]()
    for bone, constraint in _acting(armature, passive=True):
        if not on.isdisjoint((bone.name, *chain_of(bone, constraint))):
            found.append(constraint.name)
    return tuple(dict.fromkeys(found))


def _acting(
    armature: bpy.types.Object, *, passive: bool = False
) -> Iterator[tuple[bpy.types.PoseBone, bpy.types.Constraint]]:
    """Constraints that have influence, or may come to it. passive: also those that move nothing by
    themselves."""
    switched = _animated(armature)
    for bone, constraint in constraints_of(armature, passive=passive):
        if constraint.influence > 0.0 or constraint.path_from_id("influence") in switched:
            yield bone, constraint


def constraints_of(
    armature: bpy.types.Object, *, passive: bool = False
) -> Iterator[tuple[bpy.types.PoseBone, bpy.types.Constraint]]:
    """The constraints that move bones wherever they have influence, with their bones. passive: also
    those that move nothing by themselves."""
    for bone in pose_of(armature).bones:
        for constraint in bone.constraints:
            moves = passive or not constraint.type.startswith(_PASSIVE)
            if moves and not constraint.mute and constraint.is_valid:
                yield bone, constraint


def chain_of(bone: bpy.types.PoseBone, constraint: bpy.types.Constraint) -> list[str]:
    """The bones that a constraint of inverse kinematics moves; none of another constraint."""
    if not isinstance(constraint, _CHAINS) or constraint.target is None:
        return []
    chain = [bone, *bone.parent_recursive]
    count = constraint.chain_count or len(chain)
    return [each.name for each in chain[:count]]


def followed_by(armature: bpy.types.Object, bones: Iterable[str]) -> set[str]:
    """These bones, what they hang on and what their constraints follow in the armature, and so on:
    what may move them."""
    posed, found, waiting = pose_of(armature).bones, set[str](), list(bones)
    while waiting:
        bone = posed.get(waiting.pop())
        if bone is None or bone.name in found:
            continue
        found.add(bone.name)
        waiting += [bone.parent.name] if bone.parent is not None else []
        leaders = (leader for each in bone.constraints for leader in leaders_of(each))
        waiting += [name for thing, name in leaders if thing == armature]
    return found


def stretching(armature: bpy.types.Object) -> set[str]:
    """Bones of inverse kinematics that may become longer and shorter as it acts."""
    bones, found = pose_of(armature).bones, set[str]()
    for bone, constraint in constraints_of(armature):
        if isinstance(constraint, bpy.types.KinematicConstraint) and constraint.use_stretch:
            chain = chain_of(bone, constraint)
            found.update(name for name in chain if bones[name].ik_stretch > 0.0)
    return found


def _animated(armature: bpy.types.Object) -> set[str]:
    """Paths of what curves or drivers change."""
    keyed = (curve.data_path for curve in fcurves.curves_of(armature))
    return {*_driven_paths(armature), *keyed}


def _driven_paths(armature: bpy.types.Object) -> list[str]:
    data = armature.animation_data
    return [] if data is None else [driver.data_path for driver in data.drivers]


def candidates(armature: bpy.types.Object, bodies: Iterable[str]) -> list[str]:
    """Bones that an artist may pose, parents first: those with shapes of their own where a rig has
    such, and those with keys; but none whose channels are all locked, and no bodies that inverse
    kinematics always poses."""
    keyed = {fcurves.bone_of(curve.data_path) for curve in fcurves.curves_of(armature)}
    bones = [b for b in pose_of(armature).bones if not b.name.startswith(_INNER)]
    shaped = [bone for bone in bones if bone.custom_shape is not None]
    if len(shaped) >= _FEWEST_SHAPES:
        bones = [b for b in bones if b.custom_shape is not None or b.name in keyed]
    inner = _always_chained(armature) & set(bodies)
    found = [bone.name for bone in bones if bone.name not in inner and _free(bone)]
    rest = armature_data(armature).bones
    return sorted(found, key=lambda name: len(rest[name].parent_recursive))


def _always_chained(armature: bpy.types.Object) -> set[str]:
    switched, found = _animated(armature), set[str]()
    for bone, constraint in constraints_of(armature):
        if constraint.influence > 0.0 and constraint.path_from_id("influence") not in switched:
            found.update(chain_of(bone, constraint))
    return found


def _free(bone: bpy.types.PoseBone) -> bool:
    return not (all(bone.lock_location) and all(bone.lock_rotation))
