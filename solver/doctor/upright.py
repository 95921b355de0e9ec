"""The axis along which a figure stands."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part
from ..data.recording import Recording
from ..numerics.rotations import shortest_rotation
from .figure import Figure
from .finding import Finding, FindingKind
from .repairs import Repairs, UpAxis

UPRIGHT = 0.8  # of the way from feet to head, along one axis
# Feet carry who walks in 0.8 of the time, who runs or hops in 0.2 to 0.5; along another axis the
# joint that is lowest goes with the body.
CARRIED, ELSEWHERE = 0.1, 0.5
GOES, KEEPS = 0.45, 0.3  # of the way from feet to head, a second: of the hips, and of what carries
LEAST_GOING, WITHIN = 0.3, 0.05  # s, in all, and on each side of a frame

_AXES = {axis: np.eye(3)["XYZ".index(axis.value[-1])] for axis in UpAxis}
_SIGNS = {axis: -1.0 if axis.value.startswith("-") else 1.0 for axis in UpAxis}


def find_up(recording: Recording, figure: Figure) -> Finding | None:
    """A figure that in most of the clip stands along another axis than Z, and at rest too, or by
    what carries it: of a turned object the motion alone may lie.

    Who lies or stands on the hands is upright at rest, and goes by what is lowest. Who hangs by the
    feet goes below them, too, but above the floor; of a turned object the body is below it.
    """
    feet, heads = figure.of(Part.FOOT), figure.of(Part.HEAD, Part.NECK)
    if not heads:
        return None
    moving = recording.heads[:, heads[0]] - recording.heads[:, feet].mean(axis=1)
    rest = [recording.bones[bone].head for bone in (heads[0], *feet)]
    way = np.median(moving, axis=0)
    up = _along(way)
    if up in (None, UpAxis.Z):
        return None
    if _along(rest[0] - np.mean(rest[1:], axis=0)) is not up:
        length = float(np.linalg.norm(way))
        along, lowest = (_carried(recording, figure, axis, length) for axis in (up, UpAxis.Z))
        hangs = up is UpAxis.MINUS_Z and np.median(recording.heads[:, heads[0], 2]) > 0.0
        if hangs or along < CARRIED or lowest > ELSEWHERE * along:
            return None
    return Finding(FindingKind.UP_AXIS, 90.0, "°", remedy=Repairs(up=up))


def _carried(recording: Recording, figure: Figure, up: UpAxis, length: float) -> float:
    """Share of the time in which the hips go, in which the joint that is lowest along an axis keeps
    its place: it carries the body. 0 where they hardly go. length: m, from feet to head."""
    reach = max(1, round(WITHIN * recording.rate))
    joints = recording.heads[:, figure.bones]
    ways = np.linalg.norm(joints[2 * reach :] - joints[: -2 * reach], axis=2)
    speeds = ways * recording.rate / (2 * reach * length)
    lowest = np.argmin(_SIGNS[up] * joints[reach:-reach] @ _AXES[up], axis=1)
    goes = speeds[:, 0] > GOES
    if goes.sum() < LEAST_GOING * recording.rate:
        return 0.0
    return float((speeds[np.arange(len(lowest)), lowest] < KEEPS)[goes].mean())


def _along(way: FloatArray) -> UpAxis | None:
    """The axis that a way (3,) follows, None where it is between two."""
    length = max(float(np.linalg.norm(way)), 1e-9)
    shares = {axis: _SIGNS[axis] * float(_AXES[axis] @ way) / length for axis in UpAxis}
    best = max(UpAxis, key=lambda axis: shares[axis])
    return best if shares[best] > UPRIGHT else None


def turn_upright(repairs: Repairs) -> FloatArray:
    """(3, 3) rotation that takes the axis that is up to Z, and then a floor that slopes to one that
    is level."""
    slopes = np.tan(np.radians(repairs.tilt))
    normal = np.append(-slopes, 1.0)
    level = shortest_rotation(normal / np.linalg.norm(normal), _AXES[UpAxis.Z])
    return np.asarray(level @ _turn_to_z(repairs.up))


def _turn_to_z(up: UpAxis) -> FloatArray:
    """(3, 3) rotation."""
    if up is UpAxis.MINUS_Z:
        return np.diag([1.0, -1.0, -1.0])
    return shortest_rotation(_SIGNS[up] * _AXES[up], _AXES[UpAxis.Z])
