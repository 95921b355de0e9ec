"""Controls posed such that the bodies of a rig follow a track."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ..armature.channels import proper
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import Poses
from .added import with_added
from .control_rig import ControlRig
from .inverse import Inverse, Inverted
from .posing import Posing
from .targets import Targets, targets_of


@dataclass(frozen=True)
class ControlPoses:
    """Pose bases (T, 4, 4) by control; what is left by frame and body (T, B), m and rad.

    rig: whose controls they are, with those that were added to it.
    """

    rig: ControlRig
    bases: dict[str, FloatArray]
    bodies: tuple[str, ...]
    off: FloatArray
    turned: FloatArray
    tries: int = 0


def control_poses(
    rig: ControlRig,
    poses: Poses,
    track: PoseTrack,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlPoses]:
    """Controls such that the bodies follow a track. poses: the rig's at the track's frames, as
    `showing` lets it perform them.

    Where those that the motion needs leave more than may be, others are added.
    """
    wanted = targets_of(rig.armature, poses, track)
    solved, tries = yield from _solved(rig, wanted, None, showing)
    more = yield from with_added(rig, wanted.frames, solved, showing)
    if more is not rig:
        starts = _starts(rig, more, solved)
        solved, again = yield from _solved(more, wanted, starts, showing)
        rig, tries = more, tries + again
    bases = np.stack([each.bases for each in solved])
    return ControlPoses(
        rig,
        {name: bases[:, c] for c, name in enumerate(rig.controls)},
        rig.bodies,
        np.stack([each.off for each in solved]),
        np.stack([each.turned for each in solved]),
        tries,
    )


def _solved(
    rig: ControlRig,
    wanted: Targets,
    starts: FloatArray | None,
    showing: Callable[[], AbstractContextManager[object]],
) -> Incremental[tuple[list[Inverted], int]]:
    """All frames, and how often the rig was tried. starts: (T, C, 7) offsets to begin with."""
    posing = rig.posing
    inverse = Inverse(posing, rig.responses, wanted, starts)
    index = {float(frame): t for t, frame in enumerate(wanted.frames)}

    def look(frames: FloatArray) -> list[Inverted]:
        with posing.kept():
            return [inverse.solve(index[float(frame)]) for frame in frames]

    parts = yield from in_slices(wanted.frames, look, showing)
    return [each for part in parts for each in part], inverse.tries


def _starts(rig: ControlRig, more: ControlRig, solved: list[Inverted]) -> FloatArray:
    """(T, C, 7) what was solved, for a rig with more controls."""
    starts = np.zeros((len(solved), len(more.controls), 7))
    starts[:, [more.controls.index(name) for name in rig.controls]] = [s.offsets for s in solved]
    return starts


def carried_controls(
    rig: ControlRig,
    poses: Poses,
    track: PoseTrack,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[dict[str, FloatArray]]:
    """Pose bases (T, 4, 4) of the carriers that take the whole figure along with its pelvis.

    track: of the pelvis alone. poses: the rig's, at the track's frames.
    """
    names = list(rig.carriers)
    posing = Posing(rig.armature, names, track.bones[:1])
    index = {float(frame): t for t, frame in enumerate(track.frames)}
    wanted = targets_of(rig.armature, poses, track)

    def look(frames: FloatArray) -> list[FloatArray]:
        with posing.kept():
            return [at(float(frame)) for frame in frames]

    def at(frame: float) -> FloatArray:
        t = index[frame]
        posing.go_to(frame)
        posed = posing.look()
        goal = posed.bodies[0].copy()
        turn = wanted.rotations[t, 0] @ proper(posed.bodies[0, :3, :3]).T
        goal[:3, :3] = turn @ posed.bodies[0, :3, :3]
        goal[:3, 3] = wanted.heads[t, 0]
        move = goal @ np.linalg.inv(posed.bodies[0])
        return np.asarray(np.linalg.solve(posed.frames, move @ posed.controls))

    parts = yield from in_slices(track.frames, look, showing)
    bases = np.stack([each for part in parts for each in part])
    return {name: bases[:, c] for c, name in enumerate(names)}
