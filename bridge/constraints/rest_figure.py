"""An armature's rest pose by parts of the body, and how its recording moves them."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part, Segment, Side, guess_anatomy, map_anatomy
from ...solver.body.human_limits import RestFigure
from ...solver.data.faults import MissingPart
from ...solver.numerics.rotations import unit
from ..accessors import armature_data
from ..armature.actions import recorded_action, recorded_poses
from ..armature.channels import proper
from ..armature.poses import Poses
from ..armature.read import named_bones
from ..properties.settings import settings_of
from ..rows.phases import clip_ends, recorded_span
from .bone_mapping import chosen_parts

LOOKS = 48  # instants of a recording that are looked at, at most
NEXT = {
    Part.THIGH: Part.SHANK,
    Part.SHANK: Part.FOOT,
    Part.FOOT: Part.TOE,
    Part.UPPER_ARM: Part.FOREARM,
    Part.FOREARM: Part.HAND,
}
LABELS = {f"{side.value} {part.value}".strip(): (part, side) for side in Side for part in Part}
Parts = dict[tuple[Part, Side], tuple[str, ...]]


def parts_of(armature: bpy.types.Object) -> Parts:
    """The bones of each part of the body, parents first: the artist's choice, else by name."""
    bones, rows = named_bones(armature), chosen_parts(settings_of(armature))
    # A script may have called a row anything.
    chosen = {label: bone for label, bone in rows.items() if label in LABELS}
    try:
        segments = map_anatomy(bones, chosen)
    except MissingPart:
        names = [bone.name for bone in bones]
        found = {**guess_anatomy(bones), **chosen}
        segments = tuple(
            Segment(*LABELS[label], names.index(bone))
            for label, bone in found.items()
            if bone in names
        )
    parts: Parts = {}
    for segment in segments:
        key = (segment.part, segment.side)
        parts[key] = (*parts.get(key, ()), bones[segment.bone].name)
    return parts


def jointed_bones(armature: bpy.types.Object) -> set[str]:
    """The bones that have joints of their own: all that are parts of the body but the pelvis.

    Where no parts are known, every bone with a parent.
    """
    parts = parts_of(armature)
    if not parts:
        return {bone.name for bone in armature_data(armature).bones if bone.parent is not None}
    return {b for (part, _), bones in parts.items() if part is not Part.PELVIS for b in bones}


def rest_figure(armature: bpy.types.Object, parts: Parts, world: FloatArray) -> RestFigure | None:
    """The rest pose where the armature stands; None without both thighs, which tell its left.

    world: (4, 4) the armature to the world.
    """
    sides = [parts.get((Part.THIGH, side), ()) for side in (Side.LEFT, Side.RIGHT)]
    if not all(sides):
        return None
    bones = armature_data(armature).bones
    mapped = {bone for several in parts.values() for bone in several}
    turn = proper(world[:3, :3])
    left, right = (np.array(bones[side[0]].head_local, float) for side in sides)
    across = turn @ (left - right)
    across[2] = 0.0
    parents = {name: above for name in mapped if (above := _mapped_above(bones[name], mapped))}
    along = {name: turn @ _along(bones[name], _following(name, parts), bones) for name in mapped}
    return RestFigure(parts, parents, along, unit(across))


def directions(
    poses: Poses, figure: RestFigure, rest: Mapping[str, FloatArray]
) -> Mapping[str, FloatArray]:
    """(T, 3) of every mapped bone with a parent: its direction against that, axes of the rest pose.

    rest: (3, 3) of each bone, to the armature.
    """
    world = proper(poses.object_to_world[:, :3, :3])
    turned = {}
    for name in figure.along:
        now = world @ proper(poses.matrices[:, poses.bones.index(name), :3, :3])
        turned[name] = now @ (world[0] @ rest[name]).T
    return {
        name: np.einsum("tji,tj->ti", turned[parent], turned[name] @ figure.along[name])
        for name, parent in figure.parents.items()
    }


def recorded_looks(armature: bpy.types.Object) -> Poses | None:
    """The recording's poses at some of its frames; None where there is none."""
    settings = settings_of(armature)
    ends = clip_ends(settings) or recorded_span(settings)
    if ends is None or recorded_action(armature) is None:
        return None
    count = int(min(LOOKS, ends[1] - ends[0] + 1))
    return recorded_poses(armature, np.round(np.linspace(*ends, max(count, 2))))


def rest_rotations(armature: bpy.types.Object) -> dict[str, FloatArray]:
    """(3, 3) of each bone at rest, to the armature."""
    return {b.name: np.array(b.matrix_local.to_3x3(), float) for b in armature_data(armature).bones}


def _mapped_above(bone: bpy.types.Bone, mapped: set[str]) -> str | None:
    return next((above.name for above in bone.parent_recursive if above.name in mapped), None)


def _following(name: str, parts: Parts) -> str | None:
    """The bone at whose head a bone ends, where a part of the body goes on there."""
    for (part, side), bones in parts.items():
        if name in bones:
            later = bones[bones.index(name) + 1 :]
            beyond = parts.get((NEXT[part], side), ()) if part in NEXT else ()
            return next(iter(later or beyond), None)
    return None


def _along(
    bone: bpy.types.Bone, following: str | None, bones: bpy.types.ArmatureBones
) -> FloatArray:
    """(3,) unit, the armature's axes."""
    end = bone.tail_local if following is None else bones[following].head_local
    span = np.array(end - bone.head_local, float)
    if np.linalg.norm(span) < 1e-6:
        span = np.array(bone.tail_local - bone.head_local, float)
    return unit(span)
