"""The keyed figure of an armature's poses: what its bones' channels move in the world."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.numerics.rotations import angles_between
from ..accessors import armature_data
from ..armature.channels import proper
from ..armature.incremental import Incremental
from ..armature.pose_basis import place
from ..recipe.keys import KeyOptions
from .bone_channels import BoneChannels
from .events import KeyEvents
from .figure import KeyedBone, KeyedFigure

STEP = 1e-5  # of a channel, for its effect by central differences
# Share of the error by which a point that stands may slide: the ground beside it shows that, while
# nothing shows it of a hand in the air.
PLANTED = 0.5


def nearest_frames(frames: FloatArray, wanted: Iterable[float]) -> tuple[float, ...]:
    """Those of frames (T,) that are nearest to wanted ones, in order."""
    return tuple(sorted({float(frames[np.abs(frames - frame).argmin()]) for frame in wanted}))


@dataclass(frozen=True)
class PosedBones:
    """Channels of an armature's bones at T frames, and what else moves them.

    bases: pose bases (T, 4, 4) of these bones and all their ancestors, parents first.
    to_world: (T, 4, 4) from the armature's space and units to the world in m.
    """

    armature: bpy.types.Object
    frames: FloatArray
    channels: tuple[BoneChannels, ...]
    bases: dict[str, FloatArray]
    to_world: FloatArray

    def matrices(self, values: list[FloatArray] | None = None) -> dict[str, FloatArray]:
        """Poses (T, 4, 4) by bone in the armature's space; values: (T, n) by bone with channels,
        instead of its own."""
        bases = dict(self.bases)
        if values is not None:
            bases |= {c.bone: c.basis_of(own) for c, own in zip(self.channels, values, strict=True)}
        placed: dict[str, FloatArray] = {}
        for name, basis in bases.items():
            bone = armature_data(self.armature).bones[name]
            placed[name] = place(bone, placed[bone.parent.name] if bone.parent else None, basis)
        return placed

    @property
    def bones(self) -> tuple[str, ...]:
        """Names of those with channels."""
        return tuple(c.bone for c in self.channels)

    def errors(self, values: list[FloatArray]) -> Incremental[tuple[FloatArray, FloatArray]]:
        """Distances (T, B) m of the heads of bones with channels from where they should be, and
        angles (T, B) rad, with other values (T, n) by bone."""
        should, are = self.matrices(), self.matrices(values)
        yield None
        apart = [self.heads(are[n]) - self.heads(should[n]) for n in self.bones]
        turned = [proper(each[n][:, :3, :3]) for n in self.bones for each in (are, should)]
        return (
            np.linalg.norm(np.stack(apart, axis=1), axis=2),
            angles_between(np.stack(turned[::2], axis=1), np.stack(turned[1::2], axis=1)),
        )

    def heads(self, matrices: FloatArray) -> FloatArray:
        """World places (T, 3) m of the heads of poses (T, 4, 4)."""
        return self._world(matrices[:, :3, 3])

    def _world(self, places: FloatArray) -> FloatArray:
        turned = np.einsum("tij,tj->ti", self.to_world[:, :3, :3], places)
        return np.asarray(turned + self.to_world[:, :3, 3])

    def keyed_figure(self, events: KeyEvents, error: KeyOptions) -> KeyedFigure:
        """The figure that these bones make, with the points that may be off by no more."""
        placed = self.matrices()
        names = [c.bone for c in self.channels]
        carries = self._carries(names)
        tips = [name for i, name in enumerate(names) if carries[i].sum() == 1]
        planted = [p for p in events.planted if p.bone in names]
        tails = [self._world(self._tail(placed[n], n)) for n in tips]
        points = [self.heads(placed[n]) for n in names] + tails
        points += [self._planted(placed[p.bone], p.offset) for p in planted]
        owners = [*names, *tips, *(p.bone for p in planted)]
        distances = np.full((len(self.frames), len(points)), error.distance)
        for column, point in enumerate(planted, start=len(names) + len(tips)):
            stands = (self.frames >= point.first) & (self.frames <= point.last)
            distances[stands, column] *= PLANTED
        return KeyedFigure(
            self.frames,
            tuple(self._keyed(c, placed, events) for c in self.channels),
            carries,
            np.stack(points, axis=1),
            np.array([names.index(owner) for owner in owners]),
            distances,
            error.angle,
        )

    def _carries(self, names: list[str]) -> BoolArray:
        bones = armature_data(self.armature).bones
        above = {n: {n, *(b.name for b in bones[n].parent_recursive)} for n in names}
        return np.array([[one in above[other] for other in names] for one in names])

    def _tail(self, matrices: FloatArray, name: str) -> FloatArray:
        length = armature_data(self.armature).bones[name].length
        return np.asarray(matrices[:, :3, 3] + length * matrices[:, :3, 1])

    def _planted(self, matrices: FloatArray, offset: FloatArray) -> FloatArray:
        turned = proper(self.to_world[:, :3, :3] @ matrices[:, :3, :3])
        return np.asarray(self.heads(matrices) + turned @ offset)

    def _keyed(
        self, own: BoneChannels, placed: dict[str, FloatArray], events: KeyEvents
    ) -> KeyedBone:
        turns, shifts = self._effects(own, placed)
        edges = [t for p in events.planted if p.bone == own.bone for t in (p.first, p.last)]
        return KeyedBone(
            own.bone,
            own.values,
            turns,
            shifts,
            self.heads(placed[own.bone]),
            nearest_frames(self.frames, (*events.columns, *edges)),
        )

    def _effects(
        self, own: BoneChannels, placed: dict[str, FloatArray]
    ) -> tuple[FloatArray, FloatArray]:
        """Rotation vectors and displacements (T, 3, n), world, by channel of a bone."""
        bone = armature_data(self.armature).bones[own.bone]
        parent = placed[bone.parent.name] if bone.parent else None
        linear = self.to_world[:, :3, :3] @ placed[own.bone][:, :3, :3]
        turns, shifts = np.empty((2, *own.values.shape[:1], 3, own.values.shape[1]))
        for k, step in enumerate(STEP * np.eye(own.values.shape[1])):
            ahead, back = (
                place(bone, parent, own.basis_of(own.values + sign * step)) for sign in (1.0, -1.0)
            )
            change = self.to_world[:, :3, :3] @ ((ahead - back)[:, :3] / (2.0 * STEP))
            spin = change[:, :, :3] @ np.linalg.inv(linear)
            for i in range(3):
                j, n = (i + 1) % 3, (i + 2) % 3
                turns[:, i, k] = (spin[:, n, j] - spin[:, j, n]) / 2.0
            shifts[:, :, k] = change[:, :, 3]
        return turns, shifts
