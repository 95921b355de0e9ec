"""Damped least-squares inverse kinematics of gripping arms: initial guess of a hang (6.2, 6.3).

The held frame repeats a pose whose hands are elsewhere. Moving the whole body there would lift it
off its ballistic path; the arms alone are turned towards the grip, and eased in before it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.anatomy import Part
from ..body.character import Character
from ..body.kinematics import BodyPoint, forward_kinematics
from ..human.ranges import JointRange
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, dense_instants
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion

ARM = (Part.UPPER_ARM, Part.FOREARM, Part.HAND)
EASE_IN = 0.25  # s, before the grip
IK_ITERATIONS = 60  # at most
MAX_ANGLE_STEP = 0.1  # rad an iteration
IK_DAMPING = 1e-3  # m²
RANGE_LEVER = 0.3  # m/rad, a forearm: what a joint is beyond its range counts as what that moves
SETTLED = 2e-3  # rad, that no angle turns by any more: a guess needs no better


def reach_grips(motion: Motion, places: FloatArray, ranges: Sequence[JointRange]) -> Motion:
    """The motion with its gripping arms turned to reach places (n_contacts, 3) m, world; their
    joints in those of the ranges that are theirs."""
    t = motion.transcription
    grips = [
        (contact, place)
        for contact, place in zip(t.contacts, places, strict=True)
        if t.character.bodies[t.points[contact.point].body].part in ARM and contact.friction is None
    ]
    if not grips:
        return motion
    times = dense_instants(t.basis)
    angles = motion.angles(times)
    for contact, place in grips:
        arm = _Arm.of(t.character, t.points[contact.point], ranges)
        _turn_arm(motion, contact, arm, place, times, angles)
    x = motion.x.copy()
    x[:, t.layout.angles] = t.basis.project(times, angles, THIRD_DERIVATIVE_WEIGHT)
    return Motion(t, x, places)


def _turn_arm(
    motion: Motion,
    contact: PointContact,
    arm: "_Arm",
    place: FloatArray,
    times: FloatArray,
    angles: FloatArray,
) -> None:
    """Turns one arm in angles (T, n_angles) rad at times (T,) s; the pelvis stays in place.

    All instants start out turned as the first of the grip is: alone, some would end with the elbow
    on another side than those next to them.
    """
    start = contact.contact.start - EASE_IN
    during = np.flatnonzero((times >= start) & (times <= contact.contact.end))
    recorded = angles[during]
    centres = forward_kinematics(arm.character, recorded).centres
    pelvis = centres[:, 0] + motion.com(times[during])
    first = slice(k := int(np.searchsorted(times[during], contact.contact.start)), k + 1)
    turned = arm.reached(recorded[first], pelvis[first], place) - recorded[first]
    moved = arm.reached(recorded + turned, pelvis, place)
    share = np.clip((times[during] - start) / EASE_IN, 0.0, 1.0)[:, None]
    share = share**2 * (3.0 - 2.0 * share)
    angles[during] += share * (moved - recorded)


@dataclass(frozen=True)
class _Arm:
    """An arm that ends in a point. chain: indices of its joints' angles, from the shoulder to the
    point's body. ranges: of these joints."""

    character: Character
    point: BodyPoint
    chain: IntArray
    ranges: tuple[JointRange, ...]

    @staticmethod
    def of(character: Character, point: BodyPoint, ranges: Sequence[JointRange]) -> "_Arm":
        """ranges: of all joints."""
        above = {point.body, *character.ancestors(point.body)}
        bodies = [b for b in sorted(above) if character.bodies[b].part in ARM]
        joints = [character.joints[b] for b in bodies]
        chain = np.concatenate([np.arange(j.first, j.dofs.stop) for j in joints])
        return _Arm(character, point, chain, tuple(r for r in ranges if r.body in bodies))

    def reached(self, angles: FloatArray, pelvis: FloatArray, place: FloatArray) -> FloatArray:
        """Angles (T, n_angles) rad turned until the point is at a place (3,) m, or near it.

        Damped least squares, d = J'(J J' + damping I)^-1 e (Wampler 1986). A joint that is beyond
        its range has a row of its own: an elbow that folds the way that none does finds no way back
        in the solve. pelvis: (T, 3) m.
        """
        moved, left = angles.copy(), np.arange(len(angles))
        owner = self.character.body_of_angle[self.chain]
        for _ in range(IK_ITERATIONS):
            posed = forward_kinematics(self.character, moved[left])
            at = posed.points([self.point])
            off = place - (at[:, 0] - posed.centres[:, 0] + pelvis[left])
            columns = np.cross(posed.axes[:, self.chain], at - posed.centres[:, owner])
            beyond, turns = self._beyond(moved[left])
            off = np.concatenate([off, -RANGE_LEVER * beyond], axis=1)  # (T, 3 + R)
            columns = np.concatenate([columns, RANGE_LEVER * turns], axis=2)  # (T, n, 3 + R)
            square = np.swapaxes(columns, 1, 2) @ columns + IK_DAMPING * np.eye(off.shape[1])
            step = (columns @ np.linalg.solve(square, off[..., None]))[..., 0]
            largest = np.abs(step).max(axis=1)
            step *= np.minimum(1.0, MAX_ANGLE_STEP / np.maximum(largest, SETTLED))[:, None]
            moved[np.ix_(left, self.chain)] += step
            left = left[largest >= SETTLED]
            if not len(left):
                break
        return moved

    def _beyond(self, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far angles (T, n_angles) rad are beyond R ranges, signed, (T, R) rad; and its
        derivatives (T, n, R) by the arm's n angles, 0 within."""
        over = np.zeros((len(angles), len(self.ranges)))
        turns = np.zeros((len(angles), len(self.chain), len(self.ranges)))
        for i, each in enumerate(self.ranges):
            joint = each.measure.joint
            found = each.measure.of(joint.axes.rotation(angles[:, joint.dofs]))
            over[:, i] = found - np.clip(found, each.lower, each.upper)
            by = each.measure.by_angles(self.character, angles)[:, self.chain]
            turns[:, :, i] = np.where(over[:, i, None] != 0.0, by, 0.0)
        return over, turns
