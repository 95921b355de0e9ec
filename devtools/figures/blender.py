"""Drift of pinned points in Blender: in the written action and after FBX and back."""

from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ...bridge.accessors import current_action
from ...bridge.armature import fcurves
from ...bridge.armature.read import read_recording
from ...bridge.armature.write import write_action
from ...bridge.exports.export import export_takes
from ...bridge.files.import_clip import import_clip
from ...bridge.files.reimport import reimport
from ...solver.data.recording import BEYOND, Recording
from ...solver.transcription.motion import Motion
from .clips import Clip


@dataclass(frozen=True)
class Drift:
    """Largest distances of a pinned point from its place over the whole contact, m: beside it or
    under it, and above it, as its sole gives."""

    held: float
    above: float


def open_clip(clip: Clip) -> tuple[bpy.types.Object, Recording]:
    """An empty scene with the clip, and its used part as Blender evaluates it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    armature = import_clip(clip.path).armature
    first, last = clip.frames
    return armature, read_recording(armature, first=first, last=last, beyond=BEYOND)


def drifts(
    armature: bpy.types.Object, recording: Recording, motion: Motion, fbx: Path
) -> tuple[Drift, Drift]:
    """Writes the motion as an action and as FBX, and reads both back on every frame."""
    first, last = recording.frames[[0, -1]]
    own, slot = current_action(armature), fcurves.slot_identifier(armature)
    action = write_action(armature, motion.track(recording), name="measured")
    written = read_recording(armature, first=first, last=last)
    export_takes(armature, [action], fbx)
    fcurves.assign(armature, own, slot)
    back = reimport(fbx, recording.frames)
    bpy.data.actions.remove(action)
    return drift(motion, written), drift(motion, back)


def drift(motion: Motion, shown: Recording) -> Drift:
    """Of every contact's point, fixed in its bone, in what Blender shows."""
    contacts = [c.contact for c in motion.transcription.contacts]
    held = above = 0.0
    for contact, place in zip(contacts, motion.places, strict=True):
        bone = shown.index(contact.bone)
        point = shown.heads[:, bone] + shown.rotations[:, bone] @ contact.offset
        touching = (shown.times > contact.start) & (shown.times < contact.end)
        off = (point - place)[touching]
        sunk = off * [1.0, 1.0, 0.0] + np.minimum(off, 0.0) * [0.0, 0.0, 1.0]
        held = max(held, float(np.linalg.norm(sunk, axis=1).max(initial=0.0)))
        above = max(above, float(off[:, 2].max(initial=0.0)))
    return Drift(held, above)
