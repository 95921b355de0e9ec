"""Drift of pinned points in Blender: in the written action and after FBX and back."""

from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ...bridge.accessors import current_action
from ...bridge.armature import fcurves
from ...bridge.armature.read import read_recording
from ...bridge.armature.write import write_action
from ...bridge.files.export import export_fbx, reimport_fbx
from ...bridge.files.import_clip import import_clip
from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.contacts import Contact
from ...solver.data.recording import Recording
from ...solver.transcription.motion import Motion
from .clips import Clip

SETTLING = 0.03  # s at either end of a contact, told apart


@dataclass(frozen=True)
class Drift:
    """Largest distance of a pinned point from its place, m: while it is held, and at the ends."""

    held: float
    ends: float


def open_clip(clip: Clip) -> tuple[bpy.types.Object, Recording]:
    """An empty scene with the clip, and its used part as Blender evaluates it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    armature = import_clip(clip.path).armature
    first, last = clip.frames
    return armature, read_recording(armature, first=first, last=last)


def drifts(
    armature: bpy.types.Object, recording: Recording, motion: Motion, fbx: Path
) -> tuple[Drift, Drift]:
    """Writes the motion as an action and as FBX, and reads both back on every frame."""
    first, last = recording.frames[[0, -1]]
    own, slot = current_action(armature), fcurves.slot_identifier(armature)
    action = write_action(armature, motion.track(recording), name="measured")
    written = read_recording(armature, first=first, last=last)
    export_fbx(armature, action, fbx)
    fcurves.assign(armature, own, slot)
    back = reimport_fbx(fbx, recording.frames)
    bpy.data.actions.remove(action)
    return drift(motion, written), drift(motion, back)


def drift(motion: Motion, shown: Recording) -> Drift:
    """Of every contact's point, fixed in its bone, in what Blender shows."""
    contacts = [c.contact for c in motion.transcription.contacts]
    held = ends = 0.0
    for contact, place in zip(contacts, motion.places, strict=True):
        bone = shown.index(contact.bone)  # keeps its own axes through FBX, though not its rest pose
        point = shown.heads[:, bone] + shown.rotations[:, bone] @ contact.offset
        off = np.linalg.norm(point - place, axis=1)
        inside, settling = _instants(contact, shown.times)
        held = max(held, float(off[inside].max(initial=0.0)))
        ends = max(ends, float(off[settling].max(initial=0.0)))
    return Drift(held, ends)


def _instants(contact: Contact, times: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Frames in which the point is held, and those in which it may settle or roll."""
    slack = 1e-6
    touching = (times > contact.start - slack) & (times < contact.end + slack)
    # A contact that the clip cuts off neither begins nor ends there.
    begins = contact.start + (SETTLING if contact.start > times[0] else 0.0)
    ends = contact.end - (SETTLING if contact.end < times[-1] else 0.0)
    inside = touching & (times > begins - slack) & (times < ends + slack)
    return inside, touching & ~inside
