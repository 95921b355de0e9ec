"""A take, a motion to be put into it, and its keys."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.stance_move import StanceMove
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs

LENGTH = 100
FIRST, LAST = 40, 60
BLEND = 8.0
MOVED = StanceMove("ground 2", (0.3, -0.2, 0.0), 0.4, (0.5, 0.2, 0.0))
OPTIONS = ResultOptions(blend_in=BLEND, blend_out=BLEND)
SHIFT = np.array([0.02, -0.01, 0.015])  # m, of the adapted frames off the take
TURN = axis_rotation(0, 0.03)
Table = dict[tuple[str, int], np.ndarray]


def take(mode: str = "QUATERNION", every: int = 1) -> bpy.types.Object:
    """A rig with a key on every so many frames."""
    armature = rigs.make_armature()
    rigs.animate(armature, mode, frames=range(1, LENGTH + 1, every))
    return armature


def adapted(recording: Recording, frames: int = LAST - FIRST + 1) -> PoseTrack:
    """The frames from FIRST on, a little beside the take and turning a little otherwise."""
    part = recording.window(FIRST, FIRST + frames - 1)
    bones = [recording.index(bone) for bone in rigs.MOVING]
    wave = 1.0 + 0.2 * np.sin(part.frames)[:, None]
    return PoseTrack(
        part.frames, rigs.MOVING, TURN @ part.rotations[:, bones], part.heads[:, 0] + wave * SHIFT
    )


def motion(recording: Recording, moved: StanceMove | None = None, **options: object):
    track = adapted(recording)
    if moved is not None:
        turn = axis_rotation(2, moved.turn)
        head = (track.root_head - moved.pivot) @ turn.T + moved.pivot + moved.shift
        share = np.clip((track.frames - FIRST - 5) / 10.0, 0.0, 1.0)[:, None]
        share = share**2 * (3.0 - 2.0 * share)
        turns = axis_rotation(2, moved.turn * share[:, 0])
        track = replace(
            track,
            rotations=turns[:, None] @ track.rotations,
            root_head=(1.0 - share) * track.root_head + share * head,
        )
    times = TimeMap((FIRST, LAST), (FIRST, LAST))
    return AdaptedMotion(track, times, moved, replace(OPTIONS, **options))


def keys_of(armature: bpy.types.Object) -> Table:
    """Frame, value and handles of every key, by channel."""
    tables = {(c.data_path, c.array_index): fcurves.table(c) for c in fcurves.curves_of(armature)}
    names = ("co", "handle_left", "handle_right", "interpolation")
    return {
        channel: np.hstack([table[name].astype(np.float32) for name in names])
        for channel, table in tables.items()
    }


def outside(keys: np.ndarray, first: float, last: float) -> bytes:
    at = keys[:, 0]
    return keys[(at <= first) | (at >= last)].tobytes()


def later(recording: Recording, **options: object) -> AdaptedMotion:
    """A motion of the frames that takes 3.4 frames more."""
    track = adapted(recording, LAST - FIRST + 4)
    times = TimeMap((FIRST, 50.0, LAST), (FIRST, 53.4, LAST + 3.4))
    return AdaptedMotion(track, times, None, replace(OPTIONS, **options))
