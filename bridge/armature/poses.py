"""Sampling of an armature's evaluated pose over time, in Blender's own units and spaces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import TimeStretched
from ..accessors import armature_data, current_scene, pose_of
from ..action_slots import holders_of

COPIES = ("COPY_TRANSFORMS", "COPY_ROTATION")  # constraints that let a bone follow another


@dataclass(frozen=True)
class Poses:
    """Bones, parents first, at T instants.

    bones: their names. parents: (B,) indices, -1 for a root. object_to_world: (T, 4, 4).
    matrices: (T, B, 4, 4), bone to armature. Blender units.
    """

    bones: tuple[str, ...]
    parents: tuple[int, ...]
    object_to_world: FloatArray
    matrices: FloatArray

    @property
    def first(self) -> Poses:
        """The first instant alone."""
        return Poses(self.bones, self.parents, self.object_to_world[:1], self.matrices[:1])

    def of(self, bones: Sequence[str]) -> Poses:
        """Some bones alone, as if all were roots."""
        columns = [self.bones.index(each) for each in bones]
        matrices = self.matrices[:, columns]
        return Poses(tuple(bones), (-1,) * len(columns), self.object_to_world, matrices)


def metres_per_unit(scene: bpy.types.Scene) -> float:
    """Length of a Blender unit in m; 1 where the scene has no units."""
    units = scene.unit_settings
    return 1.0 if units.system == "NONE" else units.scale_length


def frames_per_second(scene: bpy.types.Scene) -> float:
    """Frame rate of a scene, 1/s."""
    return scene.render.fps / scene.render.fps_base


def require_unstretched(scene: bpy.types.Scene) -> None:
    """Raises TimeStretched where a scene's frame shows the keys of another one."""
    old, new = scene.render.frame_map_old, scene.render.frame_map_new
    if old != new:
        raise TimeStretched(old, new)


def set_frame_rate(scene: bpy.types.Scene, rate: float) -> None:
    """Has a scene play so many frames a second, by the nearest whole number and a base near 1."""
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate


def followed_bone(armature: bpy.types.Object, name: str) -> str:
    """The bone of the same armature whose turns the first of a bone's constraints copies; "" for
    none."""
    for each in pose_of(armature).bones[name].constraints:
        if each.type in COPIES and not each.mute and getattr(each, "target", None) == armature:
            return str(getattr(each, "subtarget", ""))
    return ""


def sample(armature: bpy.types.Object, frames: FloatArray) -> Poses:
    """Evaluate `armature`, constraints and drivers included, at each of `frames` (T,).

    The scene's frame, and whether the armature is seen, are afterwards what they were. Raises
    TimeStretched.
    """
    scene = current_scene()
    bones = _parents_first(armature)
    posed_as = {name: column for column, name in enumerate(pose_of(armature).bones.keys())}
    names = tuple(bone.name for bone in bones)
    columns, index = [posed_as[name] for name in names], {name: i for i, name in enumerate(names)}
    parents = tuple(index[bone.parent.name] if bone.parent else -1 for bone in bones)
    world = np.empty((len(frames), 4, 4))
    matrices = np.empty((len(frames), len(bones), 4, 4))
    flat = np.empty(16 * len(bones), np.float32)
    with evaluated([armature]):
        for t, frame in enumerate(frames):
            whole = int(np.floor(frame))
            scene.frame_set(whole, subframe=frame - whole)
            posed = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
            world[t] = posed.matrix_world
            pose_of(posed).bones.foreach_get("matrix", flat)
            # Blender stores columns, numpy rows.
            matrices[t] = flat.reshape(-1, 4, 4).transpose(0, 2, 1)[columns]
    return Poses(names, parents, world, matrices)


@contextmanager
def evaluated(objects: Iterable[bpy.types.Object]) -> Iterator[None]:
    """Context in which Blender evaluates objects, and the poses of armatures.

    It skips what is hidden, excluded or at rest, also where keys or drivers hide it. On exit these
    and the scene's frame are what they were. Raises TimeStretched.
    """
    scene = current_scene()
    require_unstretched(scene)
    with ExitStack() as undo:
        undo.callback(scene.frame_set, scene.frame_current, subframe=scene.frame_subframe)
        for thing in objects:
            for curve in _hiding(thing):
                _set(undo, curve, "mute", value=True)
            _set(undo, thing, "hide_viewport", value=False)
            if isinstance(thing.data, bpy.types.Armature):
                _set(undo, thing.data, "pose_position", value="POSE")
            # What is seen is evaluated anyway; to link it, Blender goes through the whole scene.
            if thing.name not in scene.collection.objects and not thing.visible_get():
                scene.collection.objects.link(thing)
                undo.callback(scene.collection.objects.unlink, thing)
        yield


def _set(undo: ExitStack, owner: bpy.types.bpy_struct, name: str, *, value: object) -> None:
    """Give a property a value until `undo`; where it has it already Blender is not told, which
    would copy all keys of the scene anew."""
    before = getattr(owner, name)
    if before != value:
        undo.callback(setattr, owner, name, before)
        setattr(owner, name, value)


def _hiding(thing: bpy.types.Object) -> list[bpy.types.FCurve]:
    """The curves and drivers that hide an object at some frames."""
    data = thing.animation_data
    if data is None:
        return []
    strips = [strip for track in data.nla_tracks for strip in track.strips]
    for strip in strips:  # which grows by what is in meta strips
        strips += strip.strips
    played = (data.action, *(strip.action for strip in strips))
    actions = dict.fromkeys(each for each in played if each is not None)
    # Blender looks among a thousand curves in less time than it takes to hand out one.
    holders = [data.drivers, *(held.fcurves for each in actions for held in holders_of(each))]
    found = (curves.find("hide_viewport") for curves in holders)
    return [curve for curve in found if curve is not None]


def _parents_first(armature: bpy.types.Object) -> list[bpy.types.Bone]:
    return sorted(armature_data(armature).bones, key=lambda bone: len(bone.parent_recursive))
