"""Placement of a limit's handles, from where ui/overlay draws it: numpy only; world.

A limit's angles count on a circle about its joint; its ends are points of that circle.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...bridge.shapes.limits import directions
from ...operators.drag.rays import Circle, Vector, scaled, unit
from ...solver.arrays import FloatArray
from ..overlay.geometry.limit_poses import Joints, LimitFrames
from ..overlay.geometry.limit_shapes import ARC, CONE, RING, TWIST, Limit

SIDEWAYS = 0.2  # sine of axis and view: below, one looks along the cone


@dataclass(frozen=True)
class Knob:
    """Of an end of a limit; end: the constraint's property.

    narrow: how much narrower than its half angle a stretched cone is there.
    """

    end: str
    at: Vector
    circle: Circle
    narrow: float = 1.0


@dataclass(frozen=True)
class Tip:
    """Of a cone's axis. turn: (3, 3) from directions in the world to the constraint's axis."""

    at: Vector
    centre: Vector
    turn: FloatArray


@dataclass(frozen=True)
class LimitHandlePlaces:
    """The handles of a limit."""

    knobs: tuple[Knob, ...] = ()
    tip: Tip | None = None


def handle_places(
    limit: Limit, joint: Joints, drawn: LimitFrames, armature: FloatArray, sight: Vector
) -> LimitHandlePlaces:
    """The handles of a limit.

    joint, drawn: of this one alone, in the armature's space. armature: (4, 4) its matrix in the
    world. sight: (3,) unit vector to the viewer, world.
    """
    scale = float(np.linalg.norm(armature[:3, 0]))
    if scale == 0.0:  # nothing of it is to be seen
        return LimitHandlePlaces()
    to_world = armature[:3, :3] / scale
    origin, axes = armature[:3, :3] @ drawn.origins[0] + armature[:3, 3], to_world @ drawn.axes[0]
    length = scale * limit.length
    if limit.kind == CONE:
        knob = _rim(limit, Circle(origin, axes[:, 0], axes[:, 1], length), axes, sight)
        turn = to_world @ joint.turns[0].T @ to_world.T
        return LimitHandlePlaces((knob,), Tip(_on(knob.circle, 0.0), origin, turn))
    radius = (RING if limit.kind == TWIST else ARC) * length
    return LimitHandlePlaces(tuple(_ends(limit, Circle(origin, axes[:, 0], axes[:, 1], radius))))


def _ends(limit: Limit, circle: Circle) -> Iterator[Knob]:
    for end, angle in (("lower", limit.lower), ("upper", limit.upper)):
        if angle is not None:
            yield Knob(end, _on(circle, angle), circle)


def _rim(limit: Limit, circle: Circle, axes: FloatArray, sight: Vector) -> Knob:
    """Of a cone, where its rim is seen from the side."""
    across = np.cross(circle.zero, sight)
    out = unit(across) if np.linalg.norm(across) > SIDEWAYS else circle.ahead
    wide, deep = limit.stretch
    narrow = float(np.hypot(out @ axes[:, 1] / wide, out @ axes[:, 2] / deep))
    turned = Circle(circle.centre, circle.zero, out, circle.radius)
    return Knob("half_angle", _on(turned, scaled(limit.upper or 0.0, 1.0 / narrow)), turned, narrow)


def _on(circle: Circle, angle: float) -> Vector:
    along, across, _ = directions(angle)
    return np.asarray(circle.centre + circle.radius * (along * circle.zero + across * circle.ahead))
