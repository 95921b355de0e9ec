"""Reduced keys on a control rig's result, and what they leave of it as Blender plays them."""

from __future__ import annotations

import time

import bpy
import numpy as np

from ....bridge.armature import fcurves
from ....bridge.armature.incremental import complete
from ....bridge.armature.read import record
from ....bridge.controls.control_rig import ControlRig
from ....bridge.keys.events import events_of
from ....bridge.keys.written import KeyedAction, choose_keys
from ....bridge.recipe.keys import KeyOptions
from ....bridge.rows.choices import KeyChoice
from ....solver.numerics.rotations import rotation_vector
from ....solver.worker.pipeline import AdaptationResult
from ..controlled import KEYS_DEGREES, KEYS_OFF_MM, SparseKeys, worst_of


def sparse_keys(
    armature: bpy.types.Object, action: bpy.types.Action, answer: AdaptationResult, rig: ControlRig
) -> SparseKeys:
    """Reduce the keys of a result that an armature shows, and measure what is left."""
    track = answer.track
    before = record(armature, track.frames)
    asked = KeyOptions(KeyChoice.REDUCED, KEYS_OFF_MM / 1e3, float(np.radians(KEYS_DEGREES)))
    events = events_of(answer.schedule, float(track.frames[0]), answer.recording.rate)
    slot = fcurves.slot_identifier(armature)
    keyed = KeyedAction(action, slot, track.bones, track.frames, None, rig)
    began = time.perf_counter()
    report = complete(choose_keys(armature, keyed, asked, events))
    seconds = time.perf_counter() - began
    after = record(armature, track.frames)
    columns = [after.index(name) for name in track.bones]
    off = 1e3 * np.linalg.norm(after.heads[:, columns] - before.heads[:, columns], axis=2)
    apart = np.swapaxes(before.rotations, -1, -2)[:, columns] @ after.rotations[:, columns]
    turned = np.linalg.norm(rotation_vector(apart.reshape(-1, 3, 3)), axis=1).reshape(off.shape)
    return SparseKeys(
        report.rate,
        worst_of(off, track.bones, track.frames),
        worst_of(np.degrees(turned), track.bones, track.frames),
        seconds,
    )
