"""A cycle that every bone of a figure swings once in, as a solver would give it."""

from __future__ import annotations

import bpy
import numpy as np
from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import record
from hangtime.bridge.loops.write_loop import Loop, WrittenLoop, write_loop
from hangtime.bridge.rows.choices import LoopRoot
from hangtime.solver.data.recording import PoseTrack
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(3.0, 24.0)
TRAVEL = np.array([0.4, 2.0, 0.0])


def cycle(armature: bpy.types.Object) -> PoseTrack:
    """Every bone swings once, and the pelvis sways as it goes."""
    phase = np.linspace(0.0, 1.0, len(FRAMES))
    about = 2.0 * np.pi * phase
    rest = record(armature, FRAMES[:1])
    turned = []
    for i, bone in enumerate(rigs.MOVING):
        amplitudes = np.array([[0.3, 0.1 * i, -0.2], [0.1, 0.3, 0.05 * i]])
        swings = np.sin(about)[:, None] * amplitudes[0] + np.cos(about)[:, None] * amplitudes[1]
        turns = np.array([rigs.turn_by(swing) for swing in swings])
        turned.append(turns @ rest.rotations[0, rest.index(bone)])
    sway = 0.05 * np.stack([np.sin(about), np.cos(about), np.cos(2.0 * about)], axis=1)
    head = np.array([0.5, 0.2, 1.1]) + phase[:, None] * TRAVEL + sway
    return PoseTrack(FRAMES, rigs.MOVING, np.stack(turned, axis=1), head)


def looped(armature: bpy.types.Object, root: LoopRoot) -> tuple[PoseTrack, WrittenLoop]:
    """The cycle, written and shown."""
    track = cycle(armature)
    take, slot = current_action(armature), fcurves.slot_identifier(armature)
    assert take is not None
    loop = Loop.of(armature, track, root)
    action, written = complete(write_loop(armature, loop, take, slot, name="Loop"))
    fcurves.assign(armature, action, slot)
    assert action.use_cyclic
    assert tuple(action.frame_range) == (FRAMES[0], FRAMES[-1])
    return track, written
