"""Cones around limbs, and arcs at joints, in the axes of bridge/shapes/limits.py. Angles in rad."""

from collections.abc import Iterator

import numpy as np

from ....bridge.shapes.limits import cone_rim, directions
from ....bridge.shapes.mesh import band
from ....solver.arrays import FloatArray
from ...drawing.sketch import Colour
from .shapes import Look, Shape, faded, lines, polyline, triangles_of

CONE_AROUND = 32  # faces of a cone
STEP = 0.1  # rad between the corners of an arc
OPEN = 0.7  # rad of an arc that has no end there
GLASS = 0.26  # a pane's opacity, as a share of its rim's
RIBS = 4  # lines from a cone's apex to its rim


def cone(
    half_angle: float, stretch: tuple[float, float], length: float, colour: Colour
) -> Iterator[Shape]:
    """A see-through cone with its rim (see `cone_rim`)."""
    rim = cone_rim(half_angle, stretch, length, CONE_AROUND)
    yield _pane(np.zeros_like(rim), rim, np.ones(len(rim)), colour)
    yield polyline(rim, colour, Look.BOLD)
    ribs = rim[:-1][:: CONE_AROUND // RIBS]
    yield lines(np.stack([np.zeros_like(ribs), ribs], axis=1), faded(colour, 0.4))


def arc(
    lower: float | None, upper: float | None, radius: float, colour: Colour, hole: float = 0.0
) -> Iterator[Shape]:
    """An arc from limit to limit.

    A limit that is None is open: the arc fades away on that side. hole: share of the radius that
    is left free about the centre.
    """
    low = lower if lower is not None else (upper or 0.0) - OPEN
    high = upper if upper is not None else (lower or 0.0) + OPEN
    low, high = min(low, high), max(low, high)
    angles = np.linspace(low, high, max(int((high - low) / STEP), 1) + 1)
    rim = radius * directions(angles)
    inner = hole * rim
    strength = np.ones(len(angles))
    if lower is None:
        strength *= np.linspace(0.0, 1.0, len(angles))
    if upper is None:
        strength *= np.linspace(1.0, 0.0, len(angles))
    yield _pane(inner, rim, strength, colour)
    along = np.tile(np.asarray(colour), (len(angles) - 1, 1))
    along[:, 3] *= 0.5 * (strength[:-1] + strength[1:])
    yield lines(np.stack([rim[:-1], rim[1:]], axis=1), along)
    ends = [k for k, limit in ((0, lower), (-1, upper)) if limit is not None]
    yield lines([[inner[k], rim[k]] for k in ends] or np.zeros((0, 2, 3)), colour, Look.BOLD)


def _pane(inner: FloatArray, rim: FloatArray, strength: FloatArray, colour: Colour) -> Shape:
    """Glass between two lines (N, 3), as opaque as `strength` (N,) says."""
    mesh = band(inner, rim)
    colours = np.tile(np.asarray(faded(colour, GLASS), np.float32), (len(mesh.points), 1))
    colours[:, 3] *= np.tile(strength, 2)
    return Shape(Look.GLASS, mesh.points.astype(np.float32), colours, triangles_of(mesh.faces))
