"""Marks of constraints: where they follow the body to, and that each kind shows in the picture."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from hangtime.bridge.picture import annotations as m
from hangtime.bridge.picture.layout import lay_out
from hangtime.bridge.picture.mark_meshes import Look, solids
from hangtime.bridge.picture.render import draw_sheet
from hangtime.bridge.picture.sheet import Limb, SheetRow

TIMES = np.linspace(0.0, 1.0, 41)
X, Y, Z = np.eye(3)
HIP = np.stack([2.0 * TIMES, 0 * TIMES, 0 * TIMES + 0.8], axis=1)  # where the leg is joined
STILL = np.repeat(np.eye(3)[None], len(TIMES), axis=0)
LIMBS = (
    Limb("trunk", np.array([0.3, 0.2, 0.6]), HIP + 0.3 * Z, STILL),
    Limb("leg", np.array([0.12, 0.12, 0.8]), HIP - 0.4 * Z, STILL),
)
ROW = SheetRow("Sliding", TIMES, LIMBS, HIP + 0.1 * Z, np.zeros((0, 3)), ground=0.0)

EVERY = (
    m.Sphere(HIP - 0.8 * Z),
    m.Sphere(HIP, hollow=True),
    m.Cone(HIP, -Z, X, np.radians(30), 0.5),
    m.LimitArc(HIP, -Z, Y, 0.0, np.radians(70), 0.4),
    m.Ghost((HIP + 0.3 * Z)[:, None], STILL[:, None], np.array([[0.4, 0.3, 0.7]])),
    m.Box(HIP + 0.4 * X, np.eye(3), np.full(3, 0.15)),
    m.Bar(HIP + Z - 0.4 * Y, HIP + Z + 0.4 * Y),
    m.Tint(("leg",), m.Tone.FIXED),
)


def picture(folder: Path, *drawn: m.Mark) -> np.ndarray:
    """(H, W, 3) sRGB values, top row first."""
    path = folder / "sheet.png"
    draw_sheet([replace(ROW, marks=drawn)], path, width=480)
    image = bpy.data.images.load(str(path))
    try:
        wide, high = image.size
        return np.array(image.pixels[:]).reshape(high, wide, image.channels)[::-1, :, :3]
    finally:
        bpy.data.images.remove(image)


@pytest.fixture(scope="module")
def plain(tmp_path_factory) -> np.ndarray:
    return picture(tmp_path_factory.mktemp("plain"))


def redness(shown: np.ndarray) -> np.ndarray:
    return shown[..., 0] - shown[..., 1:].max(axis=-1)


@pytest.mark.parametrize("mark", EVERY, ids=lambda mark: type(mark).__name__)
def test_what_turns_with_the_world_and_what_only_moves(mark):
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    here = list(solids(m.at(mark, 7)))
    there = list(solids(m.at(m.moved(mark, quarter, np.array([1.0, 2.0, 3.0])), 7)))
    assert len(here) == len(there)
    for one, other in zip(here, there, strict=True):
        moved = one.mesh.points @ quarter.T + [1.0, 2.0, 3.0]
        if one.look in (Look.SOLID, Look.RING):  # balls do not turn
            moved = (
                one.mesh.points - m.at(mark, 7).place + quarter @ m.at(mark, 7).place + [1, 2, 3]
            )
        cloud, seen = (np.sort(np.round(v, 6), axis=0) for v in (moved, other.mesh.points))
        np.testing.assert_allclose(seen.mean(axis=0), cloud.mean(axis=0), atol=2e-3)
        np.testing.assert_allclose(np.ptp(seen, axis=0), np.ptp(cloud, axis=0), atol=6e-3)


def test_a_cone_stands_about_its_axis_and_is_stretched_sideways():
    cone = m.Cone(np.zeros(3), Z, X, np.radians(30), 1.0, stretch=(1.0, 0.5))
    (glass,) = (s for s in solids(cone) if s.look is Look.GLASS)
    rim = glass.mesh.points[len(glass.mesh.points) // 2 :]
    np.testing.assert_allclose(np.linalg.norm(rim, axis=1), 1.0)
    widest = np.degrees(np.arctan2(np.abs(rim[:, :2]), rim[:, 2:])).max(axis=0)
    np.testing.assert_allclose(widest, [30.0, np.degrees(np.arctan(0.5 * np.tan(np.pi / 6)))])


def test_a_limit_runs_from_bound_to_bound_and_a_fixed_angle_is_one_line():
    arc = m.LimitArc(np.zeros(3), X, Z, 0.0, np.pi / 2, 0.5)
    (pane,) = (s for s in solids(arc) if s.look is Look.GLASS)
    ends = pane.mesh.points[len(pane.mesh.points) // 2 :][[0, -1]]
    np.testing.assert_allclose(ends, [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]], atol=1e-12)
    assert {s.look for s in solids(replace(arc, lower=0.3, upper=0.3))} == {Look.LINE}


def test_marks_go_with_the_figures_in_their_span():
    span = (0.0, 0.5)
    tier = lay_out([replace(ROW, marks=(m.Box(HIP, np.eye(3), np.full(3, 0.1), span),))]).tiers[0]
    (box,) = tier.marks
    at = box.mesh.points.reshape(-1, 8, 3).mean(axis=1)
    shown = [f.centre[0] - 0.3 * Z for f in tier.figures if f.time <= 0.5]
    np.testing.assert_allclose(np.sort(at, axis=0), np.sort(shown, axis=0), atol=1e-9)


def test_a_momentary_mark_gets_a_figure_of_its_own():
    moment = (0.33, 0.33)
    tier = lay_out([replace(ROW, marks=(m.Sphere(HIP, moment),))]).tiers[0]
    (ball,) = tier.marks
    nearest = min(tier.figures, key=lambda f: abs(f.time - 0.33))
    assert nearest.time == pytest.approx(0.325)
    np.testing.assert_allclose(
        ball.mesh.points.mean(axis=0), nearest.centre[0] - 0.3 * Z, atol=1e-3
    )


def test_a_mark_after_the_end_is_not_drawn():
    assert lay_out([replace(ROW, marks=(m.Sphere(HIP, (2.0, 3.0)),))]).tiers[0].marks == ()


def test_a_tint_colours_its_limbs_only_in_its_span():
    tint = m.Tint(("leg",), m.Tone.LIMP, (0.5, 1.0))
    for figure in lay_out([replace(ROW, marks=(tint,))]).tiers[0].figures:
        assert figure.tones == ({1: m.Tone.LIMP} if figure.time >= 0.5 else {})


@pytest.mark.slow
def test_red_appears_where_the_sphere_is(plain, tmp_path):
    shown = picture(tmp_path, m.Sphere(HIP - 0.8 * Z))
    assert shown.shape == plain.shape
    red = np.argwhere(redness(shown) > 0.4)
    assert len(red) > 40
    assert (redness(plain) > 0.2).sum() == 0
    # the leg stands on the floor, whose middle is in the lower half and above the labels
    assert 0.5 < red[:, 0].mean() / len(shown) < 0.95


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mark", "measure"),
    [
        (EVERY[1], lambda shown: (redness(shown) > 0.2).sum()),
        (EVERY[2], lambda shown: (redness(shown) > 0.1).sum()),
        (EVERY[3], lambda shown: (redness(shown) > 0.3).sum()),
        (EVERY[4], lambda shown: -(shown[..., 2] - shown[..., 0] > 0.2).sum()),  # veils the blue
        (EVERY[5], lambda shown: (redness(shown) > 0.05).sum()),
        (EVERY[7], lambda shown: (shown[..., 0] - shown[..., 1] > 0.15).sum()),
    ],
    ids=["hollow", "cone", "limit", "pose", "weight", "fixed"],
)
def test_each_kind_is_seen(plain, tmp_path, mark, measure):
    assert measure(picture(tmp_path, mark)) > measure(plain) + 40


@pytest.mark.slow
def test_a_bar_overhead_is_in_the_picture(plain, tmp_path):
    shown = picture(tmp_path, EVERY[6])
    assert len(shown) > len(plain)  # the picture reaches up to it
    above = shown[: len(shown) // 4]
    assert (above.max(axis=-1) < 0.75).sum() > 25
