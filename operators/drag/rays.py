"""Ray casting: intersections with planes, lines and circles. Numpy only; (3,) vectors.

Lengths in whatever unit the rays are in, angles in rad.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, inf, sin, tau

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vector = NDArray[np.float64]

GRAZING = 0.03  # sine of ray and plane: below, a pixel is metres
EDGE_ON = 0.15  # below, a circle is turned by its near or far side instead
PARALLEL = 1e-6


@dataclass(frozen=True)
class Ray:
    """From the viewer through the mouse; along is a unit vector."""

    origin: Vector
    along: Vector

    @staticmethod
    def of(origin: ArrayLike, along: ArrayLike) -> Ray:
        return Ray(np.asarray(origin, dtype=float), unit(along))

    def nearest(self, point: ArrayLike) -> Vector:
        """The ray's point nearest to another."""
        way = np.asarray(point, dtype=float) - self.origin
        return np.asarray(self.origin + (way @ self.along) * self.along)


@dataclass(frozen=True)
class Circle:
    """Angles count from `zero` towards `ahead`, unit vectors at right angles."""

    centre: Vector
    zero: Vector
    ahead: Vector
    radius: float

    @property
    def normal(self) -> Vector:
        return np.cross(self.zero, self.ahead)

    def angle(self, towards: Vector) -> float:
        """Of a direction."""
        return atan2(float(towards @ self.ahead), float(towards @ self.zero))


def on_plane(ray: Ray, point: ArrayLike, normal: ArrayLike, farthest: float = inf) -> Vector | None:
    """Intersection of a ray with a plane through a point.

    None where it only grazes it, or not in front of the viewer, or more than `farthest` times as
    far away as the point is: towards the horizon a pixel is metres.
    """
    n = unit(normal)
    slope = float(ray.along @ n)
    if abs(slope) < GRAZING:
        return None
    way = np.asarray(point, dtype=float) - ray.origin
    distance = float(way @ n) / slope
    if not 0.0 < distance <= farthest * float(np.linalg.norm(way)):
        return None
    return ray.origin + distance * ray.along


def along_line(ray: Ray, point: ArrayLike, axis: ArrayLike) -> float | None:
    """Distance from a point along an axis (unit vector) to the ray's closest approach; None if
    parallel."""
    a, p = np.asarray(axis, dtype=float), np.asarray(point, dtype=float)
    dot = float(a @ ray.along)
    if 1.0 - dot * dot < PARALLEL:
        return None
    way = ray.origin - p
    return float(way @ a - dot * (way @ ray.along)) / (1.0 - dot * dot)


def angle_about(ray: Ray, circle: Circle, last: float) -> float:
    """The angle on a circle that a ray points at, as near to the last one as whole turns allow."""
    if abs(float(ray.along @ circle.normal)) > EDGE_ON:
        hit = on_plane(ray, circle.centre, circle.normal)
        if hit is not None:
            return unwrapped(circle.angle(hit - circle.centre), last)
    return _edge_on(ray, circle, last)


def _edge_on(ray: Ray, circle: Circle, last: float) -> float:
    """Left and right turn the side of the circle that the last angle is on."""
    side = unit(np.cross(circle.normal, ray.along))
    front = np.cross(side, circle.normal)
    x = float(ray.nearest(circle.centre) @ side - circle.centre @ side) / circle.radius
    x = min(max(x, -1.0), 1.0)
    depth = np.sqrt(1.0 - x * x)
    both = (circle.angle(x * side + way * depth * front) for way in (1.0, -1.0))
    return min((unwrapped(a, last) for a in both), key=lambda angle: abs(angle - last))


def unwrapped(angle: float, last: float) -> float:
    """The same angle, within half a turn of another."""
    return angle + tau * round((last - angle) / tau)


def scaled(angle: float, by: float) -> float:
    """The angle whose tangent is `by` times as large, in the same turn."""
    return unwrapped(atan2(by * sin(angle), cos(angle)), angle)


def unit(vector: ArrayLike) -> Vector:
    """A vector of length 1; one without a length stays."""
    v = np.asarray(vector, dtype=float)
    return np.asarray(v / max(float(np.linalg.norm(v)), 1e-12))


def rounded(direction: Vector, step: float) -> Vector:
    """The nearest direction whose height and compass angle are whole steps."""
    height = np.arcsin(np.clip(unit(direction)[2], -1.0, 1.0))
    compass = atan2(direction[1], direction[0])
    height, compass = (step * round(each / step) for each in (height, compass))
    flat = np.cos(height)
    return np.array([flat * np.cos(compass), flat * np.sin(compass), np.sin(height)])
