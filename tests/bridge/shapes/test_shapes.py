"""Meshes and rims that picture and overlay share."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hangtime.bridge.shapes.limits import cone_rim, directions
from hangtime.bridge.shapes.mesh import Mesh, band, joined
from hangtime.bridge.shapes.solids import box, superellipsoid, tube


def volume(mesh: Mesh) -> float:
    """Of a closed surface; negative where its faces look inwards."""
    triangles = mesh.faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    a, b, c = (mesh.points[triangles[:, k]] for k in range(3))
    return float((np.cross(a, b) * c).sum() / 6.0)


def test_a_box_has_twelve_edges_and_looks_outwards() -> None:
    mesh = box((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    lengths = np.linalg.norm(mesh.edges[:, 1] - mesh.edges[:, 0], axis=1)
    assert sorted(lengths) == pytest.approx([1.0] * 4 + [2.0] * 4 + [3.0] * 4)
    assert volume(mesh) == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("mesh", "full"),
    [
        (superellipsoid(64, 48), 4.0 / 3.0 * pi),
        (tube(np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 2.0, 0.0]]), 0.1, 64), 0.02 * pi),
        (tube(directions(np.linspace(0.0, 2.0 * pi, 65)), 0.1, 64), 0.02 * pi * pi),
    ],
    ids=["ball", "straight tube", "ring"],
)
def test_solids_fill_their_volume_and_look_outwards(mesh: Mesh, full: float) -> None:
    assert volume(mesh) == pytest.approx(full, rel=0.02)


def test_joined_and_placed_meshes_keep_their_volumes() -> None:
    one = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    turned = one.placed(np.eye(3)[[1, 2, 0]], np.array([5.0, 0.0, 0.0]))
    assert volume(joined([one, turned, one])) == pytest.approx(3.0)


def test_a_band_joins_its_lines_one_face_a_step() -> None:
    line = directions(np.linspace(0.0, 1.0, 5))
    mesh = band(line, 2.0 * line)
    assert mesh.faces.tolist()[0] == [0, 1, 6, 5]
    assert len(mesh.faces) == 4


@pytest.mark.parametrize("half_angle", [0.3, 1.5, 2.5])
def test_a_cones_rim_leans_by_its_half_angle(half_angle: float) -> None:
    rim = cone_rim(half_angle, (1.0, 1.0), 0.4, 32)
    np.testing.assert_allclose(np.arccos(rim[:, 0] / 0.4), half_angle, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(rim, axis=1), 0.4)
