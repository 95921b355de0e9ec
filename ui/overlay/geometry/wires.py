"""Solids as wires: numpy only."""

import numpy as np
from numpy.typing import ArrayLike

from ....solver.arrays import FloatArray
from .shapes import Look, Shape, lines

AROUND = 16  # lines of a circle; a multiple of 4


def capsules(
    starts: FloatArray, ends: FloatArray, radii: FloatArray, colour: ArrayLike, look: Look
) -> Shape:
    """Capsules about segments (N, 3): a circle and a cap of two arcs at each end, four lines along.

    Those without a length are balls.
    """
    along = _directions(ends - starts)
    aside = _directions(np.cross(along, np.eye(3)[np.abs(along).argmin(axis=1)]))
    across = np.cross(along, aside)
    turns = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
    cap = turns[: AROUND // 2 + 1]
    pairs = [_lines(c, radii, aside, across, turns) for c in (starts, ends)]
    for centres, way in ((starts, -along), (ends, along)):
        pairs += [_lines(centres, radii, side, way, cap) for side in (aside, across)]
    corners = [radii[:, None] * side for side in (aside, -aside, across, -across)]
    pairs += [np.stack([starts + c, ends + c], axis=1) for c in corners]
    return lines(np.concatenate(pairs), colour, look)


def _lines(
    centres: FloatArray, radii: FloatArray, zero: FloatArray, ahead: FloatArray, turns: FloatArray
) -> FloatArray:
    """(N * (T - 1), 2, 3) lines of arcs about centres through angles (T,) from zero to ahead."""
    arcs = np.cos(turns)[:, None] * zero[:, None] + np.sin(turns)[:, None] * ahead[:, None]
    points = centres[:, None] + radii[:, None, None] * arcs
    pairs = np.stack([points[:, :-1], points[:, 1:]], axis=2)
    return np.asarray(pairs.reshape(-1, 2, 3))


def _directions(vectors: FloatArray) -> FloatArray:
    """(N, 3) unit vectors; upwards where there is no direction."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    up = np.array([0.0, 0.0, 1.0])
    return np.asarray(np.where(length > 1e-9, vectors / np.maximum(length, 1e-9), up))
