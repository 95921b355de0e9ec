"""The soles: where on the foot bones the heel and the toe touch, and how high the floor lies."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..data.contacts import ContactPoint, PointKind

HEEL_BEHIND = 0.25  # of the level distance from ankle to ball; where the heel presses
TOE_AHEAD = 0.75  # of the way from ball to tip; where the toe leaves last
THICKEST_SOLE = 0.08  # m from the ball joint to the floor
USUAL_SOLE = 0.025  # m, where nothing tells
LEVEL_SPEED = 0.25  # m/s; a foot slower than this stands
PLATEAU = 0.02  # m; how much the height of a standing foot varies
FEWEST_FRAMES = 4


@dataclass(frozen=True)
class FootTracks:
    """One foot's joints over the clip, world, Z up.

    side: as in the points' names ("Left"). ankle, ball, tip: (T, 3) m; the heads of the foot bone
    and the toe bone, and the toe bone's tail. foot_rotation, toe_rotation: (T, 3, 3), bone to
    world. A rig without toes names its foot bone twice, with the foot's tail as ball and tip.
    """

    side: str
    foot_bone: str
    toe_bone: str
    ankle: FloatArray
    ball: FloatArray
    tip: FloatArray
    foot_rotation: FloatArray
    toe_rotation: FloatArray


def floor_height(times: FloatArray, feet: Sequence[FootTracks]) -> float:
    """Height of the floor, m, from where the balls of the feet stand lowest.

    The height 0 is taken where it can be the floor, since recordings are made upon it.
    """
    lowest = min(_standing(times, foot)[1] for foot in feet)
    return 0.0 if 0.0 < lowest <= THICKEST_SOLE else lowest - USUAL_SOLE


def foot_points(
    times: FloatArray, feet: Sequence[FootTracks], floor_m: float
) -> dict[str, ContactPoint]:
    """The heel and the toe of each foot: points of its sole that lie on the floor when it stands.

    times: (T,) s. floor_m: as from `floor_height`. Keys such as "Left heel", "Left toe".
    """
    points = {}
    for foot in feet:
        flat, _ = _standing(times, foot)
        ahead = _level(foot.ball - foot.ankle)
        heel = _on_floor(foot.ankle - HEEL_BEHIND * ahead, floor_m)
        toe = _on_floor(foot.ball + TOE_AHEAD * _level(foot.tip - foot.ball), floor_m)
        toe_head = foot.ankle if foot.toe_bone == foot.foot_bone else foot.ball
        points[f"{foot.side} heel"] = _fixed_in(
            PointKind.HEEL, foot.foot_bone, foot.ankle, foot.foot_rotation, heel, flat
        )
        points[f"{foot.side} toe"] = _fixed_in(
            PointKind.TOE, foot.toe_bone, toe_head, foot.toe_rotation, toe, flat
        )
    return points


def _standing(times: FloatArray, foot: FootTracks) -> tuple[NDArray[np.bool_], float]:
    """The frames in which the foot stands flat, (T,), and the ball's height there, m.

    A runner's foot never quite stands: then the slowest and lowest frames are taken.
    """
    ankle, ball = foot.ankle[:, 2], foot.ball[:, 2]
    speed = _speed(times, foot.ankle) + _speed(times, foot.ball)
    flat = speed < 2 * LEVEL_SPEED
    for height in (ball, ankle):
        if flat.any():
            flat &= height < np.percentile(height[flat], 20) + PLATEAU
    if flat.sum() < FEWEST_FRAMES:
        flat = np.zeros(len(times), dtype=np.bool_)
        flat[np.argsort(speed + (ankle + ball) / 0.1)[:FEWEST_FRAMES]] = True
    return flat, float(np.median(ball[flat]))


def _speed(times: FloatArray, track: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(np.gradient(track, times, axis=0), axis=1))


def _level(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors * np.array([1.0, 1.0, 0.0]))


def _on_floor(points: FloatArray, floor_m: float) -> FloatArray:
    return np.asarray(_level(points) + np.array([0.0, 0.0, floor_m]))


def _fixed_in(
    kind: PointKind,
    bone: str,
    head: FloatArray,
    rotation: FloatArray,
    seen: FloatArray,
    flat: NDArray[np.bool_],
) -> ContactPoint:
    """The point of the bone that lies nearest to `seen` (T, 3) over the frames `flat`."""
    local = np.einsum("tji,tj->ti", rotation[flat], (seen - head)[flat])
    offset = np.median(local, axis=0)
    return ContactPoint(kind, bone, offset, head + rotation @ offset)
