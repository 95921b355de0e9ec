"""Bend, lean and twist angles of joints, and the axes in which they are measured: numpy only.

Everything is of N joints at once, in the armature's space; angles in rad.
"""

from dataclasses import dataclass

import numpy as np

from ....bridge.shapes.limits import directions
from ....bridge.shapes.vectors import across, cross, unit
from ....solver.arrays import FloatArray
from ....solver.body.human_limits import narrowing, off_axis

SURE = 0.7  # cosine up to which the bend that is seen may differ from the one expected
BENT = 0.15  # sine of the bend from which on its direction is seen


@dataclass(frozen=True)
class Joints:
    """heads: (N, 3). turns, owns: (N, 3, 3) the parents' and the bones', from rest to now.

    along: (N, 3) unit vectors along the bones at rest.
    """

    heads: FloatArray
    turns: FloatArray
    owns: FloatArray
    along: FloatArray

    @property
    def ahead(self) -> FloatArray:
        """(N, 3) unit vectors along the bones now."""
        return turned(self.owns, self.along)


@dataclass(frozen=True)
class LimitFrames:
    """Axes of limits and the angles measured in them: columns (N, 3, 3), origins (N, 3), now (N,).

    hands: (N, 3) unit vectors that show the angles, like a clock's hand. narrow: (N,) by what the
    tangent of a cone's half angle is divided the way that the bone leans.
    """

    axes: FloatArray
    origins: FloatArray
    now: FloatArray
    hands: FloatArray
    narrow: FloatArray


def turned(rotations: FloatArray, vectors: FloatArray) -> FloatArray:
    """(N, 3) vectors turned by (N, 3, 3)."""
    return np.asarray((rotations @ vectors[..., None])[..., 0])


def rotations(matrices: FloatArray) -> FloatArray:
    """(N, 3, 3) of matrices (N, 4, 4), without their scale."""
    linear = matrices[:, :3, :3]
    return np.asarray(linear / np.maximum(np.linalg.norm(linear, axis=1, keepdims=True), 1e-12))


def cones(joints: Joints, axis: FloatArray, side: FloatArray, stretch: FloatArray) -> LimitFrames:
    """Cones about axes (N, 3) in their parents' rest frames, and the angles off these.

    side: (N, 3) at right angles to them, along which the cones are stretch[:, 0] times as wide.
    """
    axes = _columns(turned(joints.turns, axis), turned(joints.turns, side))
    parts = turned(np.swapaxes(axes, 1, 2), joints.ahead)
    now, ways = off_axis(parts)
    return LimitFrames(axes, joints.heads, now, joints.ahead, narrowing(ways, stretch))


def bends(joints: Joints, straight: FloatArray, flexion: FloatArray) -> LimitFrames:
    """Bends from straight limbs (N, 3) towards flexion (N, 3), in the parents' rest frames.

    Where a flexion is not known (NaN), it is what is seen now.
    """
    ahead, zero = joints.ahead, turned(joints.turns, straight)
    bent = ahead - zero * (ahead * zero).sum(axis=1, keepdims=True)
    visible = np.linalg.norm(bent, axis=1, keepdims=True) > BENT
    shown = np.where(visible, unit(bent), across(zero))
    expected = turned(joints.turns, flexion)
    expected = unit(expected - zero * (expected * zero).sum(axis=1, keepdims=True))
    agreed = (shown * expected).sum(axis=1, keepdims=True)
    # what is seen now is free of the guess that the parent does not twist
    trusted = visible & (np.abs(agreed) > SURE)
    towards = np.where(trusted, shown * np.sign(agreed), expected)
    towards = np.where(np.isnan(expected), shown, towards)
    now = np.arctan2((ahead * towards).sum(axis=1), (ahead * zero).sum(axis=1))
    axes = _columns(zero, towards)
    hands = turned(axes, directions(now))
    return LimitFrames(axes, joints.heads, now, hands, np.ones(len(now)))


def twists(joints: Joints, at: FloatArray) -> LimitFrames:
    """Turns of bones about themselves against their parents (swing-twist decomposition).

    at: (N,) how far along the bones they are seen.
    """
    relative = np.swapaxes(joints.turns, 1, 2) @ joints.owns
    skew = relative - np.swapaxes(relative, 1, 2)
    about = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
    whole = 1.0 + np.trace(relative, axis1=1, axis2=2)
    now = 2.0 * np.arctan2((about * joints.along).sum(axis=1), whole)
    now = (now + np.pi) % (2.0 * np.pi) - np.pi
    one = across(joints.along)
    other = cross(joints.along, one)
    # turned by the twist, this is `one`: so it points to zero while the bone is twisted
    c, s = np.cos(now)[:, None], np.sin(now)[:, None]
    zero, quarter = c * one - s * other, s * one + c * other
    ahead = joints.ahead
    axes = np.stack([turned(joints.owns, zero), turned(joints.owns, quarter), ahead], axis=2)
    origins, hands = joints.heads + at[:, None] * ahead, turned(axes, directions(now))
    return LimitFrames(axes, origins, now, hands, np.ones(len(now)))


def _columns(one: FloatArray, two: FloatArray) -> FloatArray:
    return np.stack([one, two, cross(one, two)], axis=2)
