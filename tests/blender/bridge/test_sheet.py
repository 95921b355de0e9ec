"""The picture of a result: what it shows, where, and that it leaves no trace in the scene."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from hangtime.bridge.picture import cycles, layout
from hangtime.bridge.picture.annotations import Thing
from hangtime.bridge.picture.mark_materials import FINISHES
from hangtime.bridge.picture.mark_meshes import Look
from hangtime.bridge.picture.render import draw_sheet
from hangtime.bridge.picture.scene import Floor, Painter
from hangtime.bridge.picture.sheet import Limb, SheetRow, View
from hangtime.solver.data.faults import OutputNotWritable

TIMES = np.linspace(0.0, 1.0, 61)


def hopper(title: str, *, further: float = 0.0, higher: float = 0.0, heading: float = 0.0):
    """A trunk on one leg that crouches, hops 1 m along x (turned by `heading` rad) and stands."""
    air = np.clip((TIMES - 0.4) / 0.3, 0.0, 1.0)
    crouch = -0.2 * np.exp(-(((TIMES - 0.25) / 0.1) ** 2))
    x = (1.0 + further) * air
    z = 0.9 + crouch + higher * air + 1.2 * air * (1 - air)
    turn = np.array(
        [
            [np.cos(heading), -np.sin(heading), 0.0],
            [np.sin(heading), np.cos(heading), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    com = np.stack([x, 0 * x, z], axis=1) @ turn.T
    rotation = np.repeat((turn @ np.diag([1.0, 1.0, 1.0]))[None], len(TIMES), axis=0)
    down = np.array([0.0, 0.0, 0.55])
    limbs = (
        Limb("trunk", np.array([0.4, 0.25, 0.6]), com + down / 3, rotation),
        Limb("leg", np.array([0.12, 0.12, 0.7]), com - down, rotation),
    )
    pins = np.array([[0.0, 0.0, 0.0], [1.0 + further, 0.0, higher]]) @ turn.T
    return SheetRow(title, TIMES, limbs, com, pins, (0.4, 0.55, 0.7), ((0.0, 0.4), (0.7, 1.0)))


@pytest.fixture
def rows():
    return hopper("Recording"), hopper("Adapted", further=0.3, higher=0.2)


@pytest.fixture(scope="module")
def picture(tmp_path_factory) -> np.ndarray:
    """(H, W, 3) sRGB values of a small picture, top row first."""
    path = tmp_path_factory.mktemp("sheet") / "sheet.png"
    draw_sheet((hopper("Recording"), hopper("Adapted", further=0.3, higher=0.2)), path, width=360)
    return read(path)


def read(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path))
    try:
        wide, high = image.size
        return np.array(image.pixels[:]).reshape(high, wide, image.channels)[::-1, :, :3]
    finally:
        bpy.data.images.remove(image)


def halves(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    middle = len(picture) // 2
    return picture[:middle], picture[middle:]


def is_red(picture: np.ndarray) -> np.ndarray:
    return (picture[..., 0] > 0.5) & (picture[..., 1:].max(axis=-1) < 0.35)


@pytest.mark.slow
def test_the_picture_has_the_width_asked_for_and_a_light_background(picture):
    assert picture.shape[1] == 360
    assert picture[:3].min() > 0.9


def test_both_rows_show_red_pins(picture):
    for half in halves(picture):
        assert is_red(half).sum() > 10


@pytest.mark.slow
def test_from_above_both_rows_are_shown_once_more_and_tell_what_goes_sideways(tmp_path):
    aside = [replace(row, pins=row.pins + shift) for row, shift in sideways()]
    draw_sheet(aside, tmp_path / "sheet.png", View(heading=(1.0, 0.0), above=True), width=360)
    high = [middle(is_red(part)) for part in np.array_split(read(tmp_path / "sheet.png"), 4)]
    assert abs(high[1] - high[0]) < 0.15
    assert high[2] - high[3] > 0.15  # of its part's height: the landing lies further up


@pytest.mark.slow
def test_from_above_a_floor_that_is_high_up_is_where_one_at_zero_is(tmp_path):
    seen = []
    for up in (0.0, 3.0):
        pictures = [raised(row, up) for row, _ in sideways()]
        draw_sheet(
            pictures, tmp_path / "sheet.png", View(heading=(1.0, 0.0), above=True), width=200
        )
        seen.append(read(tmp_path / "sheet.png"))
    assert np.abs(seen[1] - seen[0]).mean() < 0.01


def raised(row: SheetRow, up: float) -> SheetRow:
    shift = np.array([0.0, 0.0, up])
    limbs = tuple(replace(limb, centre=limb.centre + shift) for limb in row.limbs)
    return replace(row, limbs=limbs, com=row.com + shift, pins=row.pins + shift)


def sideways():
    # The pin of the landing 0.4 m to the left in the second row.
    left = np.array([[0.0, 0.0, 0.0], [0.0, 0.4, 0.0]])
    return (hopper("Recording"), 0.0 * left), (hopper("Adapted"), left)


def middle(red: np.ndarray) -> float:
    """How far down the landing's pins are, a share of the height."""
    rows, columns = np.nonzero(red)
    return float(rows[columns > red.shape[1] / 2].mean()) / len(red)


def test_the_rows_are_told_apart_by_colour(picture):
    def blueness(half: np.ndarray) -> float:
        return float((half[..., 2] - half[..., 0]).max())

    above, below = halves(picture)
    assert blueness(below) > blueness(above) + 0.15


def test_the_scene_is_left_as_it_was(rows, tmp_path):
    kinds = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]

    def state():
        blocks = {kind: sorted(b.name for b in getattr(bpy.data, kind)) for kind in kinds}
        chosen = [o.name for o in bpy.context.selected_objects]
        engine = bpy.context.scene.render.engine
        addons = sorted(bpy.context.preferences.addons.keys())
        return blocks, chosen, bpy.context.scene.name, engine, addons

    before = state()
    draw_sheet(rows, tmp_path / "sheet.png", width=40)
    assert state() == before


def test_nothing_is_left_behind_when_drawing_fails(rows, tmp_path, monkeypatch):

    def fail(*_, **__):
        raise RuntimeError

    monkeypatch.setattr(cycles, "_render", fail)
    before = len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.meshes)
    with pytest.raises(RuntimeError):
        draw_sheet(rows, tmp_path / "sheet.png", width=40)
    assert (len(bpy.data.scenes), len(bpy.data.objects), len(bpy.data.meshes)) == before


def test_a_file_that_cannot_be_written_is_named(rows, tmp_path):
    missing = tmp_path / "nowhere" / "sheet.png"
    with pytest.raises(OutputNotWritable) as fault:
        draw_sheet(rows, missing, width=40)
    assert fault.value.path == str(missing)


def test_key_instants_are_shown_and_figures_keep_apart(rows):
    for tier, row in zip(layout.lay_out(rows).tiers, rows, strict=True):
        times = np.array([figure.time for figure in tier.figures])
        for key in row.key_times:
            assert np.abs(times - key).min() < 0.01
        x = np.array([figure.com[0] for figure in tier.figures])
        assert 7 <= len(x) <= View().figures
        assert np.diff(x).min() > 0.3


def test_both_rows_show_the_same_instants_also_where_one_flies_for_longer() -> None:
    short = hopper("Recording", further=-1.0)
    late = np.interp(TIMES, (0.0, 0.4, 0.8, 1.0), (0.0, 0.4, 0.7, 1.0))
    at = np.searchsorted(TIMES, late).clip(max=len(TIMES) - 1)
    limbs = tuple(
        replace(limb, centre=limb.centre[at], rotation=limb.rotation[at]) for limb in short.limbs
    )
    long = replace(short, limbs=limbs, com=short.com[at], key_times=(0.4, 0.6, 0.8))
    recording, adapted = layout.lay_out((short, long)).tiers
    assert len(recording.figures) == len(adapted.figures) > 5
    for one, other in zip(recording.figures, adapted.figures, strict=True):
        assert one.com[2] == pytest.approx(other.com[2], abs=0.03)


def test_a_farther_landing_is_as_much_farther_in_the_picture(rows):
    recording, adapted = layout.lay_out(rows).tiers
    apart = adapted.figures[-1].com - recording.figures[-1].com
    np.testing.assert_allclose(apart, [0.3, 0.0, 0.2], atol=1e-9)


def test_a_raised_landing_stands_on_a_step_and_the_ground_does_not(rows):
    recording, adapted = layout.lay_out(rows).tiers
    assert recording.steps == ()
    (step,) = adapted.steps
    assert step.top == pytest.approx(0.2)
    landed = [figure.com[0] for figure in adapted.figures if figure.time >= 0.7]
    assert step.left < min(landed) < max(landed) < step.right


def plate(height: float) -> Thing:
    """A triangle, 1 m wide."""
    corners = np.array([[0.0, 0.0, height], [1.0, 0.0, height], [0.0, 1.0, height]])
    return Thing(corners, np.array([[0, 1, 2]]))


def copies(tier: layout.Tier) -> np.ndarray:
    """(N, 2) m: where the plates that are drawn begin and end, of seven points each."""
    (drawn,) = (solid for solid in tier.marks if solid.look is Look.THING)
    x = drawn.mesh.points[:, 0].reshape(-1, 7)
    return np.stack([x.min(axis=1), x.max(axis=1)], axis=1)


def test_in_place_nothing_slides_and_an_object_is_there_once(rows):
    row = replace(rows[0], marks=(plate(0.0),))
    (tier,) = layout.lay_out([row], View(in_place=True)).tiers
    assert np.ptp(tier.path[:, 0]) == pytest.approx(np.ptp(row.com[:, 0]))
    assert len(copies(tier)) == 1


def test_an_object_is_with_every_figure_that_touches_it_and_in_no_plane_twice(rows):
    (tier,) = layout.lay_out([replace(rows[0], marks=(plate(0.0),))]).tiers
    on = [each.time for each in tier.figures if not 0.42 < each.time < 0.68]
    assert len(copies(tier)) == len(on) < len(tier.figures)
    (drawn,) = (solid for solid in tier.marks if solid.look is Look.THING)
    assert len(np.unique(drawn.mesh.points[:, 2].round(6))) == len(on)


def test_an_object_that_nobody_touches_does_not_overlap_itself(rows):
    (tier,) = layout.lay_out([replace(rows[0], marks=(plate(2.0),))]).tiers
    ends = copies(tier)
    assert len(ends) > 1
    assert (ends[1:, 0] > ends[:-1, 1]).all()


def test_a_wall_that_nobody_touches_is_there_once_and_hides_nothing(rows):
    row = replace(rows[0], marks=(replace(plate(2.0), wall=True),))
    (tier,) = layout.lay_out([row]).tiers
    (drawn,) = (solid for solid in tier.marks if solid.look is Look.WALL)
    assert len(drawn.mesh.points) == 7
    assert not FINISHES[Look.WALL].shadow


def test_travel_runs_to_the_right_whatever_the_heading():
    for heading in (0.0, 2.0, -1.2):
        tier = layout.lay_out([hopper("Recording", heading=heading)]).tiers[0]
        np.testing.assert_allclose(tier.path[:, 1], 0.0, atol=1e-9)
        assert np.diff(tier.path[:, 0]).min() > -1e-9


def test_the_heading_asked_for_runs_to_the_right():
    row = hopper("Diagonal", heading=0.5)
    tier = layout.lay_out([row], View(heading=(1.0, 0.0))).tiers[0]
    aside = tier.path[-1, 1] - tier.path[0, 1]
    assert aside == pytest.approx(np.sin(0.5))


@pytest.mark.parametrize("elevation", [15.0, 70.0])
def test_titles_are_above_all_that_is_drawn(rows, elevation):
    """From above limbs ran through them that reach away from the viewer."""
    limb = rows[0].limbs[1]
    arm = replace(limb, size=limb.size[[0, 2, 1]], centre=limb.centre + np.array([0.0, 0.8, 0.5]))
    (tier,) = layout.lay_out([replace(rows[0], limbs=(*rows[0].limbs, arm))]).tiers
    floor = Floor(np.array([-1.0, -0.7, 0.0]), np.array([3.0, 0.7, 0.0]))
    head = Painter.head(tier, floor, np.radians(elevation))
    up = np.array([0.0, np.sin(np.radians(elevation)), np.cos(np.radians(elevation))])
    for figure in tier.figures:
        hand = figure.centre[2] + arm.size / 2 * [0.0, 1.0, 1.0]
        assert head > hand @ up - 1e-9


def test_the_floor_is_where_the_row_says(rows):
    low = replace(rows[1], pins=rows[1].pins[1:], pin_times=rows[1].pin_times[1:])
    assert layout.lay_out([low]).tiers[0].steps == ()
    assert len(layout.lay_out([replace(low, ground=0.0)]).tiers[0].steps) == 1


def test_key_times_that_would_hide_each_other_are_not_both_shown(rows):
    row = replace(rows[0], key_times=(0.55, 0.57))
    times = [figure.time for figure in layout.lay_out([row]).tiers[0].figures]
    assert 0.55 in np.round(times, 2)
    assert 0.57 not in np.round(times, 2)


def test_a_jump_in_place_is_spread():
    row = hopper("In place", further=-1.0)
    x = [figure.com[0] for figure in layout.lay_out([row]).tiers[0].figures]
    assert np.diff(x).min() > 0.3


def test_without_their_times_pins_show_where_the_body_touches_them():
    row = hopper("Recording")
    tier = layout.lay_out([SheetRow("", TIMES, row.limbs, row.com, row.pins)]).tiers[0]
    touching = [f.com[0] for f in tier.figures if f.centre[1, 2] - 0.35 < 0.04]
    np.testing.assert_allclose(sorted(tier.pins[:, 0]), sorted(touching), atol=0.04)


def test_limbs_taper_away_from_the_heavier_neighbour(rows):
    tier = layout.lay_out(rows).tiers[0]
    leg = tier.names.index("leg")
    assert tier.proximal[leg] == 1.0  # its upper end is at the trunk
