"""How near bodies that controls pose are to where they should be, as Blender shows their keys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.data.reports.keys import BodyMiss
from ....solver.numerics.rotations import rotation_vector
from ...armature.channels import proper
from ...armature.poses import Poses
from ..targets import Targets

FAR_MM, TURNED_DEG = 1.0, 0.2  # by which a body may miss; beyond, it is told as a miss
WORST = 3  # bones that are told
LOST_MM, LOST_DEG = 10.0, 3.0  # by which a body is off for everybody to see


@dataclass(frozen=True)
class KeptByControls:
    """The worst in mm and degrees, each with its bone and frame; and how many controls have keys.

    worst: bones that miss most, the worst first.
    """

    mm: float
    far_bone: str
    far_frame: float
    degrees: float
    turned_bone: str
    turned_frame: float
    controls: int
    worst: tuple[BodyMiss, ...]

    @property
    def kept(self) -> bool:
        """Whether all is as near as is promised."""
        return self.mm <= FAR_MM and self.degrees <= TURNED_DEG

    @property
    def lost(self) -> tuple[BodyMiss, ...]:
        """Of the worst, those that anybody sees."""
        return tuple(m for m in self.worst if m.mm > LOST_MM or m.degrees > LOST_DEG)


def kept_by(shown: Poses, wanted: Targets, controls: int) -> KeptByControls:
    """What bodies miss at the targets' frames. shown: the poses there. controls: with keys."""
    bones = shown.matrices[:, [shown.bones.index(body) for body in wanted.bodies]]
    apart = wanted.unit[:, None, None] * (wanted.heads - bones[..., :3, 3])
    lacks = wanted.rotations @ np.swapaxes(proper(bones[..., :3, :3]), -1, -2)
    off, turned = (np.linalg.norm(each, axis=-1) for each in (apart, rotation_vector(lacks)))
    missed = [
        _missed(body, wanted.frames, off[:, b], turned[:, b])
        for b, body in enumerate(wanted.bodies)
    ]
    far = max(missed, key=lambda miss: miss.mm)
    turned = max(missed, key=lambda miss: miss.degrees)
    worst = sorted(missed, key=_share, reverse=True)[:WORST]
    return KeptByControls(
        far.mm,
        far.bone,
        far.far_frame,
        turned.degrees,
        turned.bone,
        turned.turned_frame,
        controls,
        tuple(worst),
    )


def _share(miss: BodyMiss) -> float:
    """Of what may be missed, by place or by turn."""
    return max(miss.mm / FAR_MM, miss.degrees / TURNED_DEG)


def _missed(bone: str, frames: FloatArray, off: FloatArray, turned: FloatArray) -> BodyMiss:
    """The most of what a bone misses at frames (T,), m and rad."""
    far, most = int(np.argmax(off)), int(np.argmax(turned))
    return BodyMiss(
        bone,
        1e3 * float(off[far]),
        float(frames[far]),
        float(np.degrees(turned[most])),
        float(frames[most]),
    )
