"""A triangle mesh as a solid: signed distances of points, and the height of its highest face.

The sign is that of the angle-weighted pseudo-normal at the closest point (Baerentzen & Aanaes
2005). A mesh with holes has one-sided faces: what is behind one is in it, down to SHEET; beside its
edges nothing is.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.faults import NoFaces
from ..data.scene import SceneObject
from .point_triangle import CORNERS, EDGES, FACE, closest_on_triangles
from .triangle_tree import TriangleTree

MERGED = 1e-6  # m, within which vertices are one
LEAST_AREA = 1e-12  # m², twice that of a triangle that has a normal
ON_FACE = 1e-6  # m, nearer than which a point has the face's normal
SHEET = 0.3  # m, how deep behind a mesh with holes is in it
REMEMBERED = 64  # meshes, whose trees are kept; a character has some twenty


@dataclass(frozen=True)
class Distances:
    """N points' signed distances m, negative inside; normals (N, 3) unit, outwards."""

    distance: FloatArray
    normal: FloatArray


@dataclass(frozen=True)
class Heights:
    """The highest face on the verticals through N places: z (N,) m, -inf where there is none.

    normal: (N, 3) unit, zero where there is none.
    """

    z: FloatArray
    normal: FloatArray


@dataclass(frozen=True)
class TriangleMesh:
    """tree: of the triangles that have an area. normals: (K, 3) unit pseudo-normals; feature: (F,
    7) which of them each triangle's face, corners and edges have; border: (K,) those at a hole.
    closed: whether there are none."""

    tree: TriangleTree
    normals: FloatArray
    feature: IntArray
    border: BoolArray

    @property
    def closed(self) -> bool:
        return not bool(self.border.any())

    @property
    def low(self) -> FloatArray:
        """(3,) m, of its box."""
        return np.asarray(self.tree.low[0])

    @property
    def high(self) -> FloatArray:
        """(3,) m, of its box."""
        return np.asarray(self.tree.high[0])

    @property
    def volume(self) -> float:
        """m³, negative where the faces of a closed mesh look inwards."""
        a, b, c = np.moveaxis(self.tree.triangles, 1, 0)
        return float(np.einsum("fi,fi->", a, np.cross(b, c)) / 6.0)

    @property
    def thickness(self) -> float:
        """m, between the faces of a closed mesh on average: twice its volume over its area."""
        a, b, c = np.moveaxis(self.tree.triangles, 1, 0)
        area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
        return 2.0 * abs(self.volume) / area

    def distances(self, points: FloatArray) -> Distances:
        """Signed distances of points (N, 3) m in the mesh's own axes."""
        if not len(points):
            return Distances(np.empty(0), np.empty((0, 3)))
        triangle = self.tree.closest(points)
        at, on = closest_on_triangles(points, self.tree.triangles[triangle])
        feature = self.feature[triangle, on]
        out, gap = self.normals[feature], points - at
        far = np.linalg.norm(gap, axis=1)
        inside = np.einsum("ni,ni->n", gap, out) < 0.0
        if not self.closed:
            inside &= ~self.border[feature] & (far < SHEET)
        sign = np.where(inside, -1.0, 1.0)
        away = gap * (sign / np.maximum(far, ON_FACE))[:, None]
        return Distances(sign * far, np.where((far > ON_FACE)[:, None], away, out))

    def heights(self, places: FloatArray) -> Heights:
        """The highest face at places (N, 2) m, in axes whose z is up."""
        owner, triangle = self.tree.above_or_below(places)
        corners = self.tree.triangles[triangle]
        a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        size = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
        flat = np.where(np.abs(size) > LEAST_AREA, size, np.inf)
        p = places[owner] - a[:, :2]
        v = (p[:, 0] * ac[:, 1] - p[:, 1] * ac[:, 0]) / flat
        w = (ab[:, 0] * p[:, 1] - ab[:, 1] * p[:, 0]) / flat
        on = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1.0 + 1e-9) & np.isfinite(flat)
        owner, triangle = owner[on], triangle[on]
        z = (a[:, 2] + v * ab[:, 2] + w * ac[:, 2])[on]
        order = np.lexsort((-z, owner))
        which, first = np.unique(owner[order], return_index=True)
        top, normal = np.full(len(places), -np.inf), np.zeros((len(places), 3))
        top[which] = z[order][first]
        normal[which] = self.normals[self.feature[triangle[order][first], FACE]]
        return Heights(top, normal)


def triangle_mesh(vertices: FloatArray, triangles: IntArray) -> TriangleMesh | None:
    """The mesh of vertices (V, 3) m and triangles (F, 3); None where none has an area."""
    _, first, merged = np.unique(
        np.round(vertices / MERGED), axis=0, return_index=True, return_inverse=True
    )
    places, faces = vertices[first], merged.reshape(-1)[triangles]
    corners = places[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(across, axis=1)
    kept = area > LEAST_AREA
    if not kept.any():
        return None
    tree = TriangleTree.of(corners[kept])
    faces = faces[kept][tree.order]
    normals = (across[kept] / area[kept, None])[tree.order]
    return TriangleMesh(tree, *_pseudo_normals(tree.triangles, faces, normals, len(places)))


def _pseudo_normals(
    corners: FloatArray, faces: IntArray, normals: FloatArray, n_vertices: int
) -> tuple[FloatArray, IntArray, BoolArray]:
    """Pseudo-normals of faces, then vertices, then edges; each triangle's; those at a hole."""
    n_faces = len(faces)
    ahead = np.roll(corners, -1, axis=1) - corners
    ahead /= np.linalg.norm(ahead, axis=2, keepdims=True)
    cosine = -np.einsum("fci,fci->fc", ahead, np.roll(ahead, 1, axis=1))
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    at_vertices = _summed(faces.ravel(), (angle[..., None] * normals[:, None]), n_vertices)
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    key = ends.min(axis=1) * n_vertices + ends.max(axis=1)
    edges, edge = np.unique(key, return_inverse=True)
    at_edges = _summed(edge, np.repeat(normals, 3, axis=0), len(edges))
    # An edge with a face on both sides is run along both ways.
    ways = np.bincount(edge, np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0), len(edges))
    open_edges = ways != 0.0
    open_vertices = np.zeros(n_vertices, dtype=bool)
    open_vertices[ends[open_edges[edge]]] = True
    every = np.concatenate([normals, at_vertices, at_edges])
    every /= np.maximum(np.linalg.norm(every, axis=1, keepdims=True), 1e-12)
    feature = np.empty((n_faces, 7), dtype=int)
    feature[:, FACE] = np.arange(n_faces)
    feature[:, CORNERS] = n_faces + faces
    feature[:, EDGES] = n_faces + n_vertices + edge.reshape(-1, 3)
    return every, feature, np.concatenate([np.zeros(n_faces, bool), open_vertices, open_edges])


def _summed(owner: IntArray, vectors: FloatArray, count: int) -> FloatArray:
    """(count, 3) sums of vectors (..., 3) by their owner."""
    flat = vectors.reshape(-1, 3)
    return np.stack([np.bincount(owner, flat[:, k], count) for k in range(3)], axis=1)


@lru_cache(maxsize=REMEMBERED)
def mesh_of(thing: SceneObject) -> TriangleMesh:
    """An object's mesh in its own axes, remembered. Raises NoFaces."""
    return _faced(thing, thing.vertices)


@lru_cache(maxsize=REMEMBERED)
def placed_mesh(thing: SceneObject) -> TriangleMesh:
    """An object's mesh in the world, as it stands at first, remembered. Raises NoFaces."""
    return _faced(thing, thing.vertices @ thing.rotations[0].T + thing.positions[0])


def _faced(thing: SceneObject, vertices: FloatArray) -> TriangleMesh:
    mesh = triangle_mesh(vertices, thing.triangles) if len(thing.triangles) else None
    if mesh is None:
        raise NoFaces(thing.name)
    return mesh
