"""When the forces under a foot begin and end, told by what they do to the foot and the leg.

Heights alone err by 20 ms and more, since shoes give, heels roll and toes point. The centre of mass
tells less: beside force plates its acceleration leaves -g up to 20 ms late where heels strike (the
shank takes the first blow alone), and up to 20 ms early where one lands on toes. The constants were
set on three drop jumps, a walk and a run at 2 m/s with measured forces.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Contact
from .point_movement import acceleration, rate

IMPACT_MIDDLE, IMPACT_REACH = -0.01, 0.035  # s from the landing by height; where it is sought
IMPACT_DELAY = 0.008  # s from the force's beginning to the foot's greatest acceleration
MIN_IMPACT = 20.0  # m/s²; a walker's heel strike has 25 to 40, landings from a jump 80 to 300
MIN_PUSH_SPEED = 0.4  # m/s; a leg that lengthens more slowly no longer pushes
PUSH_REACH = 0.08  # s between that and the lift-off by height
OTHER_END = {"heel": "toe", "toe": "heel"}


def timed_by_forces(
    clock: FloatArray,
    touches: Sequence[Contact],
    heights: Mapping[str, FloatArray],
    legs: Mapping[str, FloatArray],
    frame_time: float,
) -> list[Contact]:
    """The touches; where one lands or lifts a whole foot, its force says when.

    clock: (N,) s. heights: (N,) m, and legs: (N,) m from the hip, of points by name. frame_time: s,
    of the recording. Where the body leaves with a foot, its force ends with the leg's push, or when
    it is up, whichever comes first.
    """
    timed = []
    for touch in touches:
        ends = (touch.point, other_end(touch.point))
        foot = [t for t in touches if t.point in ends and t is not touch]
        others = [t for t in touches if t.point not in ends]
        start, end = touch.start, touch.end
        stood = max((t.end for t in foot if t.start < start), default=float(clock[0]))
        stands = min((t.start for t in foot if t.end > end), default=float(clock[-1]))
        if ends[1] in heights and stood < start:
            turning = acceleration(heights[ends[0]] - heights[ends[1]], frame_time)
            start = max(_impact(clock, turning, start), stood)
        if touch.point in legs and end < stands:
            pushed = _end_of_push(clock, legs[touch.point], end)
            stays = any(t.start < pushed and t.end > pushed + PUSH_REACH for t in others)
            end = end if stays else min(pushed, end)
        timed.append(replace(touch, start=start, end=end) if start < end else touch)
    return timed


def other_end(point: str) -> str:
    """Name of the point at the other end of the same foot; for hands, of nothing."""
    side, _, end = point.rpartition(" ")
    return f"{side} {OTHER_END.get(end)}"


def _impact(clock: FloatArray, turning: FloatArray, landing: float) -> float:
    """When the force on the end of a foot that lands first begins, s.

    It turns the foot, so that this end accelerates upwards from the other one, by `turning` (N,)
    m/s². landing: the same instant by its height, s; kept where nothing stands out.
    """
    sought = np.flatnonzero(np.abs(clock - landing - IMPACT_MIDDLE) <= IMPACT_REACH)
    peak = int(sought[np.argmax(turning[sought])])
    if turning[peak] < MIN_IMPACT or peak in (sought[0], sought[-1]):
        return landing
    before, at, after = turning[peak - 1 : peak + 2]
    aside = 0.5 * (before - after) / (before - 2.0 * at + after)  # of the parabola's top
    return float(clock[peak] + aside * (clock[1] - clock[0])) - IMPACT_DELAY


def _end_of_push(clock: FloatArray, leg: FloatArray, lifting: float) -> float:
    """When a leg, (N,) m from hip to foot, no longer pushes because it no longer lengthens, s.

    lifting: when its foot lifts, by height, s; the answer where the leg does not tell.
    """
    speed = rate(leg)
    ends = np.flatnonzero((speed[:-1] > MIN_PUSH_SPEED) & (speed[1:] <= MIN_PUSH_SPEED))
    ends = ends[np.abs(clock[ends] - lifting) < PUSH_REACH]
    if len(ends) == 0:
        return lifting
    last = int(ends[np.argmin(np.abs(clock[ends] - lifting))])
    pair = slice(last, last + 2)
    return float(np.interp(-MIN_PUSH_SPEED, -speed[pair], clock[pair]))
