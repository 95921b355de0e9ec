"""Hips whose way along the floor was left out, as exports “in place” have it, or that stay where
they are above a treadmill's belt: the feet that carry slide backwards below them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...analysis.performance import Performance, contact_points, perform
from ...arrays import BoolArray, FloatArray
from ...body.character import build_character
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.runs import runs
from ...scene.belt import MIN_SPEED, STEADY, belt_speed
from ..falls import in_the_air
from ..finding import Finding, FindingKind
from ..local_poses import spans
from ..repairs import Repairs
from .flat_feet import agreed
from .footing import DRIFT, LEAST_STANDING, LowestPoint, standing

KEPT = 0.005  # m along the way, by which hips that keep their place leave it; nobody's stay so
KEPT_SHARE = 0.1  # of the way that the feet tell: hips above a belt go to and fro by less
LEAST_WAY = 0.3  # m that the feet tell
BESIDE = 0.02  # s, of what stands before and after a flight: further off it pushes, or is braked
STEP = 0.2  # s; from one place in which a foot slides to the next, told as one


def find_in_place(performance: Performance) -> Finding | None:
    """Feet that go a way while they stand of which the hips go nothing, or, where the feet slide at
    one steady speed, next to nothing. That speed is the remedy, or else the way of the feet.

    performance: as seen from what it stands on, in its right size and time.
    """
    stood = standing(performance)
    if len(stood.times) < LEAST_STANDING:
        return None
    way = _way_of_the_ground(performance, stood)[-1]
    far = float(np.linalg.norm(way))
    if far < LEAST_WAY:
        return None
    left = float(np.ptp(performance.centres[:, 0, :2] @ (way / far)))
    middle, differ = agreed(stood.velocities[:, :2])
    speed = float(np.linalg.norm(middle))
    # What flies low seems to stand where heights are reckoned, but most that stands does so.
    mostly = speed > MIN_SPEED and differ < STEADY * speed
    by_toes = belt_speed(performance.times, contact_points(performance)[0]) is not None
    steady = by_toes or mostly
    speeds = np.linalg.norm(stood.velocities[:, :2], axis=1)
    slides = speeds > DRIFT
    if left > max(KEPT, KEPT_SHARE * far if steady else 0.0) or not slides.any():
        return None
    x, y = (np.median(stood.velocities[:, :2], axis=0) if by_toes else middle).tolist()
    remedy = Repairs(drift=(x, y)) if steady else Repairs(mend=(Mend.IN_PLACE,))
    sliding = np.isin(performance.times, stood.times[slides])
    places = spans(performance.recording, _joined(sliding, performance.recording.rate))
    return Finding(
        FindingKind.IN_PLACE, float(np.median(speeds[slides])), "m/s", places, remedy=remedy
    )


def _joined(sliding: BoolArray, rate: float) -> BoolArray:
    """(T,) where feet slide, and in between from a step to the next. rate: frames a second."""
    joined = sliding.copy()
    for first, last in runs(~sliding):
        if first > 0 and last < len(sliding) - 1 and last - first < STEP * rate:
            joined[first : last + 1] = True
    return joined


def with_its_way(recording: Recording, chosen: Mapping[str, str] | None) -> Recording:
    """With the way along the floor that keeps what stands in its place. recording: in its right
    size and time. chosen: bones by parts of the body. Raises MissingPart."""
    performance = perform(recording, build_character(recording, chosen=chosen))
    stood = standing(performance)
    if len(stood.times) < LEAST_STANDING:
        return recording
    way = np.pad(_way_of_the_ground(performance, stood), ((0, 0), (0, 1)))
    return replace(recording, heads=recording.heads - way[:, None])


def _way_of_the_ground(performance: Performance, stood: LowestPoint) -> FloatArray:
    """(T, 2) m, along the floor, by the velocities of what stands. In a flight the body goes on at
    one velocity, the mean of those before and after, in a run as true as feet tell: a foot still
    slides forwards as it leaves, and the body is braked as it lands."""
    times = performance.times
    moving = np.gradient(performance.com[:, :2], times, axis=0)
    stands = np.searchsorted(times, stood.times)
    at, going = times[stands], moving[stands] - stood.velocities[:, :2]
    steadily: list[FloatArray] = []
    for first, last in runs(in_the_air(performance)):
        before, after = np.searchsorted(stands, [first, last])
        if 0 < before == after < len(stands):
            leaves, lands = stood.times[before - 1], stood.times[after]
            leaving = (stood.times <= leaves) & (stood.times > leaves - BESIDE)
            landing = (stood.times >= lands) & (stood.times < lands + BESIDE)
            steady = 0.5 * (going[leaving].mean(axis=0) + going[landing].mean(axis=0))
            ends = 0.5 * (times[first] + leaves), 0.5 * (times[last] + lands)
            at, steadily = np.append(at, ends), [*steadily, steady, steady]
    order, going = np.argsort(at, kind="stable"), np.vstack([going, *steadily])
    body = [np.interp(times, at[order], going[order, axis]) for axis in (0, 1)]
    over = moving - np.transpose(body)
    steps = 0.5 * (over[1:] + over[:-1]) * np.diff(times)[:, None]
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
