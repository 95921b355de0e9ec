"""Controls posed and bodies looked at, at the scene's frame, without a key."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ..accessors import armature_data, current_scene, pose_of, present
from ..armature.channels import proper
from ..armature.poses import evaluated
from .driven import constrained

_CHANNELS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")


@dataclass(frozen=True)
class Posed:
    """Poses in the armature's space and units.

    controls: (C, 4, 4). frames: (C, 4, 4), in which a control's rotation counts, and places:
    (C, 4, 4), in which its location does. bodies: (B, 4, 4).
    """

    controls: FloatArray
    frames: FloatArray
    places: FloatArray
    bodies: FloatArray

    @cached_property
    def frame_axes(self) -> FloatArray:
        """(C, 3, 3) rotations of the frames."""
        return proper(self.frames[:, :3, :3])

    @cached_property
    def place_axes(self) -> FloatArray:
        """(C, 3, 3) rotations of the places."""
        return proper(self.places[:, :3, :3])

    @cached_property
    def body_turns(self) -> FloatArray:
        """(B, 3, 3) rotations of the bodies."""
        return proper(self.bodies[:, :3, :3])


@contextmanager
def _skins_at_rest(armature: bpy.types.Object) -> Iterator[None]:
    """Context in which an armature bends nothing, which would be bent anew at each look at it."""
    bent = [
        modifier
        for each in present(bpy.context.view_layer).objects
        for modifier in each.modifiers
        if isinstance(modifier, bpy.types.ArmatureModifier)
        and modifier.object == armature
        and modifier.show_viewport
    ]
    for modifier in bent:
        modifier.show_viewport = False
    try:
        yield
    finally:
        for modifier in bent:
            modifier.show_viewport = True


def _inverse(matrices: FloatArray) -> FloatArray:
    """Of affine (C, 4, 4): by cofactors, for LAPACK's threads cost more than so small ones."""
    x, y, z = np.moveaxis(matrices[:, :3, :3], 1, 0)
    columns = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=2)
    inverse = np.zeros_like(matrices)
    inverse[:, :3, :3] = columns / (x * columns[:, :, 0]).sum(1)[:, None, None]
    inverse[:, :3, 3] = -(inverse[:, :3, :3] @ matrices[:, :3, 3, None])[..., 0]
    inverse[:, 3, 3] = 1.0
    return inverse


class Posing:
    """An armature whose controls are posed by matrices, to see what its bodies do."""

    def __init__(
        self, armature: bpy.types.Object, controls: Sequence[str], bodies: Sequence[str]
    ) -> None:
        self.armature = armature
        self.controls = tuple(controls)
        self.bodies = tuple(bodies)
        bones, rest = pose_of(armature).bones, armature_data(armature).bones
        self._columns = [bones.find(name) for name in (*controls, *bodies)]
        self._flat = np.empty(16 * len(bones), np.float32)
        self._bases = np.empty((len(self.controls), 4, 4))
        self._stored: list[list[tuple[float, ...]]] = []
        moved = constrained(armature)
        # What a constraint moves is not where its channels put it, but its parent is.
        self._parents: dict[int, tuple[int, FloatArray]] = {}
        # Without Local Location it counts along the parent's axes, from the bone's head at rest.
        self._nonlocal: dict[int, tuple[int | None, FloatArray]] = {}
        for index, name in enumerate(controls):
            above = rest[name].parent
            if not rest[name].use_local_location:
                head, column = np.array(rest[name].head_local, float), None
                if above is not None:
                    column = bones.find(above.name)
                    inverse = np.linalg.inv(np.array(above.matrix_local, float))
                    head = inverse[:3, :3] @ head + inverse[:3, 3]
                from_head = np.eye(4)
                from_head[:3, 3] = head
                self._nonlocal[index] = column, from_head
            if name in moved and above is not None:
                offset = np.linalg.solve(
                    np.array(above.matrix_local, float), np.array(rest[name].matrix_local, float)
                )
                self._parents[index] = bones.find(above.name), offset

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Context after which the controls' channels and the scene's frame are what they were.

        Skins are at rest meanwhile.
        """
        bones = [pose_of(self.armature).bones[name] for name in self.controls]
        self._stored = [[tuple(getattr(bone, name)) for name in _CHANNELS] for bone in bones]
        with evaluated([self.armature]), _skins_at_rest(self.armature):
            try:
                yield
            finally:
                self._restore()

    def _restore(self) -> None:
        for control, values in zip(self.controls, self._stored, strict=True):
            bone = pose_of(self.armature).bones[control]
            for name, value in zip(_CHANNELS, values, strict=True):
                setattr(bone, name, value)
        self.armature.update_tag()

    def go_to(self, frame: float) -> None:
        """Show a frame, whole or not, as it is animated; channels without keys as they were."""
        self._restore()
        whole = int(np.floor(frame))
        current_scene().frame_set(whole, subframe=frame - whole)
        bones = pose_of(self.armature).bones
        self._bases = np.array([bones[name].matrix_basis for name in self.controls], float)

    def bases(self) -> FloatArray:
        """(C, 4, 4) pose bases of the controls, as they were shown or posed last."""
        return self._bases.copy()

    def pose(self, control: int, basis: FloatArray) -> None:
        """Give a control a pose basis (4, 4)."""
        bone = pose_of(self.armature).bones[self.controls[control]]
        bone.matrix_basis = Matrix(basis.tolist())
        self._bases[control] = basis

    def look(self) -> Posed:
        """Evaluate what was posed."""
        present(bpy.context.view_layer).update()
        every = self._evaluated()
        matrices, count = every[self._columns], len(self.controls)
        frames = matrices[:count] @ _inverse(self._bases)
        for index, (parent, offset) in self._parents.items():
            frames[index] = every[parent] @ offset
        places = frames.copy()
        for index, (column, from_head) in self._nonlocal.items():
            places[index] = from_head if column is None else every[column] @ from_head
        return Posed(matrices[:count], frames, places, matrices[count:])

    def shown(self) -> tuple[FloatArray, FloatArray]:
        """Poses of the controls (C, 4, 4) and of the bodies (B, 4, 4) at a frame gone to."""
        matrices = self._evaluated()[self._columns]
        return matrices[: len(self.controls)], matrices[len(self.controls) :]

    def _evaluated(self) -> FloatArray:
        """(n, 4, 4) poses of all bones."""
        posed = self.armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        pose_of(posed).bones.foreach_get("matrix", self._flat)
        return self._flat.reshape(-1, 4, 4).transpose(0, 2, 1).astype(float)

    def object_to_world(self) -> FloatArray:
        """(4, 4) of the armature now."""
        posed = self.armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return np.array(posed.matrix_world, float)
