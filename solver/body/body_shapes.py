"""Inertia of a stretched rigid body, and of one with a ball joined to it."""

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..numerics.rotations import rotation_matrix, unit
from .character import MIN_BOX_LENGTH, Body
from .joint_choice import MIN_BONE_LENGTH
from .mass_tables import BODY_DENSITY

PARALLEL_SINE = 1e-9  # directions of a smaller sine are parallel


def stretched(body: Body, tip: FloatArray) -> Body:
    """The body with its far end at `tip` (3,) m: as heavy, as thick, stretched along its box.

    The second moment of mass about the centre, (tr(I) / 2) 1 - I, is stretched as the mass is:
    a uniform box stays one, published radii of gyration keep their share of the length along the
    limb and their metres across it.
    """
    if np.array_equal(tip, body.tip):
        return body
    before, after = (max(float(np.linalg.norm(end)), MIN_BOX_LENGTH) for end in (body.tip, tip))
    length = body.box_rotation[:, 2]
    turn = _rotation_between(body.tip, tip)
    stretch = turn @ (np.eye(3) + (after / before - 1.0) * np.outer(length, length))
    spread = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    spread = stretch @ spread @ stretch.T
    return replace(
        body,
        com=stretch @ body.com,
        inertia=np.trace(spread) * np.eye(3) - spread,
        tip=tip,
        box_size=body.box_size * np.array([1.0, 1.0, after / before]),
        box_rotation=turn @ body.box_rotation,
        box_centre=stretch @ body.box_centre,
    )


def _rotation_between(one: FloatArray, other: FloatArray) -> FloatArray:
    """(3, 3) minimal rotation from one direction (3,) to another."""
    if min(np.linalg.norm(one), np.linalg.norm(other)) < MIN_BONE_LENGTH:
        return np.eye(3)
    axis = np.cross(unit(one), unit(other))
    sine = float(np.linalg.norm(axis))
    if sine < PARALLEL_SINE:
        return np.eye(3)
    return rotation_matrix(axis / sine * np.arctan2(sine, unit(one) @ unit(other)))


def with_ball(body: Body, mass: float, place: FloatArray) -> Body:
    """A body with a uniform ball of `mass` kg and BODY_DENSITY fixed at (3,) m in its frame.

    Inertia about the common centre of mass by the parallel axis theorem.
    """
    radius = (3.0 * mass / (4.0 * np.pi * BODY_DENSITY)) ** (1.0 / 3.0)
    ball = 0.4 * mass * radius**2 * np.eye(3)
    together = body.mass + mass
    com = (body.mass * body.com + mass * place) / together
    inertia = (
        body.inertia + _steiner(body.mass, body.com - com) + ball + _steiner(mass, place - com)
    )
    return replace(body, mass=together, com=com, inertia=inertia)


def _steiner(mass: float, arm: FloatArray) -> FloatArray:
    """(3, 3) Steiner term of the parallel axis theorem, kg·m²: mass in kg, arm (3,) m."""
    return np.asarray(mass * (arm @ arm * np.eye(3) - np.outer(arm, arm)))
