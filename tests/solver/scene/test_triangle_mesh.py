"""Signed distances and heights of meshes: against formulas, and against every triangle in turn."""

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.scene.point_triangle import closest_on_triangles
from hangtime.solver.scene.triangle_mesh import TriangleMesh, triangle_mesh
from hangtime.tests.helpers.meshes import Triangles, ball, box

SIZE = (0.8, 0.4, 0.2)


def made(mesh: Triangles) -> TriangleMesh:
    found = triangle_mesh(*mesh)
    assert found is not None
    return found


def points(count: int = 400, reach: float = 0.6) -> FloatArray:
    return np.random.default_rng(2).uniform(-reach, reach, (count, 3))


def test_a_boxs_distance_is_the_formulas() -> None:
    over = np.abs(points()) - 0.5 * np.array(SIZE)
    outside = np.linalg.norm(np.maximum(over, 0.0), axis=1)
    expected = outside + np.minimum(over.max(axis=1), 0.0)
    found = made(box(SIZE)).distances(points())
    assert expected.min() < -0.04
    np.testing.assert_allclose(found.distance, expected, atol=1e-12)


def test_normals_are_the_distances_gradient() -> None:
    mesh, at, step = made(ball(0.4, 24)), points(), 1e-6
    found = mesh.distances(at)
    for axis in np.eye(3):
        both = [mesh.distances(at + way * step * axis).distance for way in (1, -1)]
        slope = (both[0] - both[1]) / (2 * step)
        # but for the few points from which two triangles are equally far
        assert np.quantile(np.abs(slope - found.normal @ axis), 0.97) < 1e-4


@pytest.mark.parametrize("around", [3, 7, 40])
def test_the_tree_finds_the_nearest_of_all_triangles(around: int) -> None:
    mesh = made(ball(0.3, around))
    triangles, at = mesh.tree.triangles, points(60)
    every = np.repeat(at, len(triangles), axis=0)
    gap = every - closest_on_triangles(every, np.tile(triangles, (len(at), 1, 1)))[0]
    least = np.linalg.norm(gap, axis=1).reshape(len(at), -1).min(axis=1)
    np.testing.assert_allclose(np.abs(mesh.distances(at).distance), least, atol=1e-12)


def test_distances_at_edges_and_corners_keep_their_sign() -> None:
    """Where the nearest feature is an edge or a corner, one face's normal would get it wrong."""
    mesh = made((np.array([[0.0, 0, 0], [1, 0, 0], [0.1, 0.3, 0], [0.4, 0.1, 1]]), TETRAHEDRON))
    at = points(4000, 1.2)
    solve = np.linalg.solve((CORNERS[1:] - CORNERS[0]).T, (at - CORNERS[0]).T).T
    inside = (solve > 0.0).all(axis=1) & (solve.sum(axis=1) < 1.0)
    assert inside.sum() > 10
    np.testing.assert_array_equal(mesh.distances(at).distance < 0.0, inside)


CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0.1, 0.3, 0], [0.4, 0.1, 1]])
TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def test_a_sheet_is_solid_on_its_back_and_nothing_is_beside_it() -> None:
    sheet = made(
        (np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    )
    at = np.array([[0.5, 0.4, 0.1], [0.5, 0.4, -0.1], [0.5, 0.4, -0.5], [1.2, 0.5, -0.1]])
    found = sheet.distances(at).distance
    np.testing.assert_allclose(found[:3], [0.1, -0.1, 0.5], atol=1e-12)
    assert found[3] > 0.0
    assert not sheet.closed
    assert made(box(SIZE)).closed


def test_inside_out_meshes_have_a_negative_volume() -> None:
    vertices, triangles = box(SIZE)
    assert made((vertices, triangles)).volume == pytest.approx(np.prod(SIZE))
    assert made((vertices, triangles[:, ::-1])).volume == pytest.approx(-np.prod(SIZE))


def test_the_highest_face_counts() -> None:
    vertices, triangles = box(SIZE)
    stacked = np.concatenate([vertices, 0.5 * vertices + [0.0, 0.0, 1.0]])
    mesh = made((stacked, np.concatenate([triangles, triangles + 8])))
    found = mesh.heights(np.array([[0.1, 0.05], [0.3, 0.15], [0.5, 0.0]]))
    np.testing.assert_allclose(found.z, [1.05, 0.1, -np.inf])
    np.testing.assert_allclose(found.normal, [[0, 0, 1], [0, 0, 1], [0, 0, 0]], atol=1e-12)


def test_faces_without_area_and_doubled_vertices_do_no_harm() -> None:
    vertices, triangles = box(SIZE)
    torn = vertices[triangles].reshape(-1, 3)  # each triangle has corners of its own
    faces = np.concatenate([np.arange(36).reshape(-1, 3), [[0, 0, 1]]])
    mesh = made((torn, faces))
    assert mesh.closed
    whole = made((vertices, triangles)).distances(points()).distance
    np.testing.assert_allclose(mesh.distances(points()).distance, whole, atol=1e-12)
    assert triangle_mesh(vertices, np.array([[0, 0, 1]])) is None
