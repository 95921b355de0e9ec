"""Limbs and their partners on the other side, and how one takes the other's pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.recording import Recording
from ..numerics.rotations import unit
from ..skeleton.parts import SIDES, Part
from .figure import Figure
from .local_poses import LocalPoses

FORWARD = 0.9  # of a limb's way at rest; one that points so forward bends about the way across


@dataclass(frozen=True)
class Partners:
    """A limb of both sides, left first, from the trunk outwards.

    bones: (2, K) indices. along: (2, K, 3) unit, of each bone in its own axes. carry: (2, K, 3, 3)
    from each bone's axes to its partner's, where one is posed as the other.
    """

    bones: IntArray
    along: FloatArray
    carry: FloatArray

    def ways(self, recording: Recording) -> FloatArray:
        """(T, 2, K, 3) unit, world, along the bones."""
        found = np.einsum("tskij,skj->tski", recording.rotations[:, self.bones], self.along)
        return np.asarray(found)

    def ways_exchanged(self, recording: Recording) -> FloatArray:
        """The same where each limb is posed as its partner."""
        found = np.einsum("tskij,skj->tski", self._turns(recording.rotations), self.along)
        return np.asarray(found)

    def exchanged(self, recording: Recording, where: BoolArray) -> Recording:
        """In some frames (T,) each limb is posed as its partner was; what hangs on them follows,
        and lengths stay. Twice is the recording itself."""
        local, turns = LocalPoses.of(recording), self._turns(recording.rotations[where])
        carried = {int(bone): turns[:, side, k] for (side, k), bone in np.ndenumerate(self.bones)}
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        for b, bone in enumerate(recording.bones):
            if bone.parent >= 0:
                up = rotations[where, bone.parent]
                way = np.einsum("tij,tj->ti", up, local.heads[where, b])
                heads[where, b] = heads[where, bone.parent] + way
                rotations[where, b] = carried.get(b, up @ local.rotations[where, b])
        return replace(recording, rotations=rotations, heads=heads)

    def _turns(self, rotations: FloatArray) -> FloatArray:
        """(T, 2, K, 3, 3) of the bones posed as their partners are in rotations (T, B, 3, 3)."""
        return np.asarray(rotations[:, self.bones[::-1]] @ self.carry)


def partners(
    recording: Recording, figure: Figure, parts: Sequence[Part]
) -> tuple[Partners, Partners]:
    """Of the parts of a limb, from the trunk outwards, those that both sides have: posed so that
    bones point where their partners do, about whatever axes of their own, and so that they are
    turned from the rest pose as these are."""
    both = [part for part in parts if all((part, side) in figure.sided for side in SIDES)]
    bones = np.array([[figure.sided[part, side] for part in both] for side in SIDES])
    rest = np.stack([bone.head for bone in recording.bones])
    turned = np.stack([bone.rotation for bone in recording.bones])[bones]
    axes = np.stack([_axes(rest[limb], *_facing(rest, figure)) for limb in bones])
    back = np.swapaxes(turned, -1, -2)
    along = (back @ axes)[..., 0]
    pointing = back[::-1] @ axes[::-1] @ np.swapaxes(axes, -1, -2) @ turned
    return Partners(bones, along, pointing), Partners(bones, along, back[::-1] @ turned)


def _facing(rest: FloatArray, figure: Figure) -> tuple[FloatArray, FloatArray]:
    """(3,) unit each: to the left and ahead of a rest pose, joints (B, 3)."""
    thighs, shoulders = (
        rest[[figure.sided[part, side] for side in SIDES]] for part in (Part.THIGH, Part.UPPER_ARM)
    )
    left = unit(thighs[0] - thighs[1])
    return left, unit(np.cross(left, (shoulders - thighs).sum(axis=0)))


def _axes(joints: FloatArray, left: FloatArray, ahead: FloatArray) -> FloatArray:
    """(K, 3, 3) of a limb's bones by its joints (K, 3) at rest, which both sides have alike: along
    the bone, about the axis about which the limb bends, across both. An end points as what it
    hangs on."""
    ways = np.diff(joints, axis=0)
    along, whole = unit(np.concatenate([ways, ways[-1:]])), unit(joints[-1] - joints[0])
    bend = left if abs(whole @ ahead) > FORWARD else np.cross(whole, ahead)
    bend = unit(bend - (along @ bend)[:, None] * along)
    return np.stack([along, bend, np.cross(along, bend)], axis=-1)
