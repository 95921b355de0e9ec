"""The whole skeleton in an adapted motion, where the motion tells some bones and the pelvis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.recording import PoseTrack, Recording
from ..data.reports.jumps import TimeMap


def posed_recording(recording: Recording, track: PoseTrack, times: TimeMap) -> Recording:
    """The recording's figure at the track's frames, every bone of it.

    A bone that the track does not tell keeps what it had relative to its parent at the recording's
    instant that corresponds. times: where the recording's frames are in the motion. The whole
    figure moves so that the pelvis is where the track has it.
    """
    at = np.interp(track.frames, times.adapted_frame, times.recorded_frame)
    told = {bone: i for i, bone in enumerate(track.bones)}
    heads = np.empty((len(at), len(recording.bones), 3))
    rotations = np.empty((*heads.shape, 3))
    for b, bone in enumerate(recording.bones):
        own, place = _relative(recording, b, at)
        if bone.parent < 0:
            rotations[:, b], heads[:, b] = own, place
        else:
            up = rotations[:, bone.parent]
            rotations[:, b] = up @ own
            heads[:, b] = heads[:, bone.parent] + np.einsum("tij,tj->ti", up, place)
        if bone.name in told:
            rotations[:, b] = track.rotations[:, told[bone.name]]
    heads += (track.root_head - heads[:, recording.index(track.bones[0])])[:, None]
    seconds = (track.frames - track.frames[0]) / recording.rate
    return replace(recording, frames=track.frames, times=seconds, heads=heads, rotations=rotations)


def _relative(recording: Recording, b: int, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotation (T, 3, 3) and head (T, 3) of a bone in its parent's frame, at frames (T,)."""
    turned, place = recording.rotations[:, b], recording.heads[:, b]
    parent = recording.bones[b].parent
    if parent >= 0:
        up = np.swapaxes(recording.rotations[:, parent], 1, 2)
        place = np.einsum("tij,tj->ti", up, place - recording.heads[:, parent])
        turned = up @ turned
    return _proper(_between(turned, recording.frames, at)), _between(place, recording.frames, at)


def _between(values: FloatArray, frames: FloatArray, at: FloatArray) -> FloatArray:
    """Linear in between. values: (T, ...)."""
    columns = values.reshape(len(values), -1).T
    return np.stack([np.interp(at, frames, c) for c in columns], axis=1).reshape(
        len(at), *values.shape[1:]
    )


def _proper(matrices: FloatArray) -> FloatArray:
    """The nearest rotations (T, 3, 3)."""
    left, _, right = np.linalg.svd(matrices)
    return np.asarray(left @ right)
