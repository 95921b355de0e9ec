"""A take moved and turned with a stance, for good or until it is back where it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.data.recording import PoseTrack
from ....solver.data.stance_move import StanceMove
from ....solver.numerics.rotations import axis_rotation

_STANDS = 0.2  # m/s, of a foot in the take; noise moves those that stand by as much
_STANDING = 0.02  # of the mean speed, which the way back also has while something stands


def carried(take: PoseTrack, move: StanceMove, shares: FloatArray) -> PoseTrack:
    """The take with shares (T,) of a stance's move, rigidly."""
    turns = axis_rotation(2, move.turn * shares)
    pivot, shift = np.array(move.pivot), np.array(move.shift)
    place = np.einsum("tij,tj->ti", turns, take.root_head - pivot) + pivot
    return replace(
        take,
        rotations=turns[:, None] @ take.rotations,
        root_head=place + shares[:, None] * shift,
    )


def slid(places: FloatArray, move: StanceMove, shares: FloatArray) -> float:
    """How far shares (T,) of a move, as they change, take along what travels least, beyond what it
    travels by itself; m. places: (T, B, 3) of bodies in the take, m.

    That is how far standing feet slide on the way back.
    """
    travels = np.linalg.norm(np.diff(places[..., :2], axis=0), axis=2)
    least = travels.argmin(axis=1)
    at = places[1:][np.arange(len(least)), least] - move.pivot
    before, now = (
        np.einsum("tij,tj->ti", axis_rotation(2, move.turn * each), at)
        + each[:, None] * np.array(move.shift)
        for each in (shares[:-1], shares[1:])
    )
    steps = np.linalg.norm((now - before)[:, :2], axis=1)
    return float(np.maximum(steps - travels.min(axis=1), 0.0).sum())


def carried_points(points: FloatArray, move: StanceMove | None) -> FloatArray:
    """Points (..., 3) m with a stance's move; as they are without one."""
    if move is None:
        return points
    turned = (points - move.pivot) @ axis_rotation(2, move.turn).T
    return np.asarray(turned + move.pivot + move.shift)


def slid_in_blend(take: FloatArray, shown: FloatArray, seconds: float) -> FloatArray:
    """(B,) m, how far bodies go along the floor beside the take while they stand in that.

    take, shown: (T, B, 3) m at the blend's frames, which are so many seconds apart.
    """
    stand = np.linalg.norm(np.diff(take, axis=0), axis=2) < _STANDS * seconds
    beside = np.linalg.norm(np.diff((shown - take)[..., :2], axis=0), axis=2)
    return np.asarray(np.where(stand, beside, 0.0).sum(axis=0))


def shares_of_return(
    frames: FloatArray, places: FloatArray, first: float, last: float
) -> FloatArray:
    """Shares (T,) of a move at a take's frames: all at `first`, none from `last` on.

    places: (T, B, 3) of bodies in the take. The way back is made where all of them travel, that is
    in flight, or as a foot rolls: as fast as the slowest does, for a foot that stands would slide.
    Its speed is zero at both ends.
    """
    within = (frames >= first) & (frames <= last)
    speeds = np.linalg.norm(np.gradient(places[..., :2], frames, axis=0), axis=2)
    window = np.sin(np.pi * np.clip((frames - first) / (last - first), 0.0, 1.0)) ** 2
    pace = window * (speeds.min(axis=1) + _STANDING * speeds[within].mean() + 1e-9)
    steps = 0.5 * (pace[1:] + pace[:-1]) * np.diff(frames)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    shares = 1.0 - way / way[-1]
    return np.where(frames <= first, 1.0, np.where(frames >= last, 0.0, shares))
