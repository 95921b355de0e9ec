"""Closest points on triangles, many pairs at once, and on which feature they lie."""

import numpy as np

from ..arrays import FloatArray, IntArray

FACE, CORNERS, EDGES = 0, (1, 2, 3), (4, 5, 6)  # features; edges ab, bc, ca
TINY = 1e-30


def closest_on_triangles(points: FloatArray, triangles: FloatArray) -> tuple[FloatArray, IntArray]:
    """Closest points (N, 3) m and their features (N,), of triangles (N, 3, 3) m to points (N, 3).

    Ericson, Real-Time Collision Detection (2005), 5.1.5.
    """
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, ac = b - a, c - a
    d1, d2 = _dot(ab, points - a), _dot(ac, points - a)
    d3, d4 = _dot(ab, points - b), _dot(ac, points - b)
    d5, d6 = _dot(ab, points - c), _dot(ac, points - c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    feature = np.select(
        [
            (d1 <= 0) & (d2 <= 0),
            (d3 >= 0) & (d4 <= d3),
            (vc <= 0) & (d1 >= 0) & (d3 <= 0),
            (d6 >= 0) & (d5 <= d6),
            (vb <= 0) & (d2 >= 0) & (d6 <= 0),
            (va <= 0) & (d4 - d3 >= 0) & (d5 - d6 >= 0),
        ],
        [1, 2, 4, 3, 6, 5],
        FACE,
    )
    whole = va + vb + vc
    whole = np.where(np.abs(whole) > TINY, whole, 1.0)
    v, w = vb / whole, vc / whole
    one, none = np.ones_like(v), np.zeros_like(v)
    on_bc = _ratio(d4 - d3, d4 - d3 + d5 - d6)
    v = np.choose(feature, [v, none, one, none, _ratio(d1, d1 - d3), 1.0 - on_bc, none])
    w = np.choose(feature, [w, none, none, one, none, on_bc, _ratio(d2, d2 - d6)])
    return a + v[:, None] * ab + w[:, None] * ac, feature


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ni,ni->n", a, b))


def _ratio(part: FloatArray, whole: FloatArray) -> FloatArray:
    return np.asarray(part / np.where(np.abs(whole) > TINY, whole, 1.0))
