"""Which pinned points a polish moves: what touches was solved to stay where it is."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.contacts import Contact, ContactSchedule
from ..accessors import current_scene
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.poses import Poses, metres_per_unit

FAR = 0.002  # m, by which a pinned point is not where it was solved to be


@dataclass(frozen=True)
class MovedPin:
    """A contact, by how far it is moved at most (m), and at which frame."""

    name: str
    distance: float
    frame: float


@dataclass(frozen=True)
class PinnedFrames:
    """Contacts of a result, each with its first and last frame there, and polished frames (T,) of
    which some contact has each."""

    contacts: tuple[tuple[Contact, float, float], ...]
    frames: FloatArray

    @staticmethod
    def of(
        schedule: ContactSchedule, first: float, rate: float, polished: FloatArray
    ) -> PinnedFrames:
        """first: scene frame of the schedule's start. rate: frames a s. polished: frames (T,)."""
        contacts = tuple(
            (contact, first + rate * contact.start, first + rate * contact.end)
            for contact in schedule.contacts
        )
        within = [(polished >= start) & (polished <= end) for _, start, end in contacts]
        frames = polished[np.any(within, axis=0)] if within else np.empty(0)
        return PinnedFrames(contacts, frames)

    def poses(self, armature: bpy.types.Object) -> Incremental[Poses | None]:
        """The armature's, as it is shown; None where no polished frame has a contact."""
        if not len(self.frames):
            return None
        return (yield from sample_incrementally(armature, self.frames))

    def moved(self, before: Poses | None, after: Poses | None) -> tuple[MovedPin, ...]:
        """Contacts that are elsewhere by more than FAR, the worst first."""
        if before is None or after is None:
            return ()
        found = []
        for contact, start, end in self.contacts:
            rows = (self.frames >= start) & (self.frames <= end)
            apart = np.linalg.norm(_places(after, contact) - _places(before, contact), axis=1)
            apart = np.where(rows, apart, 0.0)
            if apart.max() > FAR:
                worst = float(self.frames[apart.argmax()])
                found.append(MovedPin(contact.name, float(apart.max()), worst))
        return tuple(sorted(found, key=lambda pin: -pin.distance))


def _places(poses: Poses, contact: Contact) -> FloatArray:
    """(T, 3) m, world, of a contact's point."""
    metres = metres_per_unit(current_scene())
    world = poses.object_to_world @ poses.matrices[:, poses.bones.index(contact.bone)]
    turns = world[:, :3, :3] / np.linalg.norm(world[:, :3, :3], axis=1, keepdims=True)
    return np.asarray(metres * world[:, :3, 3] + turns @ contact.offset)
