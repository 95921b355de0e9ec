"""Closest points on triangles, many pairs at once, and on which feature they lie."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray

FACE, CORNERS, EDGES = 0, (1, 2, 3), (4, 5, 6)  # features; edges ab, bc, ca
TINY = 1e-30


@dataclass(frozen=True)
class Triangles:
    """F triangles by a corner a and the sides from there: a, ab, ac (F, 3) m; the sides' products
    with themselves and each other: bb, bc, cc (F,) m²."""

    a: FloatArray
    ab: FloatArray
    ac: FloatArray
    bb: FloatArray
    bc: FloatArray
    cc: FloatArray

    @staticmethod
    def of(corners: FloatArray) -> "Triangles":
        """Of corners (F, 3, 3) m."""
        a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        return Triangles(a, ab, ac, _dot(ab, ab), _dot(ab, ac), _dot(ac, ac))

    def apart(self, points: FloatArray) -> FloatArray:
        """(N, F) m², squared distances of points (N, 3) m from all."""
        along_b = points @ self.ab.T - _dot(self.a, self.ab)
        along_c = points @ self.ac.T - _dot(self.a, self.ac)
        gap = points[:, None] - self.a
        return self._apart(np.einsum("nfi,nfi->nf", gap, gap), along_b, along_c, slice(None))

    def apart_in_pairs(self, points: FloatArray, which: IntArray) -> FloatArray:
        """(N,) m², squared distances of points (N, 3) m, each from one of them."""
        gap = points - self.a[which]
        along_b, along_c = _dot(gap, self.ab[which]), _dot(gap, self.ac[which])
        return self._apart(_dot(gap, gap), along_b, along_c, which)

    def _apart(
        self, far: FloatArray, along_b: FloatArray, along_c: FloatArray, which: IntArray | slice
    ) -> FloatArray:
        """Squared distances by those from a, and by the products of what leads there from a with
        the sides: from the face where a point is above it, else from the nearest edge."""
        bb, bc, cc = self.bb[which], self.bc[which], self.cc[which]
        least = np.minimum(_from_edge(far, along_b, bb), _from_edge(far, along_c, cc))
        third = bb - 2.0 * bc + cc
        from_b = far - 2.0 * along_b + bb
        least = np.minimum(least, _from_edge(from_b, bb - bc + along_c - along_b, third))
        size = bb * cc - bc * bc
        v, w = cc * along_b - bc * along_c, bb * along_c - bc * along_b
        above = (v >= 0.0) & (w >= 0.0) & (v + w <= size)
        from_face = far - (v * along_b + w * along_c) / np.maximum(size, TINY)
        return np.asarray(np.maximum(np.where(above, from_face, least), 0.0))


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


def _from_edge(far: FloatArray, along: FloatArray, length: FloatArray) -> FloatArray:
    """Squared distances from edges by those from their beginning; length: squared."""
    share = np.clip(along / np.maximum(length, TINY), 0.0, 1.0)
    return np.asarray(far + share * (share * length - 2.0 * along))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ni,ni->n", a, b))


def _ratio(part: FloatArray, whole: FloatArray) -> FloatArray:
    return np.asarray(part / np.where(np.abs(whole) > TINY, whole, 1.0))
