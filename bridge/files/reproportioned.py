"""An armature of other proportions, for motions of a body whose limbs were changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.contacts import ContactSchedule
from ...solver.data.recording import PoseTrack, Recording
from ..armature.read import read_recording
from ..formats.motion_clip import from_recording
from .build_armature import build_armature


def build_reproportioned(
    recording: Recording, track: PoseTrack
) -> tuple[bpy.types.Object, PoseTrack, dict[str, FloatArray]]:
    """A new armature with a recording's bones, and a track of it in the new bones' axes.

    recording: of the changed proportions, see solver/body/body_changes.py. The new bones are turned
    about themselves against the recording's: the third value has by bone the (3, 3) rotation from
    the new axes to the old ones.
    """
    armature = build_armature(from_recording(recording), 1.0, "Z")
    built = read_recording(armature)
    turn = {
        bone.name: bone.rotation.T @ built.bones[built.index(bone.name)].rotation
        for bone in recording.bones
    }
    rotations = track.rotations @ np.stack([turn[bone] for bone in track.bones])
    return armature, replace(track, rotations=rotations), turn


def in_new_axes(schedule: ContactSchedule, turns: Mapping[str, FloatArray]) -> ContactSchedule:
    """Contacts of a recording on an armature that was built for it; turns: as built with it."""
    contacts = (replace(c, offset=turns[c.bone].T @ c.offset) for c in schedule.contacts)
    return replace(schedule, contacts=tuple(contacts))
