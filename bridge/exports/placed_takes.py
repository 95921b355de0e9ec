"""Takes of an armature as poses of the bones that a file gets, in its coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import armature_data, assigned_action, current_scene, present
from ..action_slots import span_of
from ..armature import fcurves
from ..armature.poses import Poses, metres_per_unit, sample
from ..companions.found import travels
from ..companions.root_motion import way, without_turns
from ..recipe.export import ExportOptions
from ..rows.choices import FileFormat, RootMotion
from .baked_rig import BakedTake
from .engines import CONVENTIONS, format_of
from .root_place import is_still, with_root
from .shapes import sample_shapes
from .skeleton import Outline, Skeleton, outline, scale_of, skeleton

_STILL = 1e-5  # Blender units, by which an object that rests may move
_LONGEST = 63  # bytes of a name


@dataclass(frozen=True)
class PlacedTakes:
    """What a baked rig is to be. Matrices (4, 4): its object to the world, and the armature's space
    to its own."""

    skeleton: Skeleton
    takes: tuple[BakedTake, ...]
    placed: FloatArray
    from_armature: FloatArray


@dataclass(frozen=True)
class _Space:
    """Matrices (4, 4): the armature at rest to the world, the world to the file's object, and this
    to the world, as Blender's exporter is to find it."""

    at_rest: FloatArray
    to_file: FloatArray
    placed: FloatArray


@dataclass(frozen=True)
class _Going:
    """How the figure goes over the floor. pelvis: the bone. path (T, 4, 4): moves of the figure, in
    the world. rest (4, 4): of the pelvis there. root_rests: a root bone does not go along."""

    pelvis: str
    path: FloatArray
    rest: FloatArray
    root_rests: bool


def place_takes(
    armature: bpy.types.Object,
    takes: Sequence[bpy.types.Action],
    options: ExportOptions,
    pelvis: str | None,
    shaped: Sequence[bpy.types.Object],
    *,
    keeps_frames: bool,
) -> PlacedTakes:
    """Evaluate takes and put them where the file has them; otherwise they begin at frame 0. shaped:
    meshes whose shape keys go along."""
    convention = CONVENTIONS[options.engine]
    found = outline_for(armature, options, pelvis)
    performed_takes = [_performed(armature, take, shaped) for take in takes]
    poses = [performed for performed, _ in performed_takes]
    space = _space(options, poses)
    from_armature = space.to_file @ space.at_rest
    made = skeleton(armature, found, from_armature)
    baked = []
    for take, (performed, shapes) in zip(takes, performed_takes, strict=True):
        placed = _placed(performed, found, made, space)
        if pelvis is not None and options.needs_pelvis:
            rest = space.at_rest @ np.array(armature_data(armature).bones[pelvis].matrix_local)
            hips = performed.matrices[:, performed.bones.index(pelvis)]
            path = way(performed.object_to_world @ hips, rest, steady=take.use_cyclic)
            rests = not _root_travels(performed, found, pelvis)
            going = _Going(pelvis, path, rest, root_rests=rests)
            placed = _travelling(placed, found, made, space, going, options)
        name = _called(take.name, convention.loop if take.use_cyclic else "")
        first = frames_of(take)[0] if keeps_frames else 0
        baked.append(BakedTake(name, first, placed, shapes))
    return PlacedTakes(made, tuple(baked), space.placed, from_armature)


def _called(name: str, ending: str) -> str:
    """A take's name with an ending; of a long name the end goes, as Blender would cut the ending
    off instead."""
    return name.encode()[: _LONGEST - len(ending)].decode(errors="ignore") + ending


def outline_for(armature: bpy.types.Object, options: ExportOptions, pelvis: str | None) -> Outline:
    """The bones that a file gets. pelvis: where it is known."""
    convention, carries = CONVENTIONS[options.engine], options.root is RootMotion.ROOT_BONE
    return outline(
        armature, pelvis, clean=convention.clean, root=carries, one_root=convention.one_root
    )


def _placed(performed: Poses, found: Outline, made: Skeleton, space: _Space) -> FloatArray:
    """(T, B, 4, 4) poses in the file, of an added root at rest."""
    columns = [performed.bones.index(name) for name in found.taken]
    world = performed.object_to_world[:, None] @ performed.matrices[:, columns]
    poses = space.to_file @ world
    poses[..., :3, :3] /= scale_of(space.to_file @ space.at_rest)
    if found.added:
        still = np.tile(made.rest[0], (len(poses), 1, 1, 1))
        poses = np.concatenate([still, poses], axis=1)
    return poses


def _in_file(path: FloatArray, space: _Space) -> FloatArray:
    """Moves in the world (..., 4, 4) as moves in the file."""
    return np.asarray(space.to_file @ path @ np.linalg.inv(space.to_file))


def _travelling(
    poses: FloatArray,
    found: Outline,
    made: Skeleton,
    space: _Space,
    going: _Going,
    options: ExportOptions,
) -> FloatArray:
    """Poses (T, B, 4, 4) whose way begins where, and is carried by what, the options say. A root
    bone that stays where it is, or left in place does not go along, is at rest, under the hips."""
    path = going.path
    if options.at_origin:
        start = np.linalg.inv(path[0])
        poses, path = _in_file(start, space) @ poses, start @ path
    if options.root is RootMotion.IN_PLACE:
        left = _in_file(without_turns(path, going.rest), space)
        poses = np.linalg.inv(left)[:, None] @ poses
    if found.root is None:
        return poses
    rest = made.rest[found.root]
    if options.root is RootMotion.ROOT_BONE:
        return with_root(poses, found, made.rest, going.pelvis, _in_file(path, space) @ rest)
    in_place = options.root is RootMotion.IN_PLACE
    if going.root_rests if in_place else is_still(poses[:, found.root], made.rest):
        still = np.tile(rest, (len(poses), 1, 1))
        return with_root(poses, found, made.rest, going.pelvis, still)
    return poses


def _root_travels(performed: Poses, found: Outline, pelvis: str) -> bool:
    """Whether the armature's root bone goes over the floor with the hips."""
    if found.root is None or found.added:
        return False
    names = (found.names[found.root], pelvis)
    columns = [performed.bones.index(name) for name in names]
    world = performed.object_to_world[:, None] @ performed.matrices[:, columns]
    root, hips = np.moveaxis(metres_per_unit(current_scene()) * world[..., :3, 3], 1, 0)
    return travels(root, hips)


def _space(options: ExportOptions, poses: Sequence[Poses]) -> _Space:
    """Where things are: a clean file has the armature's own place at its origin, as long as this
    stays where it is, and no transformation of the object."""
    form, convention = format_of(options), CONVENTIONS[options.engine]
    file = convention.space(form, current_scene())
    places = np.concatenate([each.object_to_world for each in poses])
    at_rest = places[0]
    if not convention.clean:
        metres = np.eye(4) if form is FileFormat.FBX else file
        return _Space(at_rest, np.linalg.inv(at_rest), metres @ at_rest)
    origin = np.eye(4)
    if np.ptp(places[:, :3, 3], axis=0).max() < _STILL:
        origin[:3, 3] = -at_rest[:3, 3]
    else:
        at_rest = at_rest.copy()
        at_rest[:3, 3] = 0.0
    undone = np.linalg.inv(file) if form is FileFormat.FBX else np.eye(4)
    return _Space(at_rest, file @ origin, undone)


def _performed(
    armature: bpy.types.Object, take: bpy.types.Action, shaped: Sequence[bpy.types.Object]
) -> tuple[Poses, FloatArray]:
    """Poses and meshes' shape keys at every whole frame of a take."""
    first, last = frames_of(take)
    frames = np.arange(first, last + 1.0)
    with _performing(armature, take):
        return sample(armature, frames), sample_shapes(shaped, frames)


def frames_of(take: bpy.types.Action) -> tuple[int, int]:
    """First and last whole frame of a take."""
    first, last = span_of(take)
    return round(first), round(last)


@contextmanager
def _performing(armature: bpy.types.Object, action: bpy.types.Action) -> Iterator[None]:
    """Context in which the armature performs an action alone."""
    data = present(armature.animation_data or armature.animation_data_create())
    was, slot, nla = assigned_action(armature), fcurves.slot_identifier(armature), data.use_nla
    try:
        fcurves.assign(armature, action, slot)
        data.use_nla = False
        yield
    finally:
        data.use_nla = nla
        fcurves.assign(armature, was, slot)
        scene = current_scene()
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
