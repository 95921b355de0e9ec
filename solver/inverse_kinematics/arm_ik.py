"""Damped least-squares inverse kinematics of gripping arms: initial guess of a hang (6.2, 6.3).

The held frame repeats a pose whose hands are elsewhere. Moving the whole body there would lift it
off its ballistic path; the arms alone are turned towards the grip, and eased in before it.
"""

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.anatomy import Part
from ..body.kinematics import forward_kinematics
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, dense_instants
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion

ARM = (Part.UPPER_ARM, Part.FOREARM, Part.HAND)
EASE_IN = 0.25  # s, before the grip
IK_ITERATIONS = 60  # at most
MAX_ANGLE_STEP = 0.1  # rad an iteration
IK_DAMPING = 1e-3  # m²
SETTLED = 2e-3  # rad, that no angle turns by any more: a guess needs no better


def reach_grips(motion: Motion, places: FloatArray) -> Motion:
    """The motion with its gripping arms turned to reach places (n_contacts, 3) m, world."""
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
        _turn_arm(motion, contact, place, times, angles)
    x = motion.x.copy()
    x[:, t.layout.angles] = t.basis.project(times, angles, THIRD_DERIVATIVE_WEIGHT)
    return Motion(t, x, places)


def _turn_arm(
    motion: Motion, contact: PointContact, place: FloatArray, times: FloatArray, angles: FloatArray
) -> None:
    """Solves one arm's inverse kinematics into angles (T, n_angles) rad at times (T,) s.

    Damped least squares, d = J'(J J' + damping I)^-1 e (Wampler 1986); the pelvis stays in place.
    """
    t = motion.transcription
    character, point = t.character, t.points[contact.point]
    start = contact.contact.start - EASE_IN
    during = np.flatnonzero((times >= start) & (times <= contact.contact.end))
    moved = angles[during]
    pelvis = forward_kinematics(character, moved).centres[:, 0] + motion.com(times[during])
    chain = _chain(motion, point.body)
    owner, left = character.body_of_angle[chain], np.arange(len(during))
    for _ in range(IK_ITERATIONS):
        posed = forward_kinematics(character, moved[left])
        at = posed.points([point])
        off = place - (at[:, 0] - posed.centres[:, 0] + pelvis[left])
        columns = np.cross(posed.axes[:, chain], at - posed.centres[:, owner])  # (T, n, 3)
        square = np.swapaxes(columns, 1, 2) @ columns + IK_DAMPING * np.eye(3)
        turn = columns @ np.linalg.solve(square, off[..., None])
        step = np.clip(turn[..., 0], -MAX_ANGLE_STEP, MAX_ANGLE_STEP)
        moved[np.ix_(left, chain)] += step
        left = left[np.abs(step).max(axis=1) >= SETTLED]
        if not len(left):
            break
    share = np.clip((times[during] - start) / EASE_IN, 0.0, 1.0)[:, None]
    share = share**2 * (3.0 - 2.0 * share)
    angles[during] += share * (moved - angles[during])


def _chain(motion: Motion, body: int) -> IntArray:
    """Kinematic chain: indices of the angles of the joints from the shoulder to a body."""
    character = motion.transcription.character
    bodies = {body, *character.ancestors(body)}
    joints = [character.joints[b] for b in sorted(bodies) if character.bodies[b].part in ARM]
    return np.concatenate([np.arange(j.first, j.dofs.stop) for j in joints])
