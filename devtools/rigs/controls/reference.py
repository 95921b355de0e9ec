"""What a rig's skin should look like: on the same deform bones, put where a solution has them by
their own channels, without controls, constraints or drivers.

Bones that bend within themselves (Blender's bendy bones) bend there as well, by the same settings:
rigid bodies say nothing of that, and the animator wants it.
"""

from __future__ import annotations

from collections.abc import Mapping, Set

import bpy
import numpy as np
from mathutils import Matrix

from ....bridge.accessors import armature_data, current_scene, pose_of, present
from ....bridge.armature.pose_basis import basis_under, place, with_ancestors
from ....solver.arrays import FloatArray
from .skin import skin_at


def skin_on_bones(
    rig: bpy.types.Object,
    skin: bpy.types.Object,
    frames: FloatArray,
    wanted: Mapping[str, FloatArray],
    rigid: Set[str],
) -> FloatArray:
    """(T, V, 3) m, where a skin's vertices are at frames (T,) while the rig's bones are at wanted
    poses (T, 4, 4), world; all others at rest under them. rigid: those of them as long as at rest.
    """
    bare = _bare(rig, rigid)
    copy = skin.copy()
    present(current_scene().collection).objects.link(copy)
    for modifier in copy.modifiers:
        if isinstance(modifier, bpy.types.ArmatureModifier):
            modifier.object = bare
    bases = _bases(bare, wanted, len(frames))

    def pose(t: int) -> None:
        for name, basis in bases.items():
            pose_of(bare).bones[name].matrix_basis = Matrix(basis[t].tolist())

    found = skin_at(copy, frames, pose)
    for thing in (copy, bare):
        bpy.data.objects.remove(thing)
    return found


def _bare(rig: bpy.types.Object, rigid: Set[str]) -> bpy.types.Object:
    """A copy of a rig at rest that nothing moves. Rigid bones alone stay connected, to each other,
    as bendy bones bend towards what they are connected to."""
    bare, data = rig.copy(), armature_data(rig).copy()
    bare.data = data
    present(current_scene().collection).objects.link(bare)
    bare.animation_data_clear()
    data.animation_data_clear()
    for bone in pose_of(bare).bones:
        for constraint in list(bone.constraints):
            bone.constraints.remove(constraint)
        bone.matrix_basis = Matrix.Identity(4)
    present(bpy.context.view_layer).objects.active = bare
    bpy.ops.object.mode_set(mode="EDIT")
    for edited in data.edit_bones:
        if edited.parent is None or not {edited.name, edited.parent.name} <= rigid:
            edited.use_connect = False
    bpy.ops.object.mode_set(mode="OBJECT")
    return bare


def _bases(
    bare: bpy.types.Object, wanted: Mapping[str, FloatArray], count: int
) -> dict[str, FloatArray]:
    """Pose bases (T, 4, 4) of bones and those above them, such that they are as wanted."""
    to_armature = np.linalg.inv(np.array(bare.matrix_world, float))
    bases: dict[str, FloatArray] = {}
    placed: dict[str, FloatArray] = {}
    for name in with_ancestors(bare, tuple(wanted)):
        bone = armature_data(bare).bones[name]
        parent = placed[bone.parent.name] if bone.parent is not None else None
        basis = np.tile(np.eye(4), (count, 1, 1))
        if name in wanted:
            basis = basis_under(bone, parent, to_armature @ wanted[name])
        bases[name] = basis
        placed[name] = place(bone, parent, basis)
    return bases
