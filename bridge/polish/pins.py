"""Which pinned points a polish moves: what touches was solved to stay where it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.contacts import ContactSchedule
from ..accessors import armature_data, current_scene
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.poses import Poses, metres_per_unit
from ..constraint_kinds import point
from ..properties.settings import settings_of
from ..rows.times import interval_of, named_frames
from ..takes.take_time import TakeTime

FAR = 0.002  # m, by which a pinned point is not where it was solved to be


@dataclass(frozen=True)
class MovedPin:
    """A pinned point, by how far it is moved at most (m), and at which frame."""

    name: str
    distance: float
    frame: float


@dataclass(frozen=True)
class PinnedPoint:
    """A bone's point that was solved to be where it is on frames of a result.

    offset: (3,) m from the bone's head, in the bone's axes.
    """

    name: str
    bone: str
    offset: FloatArray
    first: float
    last: float

    def on(self, frames: FloatArray) -> BoolArray:
        """(T,) which of these frames it is about."""
        return np.asarray((frames >= self.first) & (frames <= self.last))


def contact_pins(schedule: ContactSchedule, first: float, rate: float) -> list[PinnedPoint]:
    """What touches. first: scene frame of the schedule's start. rate: frames a s."""
    return [
        PinnedPoint(c.name, c.bone, c.offset, first + rate * c.start, first + rate * c.end)
        for c in schedule.contacts
    ]


def point_pins(armature: bpy.types.Object, time: TakeTime) -> list[PinnedPoint]:
    """Points that the artist's constraints hold exactly. time: where the take's frames are."""
    settings, metres = settings_of(armature), metres_per_unit(current_scene())
    phases, size = named_frames(settings), metres * armature.matrix_world.median_scale
    found: list[PinnedPoint] = []
    for row in settings.constraints:
        if row.kind != point.KIND.name or not row.used or row.use_bounds or not len(row.bones):
            continue
        bone = armature_data(armature).bones.get(row.bones[0].name)
        if bone is None:
            continue
        frames = np.array(interval_of(row, phases, None))
        within = frames if np.isinf(frames).any() else time.to_result(frames)
        offset = row.offset if row.use_offset else (0.0, 0.5 * bone.length, 0.0)
        first, last = float(np.floor(within[0])), float(np.ceil(within[1]))
        found.append(PinnedPoint(row.name, bone.name, size * np.array(offset), first, last))
    return found


@dataclass(frozen=True)
class PinnedFrames:
    """Pinned points, and polished frames (T,) of which some point is about each."""

    points: tuple[PinnedPoint, ...]
    frames: FloatArray

    @staticmethod
    def of(points: Iterable[PinnedPoint], polished: FloatArray) -> PinnedFrames:
        """polished: frames (T,)."""
        every = tuple(points)
        within = [each.on(polished) for each in every]
        return PinnedFrames(every, polished[np.any(within, axis=0)] if within else np.empty(0))

    def poses(self, armature: bpy.types.Object) -> Incremental[Poses | None]:
        """The armature's, as it is shown; None where no polished frame has a point."""
        if not len(self.frames):
            return None
        return (yield from sample_incrementally(armature, self.frames))

    def moved(self, before: Poses | None, after: Poses | None) -> tuple[MovedPin, ...]:
        """Points that are elsewhere by more than FAR, the worst first."""
        if before is None or after is None:
            return ()
        found = []
        for each in self.points:
            apart = np.linalg.norm(_places(after, each) - _places(before, each), axis=1)
            apart = np.where(each.on(self.frames), apart, 0.0)
            if apart.max() > FAR:
                worst = float(self.frames[apart.argmax()])
                found.append(MovedPin(each.name, float(apart.max()), worst))
        return tuple(sorted(found, key=lambda pin: -pin.distance))


def _places(poses: Poses, pinned: PinnedPoint) -> FloatArray:
    """(T, 3) m, world, of a point."""
    metres = metres_per_unit(current_scene())
    world = poses.object_to_world @ poses.matrices[:, poses.bones.index(pinned.bone)]
    turns = world[:, :3, :3] / np.linalg.norm(world[:, :3, :3], axis=1, keepdims=True)
    return np.asarray(metres * world[:, :3, 3] + turns @ pinned.offset)
