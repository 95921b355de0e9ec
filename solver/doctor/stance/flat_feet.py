"""Feet that stand flat: by their joints, for where contact points are hangs on the floor, and of
one that floats no height is known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.recording import Recording
from ...numerics.runs import runs
from ...skeleton.parts import SIDES, Part, Side
from ..figure import Figure

FLAT = 0.06  # m/s, by which both ends of a foot that stands flat differ
FLAT_SPEED = 0.3  # m/s, along the floor; a foot that is lifted or set down goes faster
FLAT_SPEED_UP = 0.45  # m/s, up or down; who falls is as slow for 0.09 s, which is no stance
STANDING_SPEED_UP = 0.15  # m/s, up or down, of a foot that stands, flat or not
LOW = 0.03  # m above the floor: a foot that stands
LEAST_STANCE = 0.1  # s
BELOW = 0.1  # m below a foot that stands, where a hand, or a knee that kneels, may be
# Of a foot's length, by which its ball may be above the ankle; of who lies on the back it is more.
HEEL_DOWN = 0.5
ROUNDS = 8  # of narrowing the speeds to the half that agree best


@dataclass(frozen=True)
class FlatFoot:
    """A foot's middle (T, 3), m, its velocities (T, 3), m/s, and where it is flat and slow (T,)."""

    track: FloatArray
    velocity: FloatArray
    flat: BoolArray

    def stances(self, rate: float) -> list[slice]:
        """Frames, of so many a second, in which it stands flat for long enough to tell."""
        least = max(LEAST_STANCE * rate, 2.0)
        return [slice(a, b + 1) for a, b in runs(self.flat) if b - a >= least]

    def stands(self, rate: float) -> BoolArray:
        """(T,) whether it is in one of these."""
        found = np.zeros(len(self.flat), bool)
        for stance in self.stances(rate):
            found[stance] = True
        return found


def flat_feet(recording: Recording, figure: Figure) -> Iterator[FlatFoot]:
    """The left one, then the right one. recording: in its right size and time."""
    for side in SIDES:
        ends = foot_ends(recording, figure, side)
        ankle, ball = (np.gradient(track, recording.times, axis=0) for track in ends)
        velocity = 0.5 * (ankle + ball)
        flat = np.linalg.norm(ankle - ball, axis=1) < FLAT
        flat &= np.linalg.norm(velocity[:, :2], axis=1) < FLAT_SPEED
        flat &= np.abs(velocity[:, 2]) < FLAT_SPEED_UP
        flat &= may_stand(recording, figure, side)
        yield FlatFoot(0.5 * (ends[0] + ends[1]), velocity, flat)


@dataclass(frozen=True)
class FlatSamples:
    """Of both feet while they neither turn nor go, N samples: s, in order, m and m/s."""

    times: FloatArray
    places: FloatArray
    velocities: FloatArray

    @staticmethod
    def of(recording: Recording, figure: Figure) -> FlatSamples:
        """recording: in its right size and time."""
        feet = list(flat_feet(recording, figure))
        times = np.concatenate([recording.times[foot.flat] for foot in feet])
        order = np.argsort(times, kind="stable")
        places, velocities = (
            np.concatenate([track[foot.flat] for foot, track in zip(feet, each, strict=True)])
            for each in ([f.track for f in feet], [f.velocity for f in feet])
        )
        return FlatSamples(times[order], places[order], velocities[order])


def foot_ends(recording: Recording, figure: Figure, side: Side) -> tuple[FloatArray, FloatArray]:
    """(T, 3) m each, of a foot's ankle and ball; of one without toes of its bone's end."""
    foot, toe = figure.sided[Part.FOOT, side], figure.sided.get((Part.TOE, side))
    ankle = recording.heads[:, foot]
    if toe is not None:
        return ankle, recording.heads[:, toe]
    bone = recording.bones[foot]
    return ankle, ankle + recording.rotations[:, foot] @ (bone.rotation.T @ (bone.tail - bone.head))


def may_stand(recording: Recording, figure: Figure, side: Side) -> BoolArray:
    """(T,) whether a foot's sole faces down and, the other leg aside, which may be on a lower step,
    nothing of the body is below it: of who stands on the hands, or lies, feet that are held still
    in the air stand on nothing. By the body alone, for what floats tells no height of a floor."""
    ankle, ball = foot_ends(recording, figure, side)
    foot = np.minimum(ankle[:, 2], ball[:, 2])
    legs = {(part, each) for part in (Part.SHANK, Part.FOOT, Part.TOE) for each in SIDES}
    aside = {figure.sided.get(key) for key in legs - {(Part.SHANK, side)}}
    others = [bone for bone in figure.bones if bone not in aside]
    stands = recording.heads[:, others, 2].min(axis=1) > foot - BELOW
    if (Part.TOE, side) in figure.sided:  # else the foot's end may be anywhere
        raised = ball[:, 2] - ankle[:, 2]
        stands &= raised < HEEL_DOWN * np.linalg.norm(ball - ankle, axis=1)
    return np.asarray(stands)


def agreed(speeds: FloatArray) -> tuple[FloatArray, float]:
    """The speed (D,), m/s, about which the half of some (N, D) that agree best are, and how far, in
    the median, all differ from it."""
    middle = np.median(speeds, axis=0)
    for _ in range(ROUNDS):
        apart = np.linalg.norm(speeds - middle, axis=1)
        nearest = np.argsort(apart, kind="stable")[: (len(speeds) + 1) // 2]
        middle = np.median(speeds[nearest], axis=0)
    return middle, float(np.median(np.linalg.norm(speeds - middle, axis=1)))
