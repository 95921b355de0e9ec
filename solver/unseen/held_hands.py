"""Hands that hold on to something: who hangs from it has them in one place, above the head."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..numerics.local_regression import derivative
from ..numerics.runs import runs

SLOW = 0.15  # m/s; faster is a hand that moves on
ONE_PLACE = 0.05  # m from its median place; fists shift and turn about what they hold
LASTS = 0.5  # s; a hand that turns back in the air is slow for 0.1


@dataclass(frozen=True)
class HandTracks:
    """(T, 3) m, world, of a hand's joint, its middle, and the joints of the head and the pelvis."""

    joint: FloatArray
    middle: FloatArray
    head: FloatArray
    pelvis: FloatArray


@dataclass(frozen=True)
class Grasp:
    """First and last frame (index) in which a hand holds on. by_joint: whether its joint stays in
    one place better than its middle, about which it then turns."""

    first: int
    last: int
    by_joint: bool


def holds(times: FloatArray, hand: HandTracks, width: float) -> list[Grasp]:
    """When a hand keeps one place while the body hangs below it: the head, and below that the
    pelvis. times: (T,) s. width: s, of smoothing."""
    tracks = hand.middle, hand.joint
    speeds = [np.linalg.norm(derivative(times, each, times, width, 1), axis=1) for each in tracks]
    found = []
    for first, last in runs(np.min(speeds, axis=0) < SLOW):
        during = slice(first, last + 1)
        heights = [t[during, 2].mean() for t in (hand.joint, hand.head, hand.pelvis)]
        if times[last] - times[first] < LASTS or heights != sorted(heights, reverse=True):
            continue
        away = [np.linalg.norm(t - np.median(t[during], axis=0), axis=1) for t in tracks]
        by_joint = bool(away[1][during].max() < away[0][during].max())
        for a, b in runs(away[by_joint] < ONE_PLACE):  # smoothed, a hand seems to let go earlier
            if a <= first and b >= last:
                found.append(Grasp(a, b, by_joint))
    return found
