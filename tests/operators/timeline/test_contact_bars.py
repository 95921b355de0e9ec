"""Bars of contacts in an editor: their places and what the mouse is at; no Blender."""

from __future__ import annotations

import pytest
from hangtime.bridge.plots.screen import Axis, Rect
from hangtime.bridge.rows.phases import phases
from hangtime.operators.timeline.contact_bars import Bar, Bars, Row, lay_out
from hangtime.operators.timeline.contact_edge_state import Edge
from hangtime.ui.drawing.sketch import Drawing
from hangtime.ui.timeline.drawing import drawn, hatch

ROWS = (
    Row("Left heel", (Bar("Left heel 1", 60.0, 136.0), Bar("Left heel 2", 231.0, 330.0))),
    Row("Left toe", (Bar("Left toe 1", 60.0, 175.0, used=False),)),
    Row(
        "Phases",
        (
            Bar("ground 1", 60.0, 136.0, is_phase=True),
            Bar("flight 1", 136.0, 231.0, is_phase=True, firm=True),
            Bar("ground 2", 231.0, 330.0, is_phase=True),
        ),
    ),
)


def laid_out(first: float = 0.0, last: float = 400.0, height: float = 200.0) -> Bars:
    bars = lay_out(ROWS, Axis(first, last, 0.0, 800.0), height, 1.0)
    assert bars is not None
    return bars


def height_of(bars: Bars, name: str) -> float:
    rect = next(rect for bar, rect in bars.placed() if bar.name == name)
    return 0.5 * (rect.bottom + rect.top)


@pytest.mark.parametrize(("first", "last"), [(0.0, 400.0), (200.0, 260.0), (-5000.0, 5000.0)])
def test_an_edge_is_grabbed_where_it_is_drawn_at_any_zoom(first: float, last: float) -> None:
    bars = laid_out(first, last)
    x, y = bars.axis.at(231.0), height_of(bars, "Left heel 2")
    grip = bars.grip_at(x, y)
    assert grip is not None
    assert grip.edge is Edge.START
    assert grip.bar.name == "Left heel 2"


def test_beside_edges_nothing_is_grabbed() -> None:
    bars = laid_out()
    x, y = bars.axis.at(231.0), height_of(bars, "Left heel 2")
    assert bars.grip_at(x + 7.5, y) is not None
    assert bars.grip_at(x - 8.5, y) is None
    assert bars.grip_at(x + 60.0, y) is None  # within the bar, not at its edge
    assert bars.grip_at(x, bars.room.top + 3.0) is None
    assert bars.bar_at(x + 60.0, y) is ROWS[0].bars[1]
    assert bars.bar_at(bars.axis.at(180.0), y) is None


def test_of_two_edges_within_reach_the_nearer_is_grabbed() -> None:
    bars = laid_out(0.0, 4000.0)  # a bar of 15 px
    y = height_of(bars, "Left heel 1")
    left, right = bars.axis.at(60.0), bars.axis.at(136.0)
    for x, edge in ((left + 5.0, Edge.START), (right - 5.0, Edge.END)):
        grip = bars.grip_at(x, y)
        assert grip is not None
        assert grip.edge is edge


def test_what_does_not_count_and_flights_have_no_edges_to_grab() -> None:
    bars = laid_out()
    assert bars.grip_at(bars.axis.at(175.0), height_of(bars, "Left toe 1")) is None
    grip = bars.grip_at(bars.axis.at(136.0) + 3.0, height_of(bars, "flight 1"))
    assert grip is not None
    assert grip.bar.name == "ground 1"


def test_a_low_editor_shows_the_phases_alone_a_lower_one_at_its_top() -> None:
    axis = Axis(0.0, 400.0, 0.0, 800.0)
    low = lay_out(ROWS, axis, 48.0, 1.0)
    assert low is not None
    assert [row.name for row in low.rows] == ["Phases"]
    usual = lay_out(ROWS, axis, 40.0, 1.0)  # Blender's usual layout
    assert usual is not None
    assert (len(usual.rows), usual.row_height) == (1, 5.0)
    small = lay_out(ROWS, axis, 30.0, 1.0)  # the same in a window of 1280 × 800
    assert small is not None
    assert (len(small.rows), small.row_height, small.room.top) == (1, 5.0, 30.0)
    assert lay_out(ROWS, axis, 20.0, 1.0) is None
    assert lay_out((), axis, 400.0, 1.0) is None


def test_a_low_editor_shows_the_doubts_over_the_phases() -> None:
    doubt = Bar("Spike", 149.5, 150.5, firm=True, is_doubt=True)
    low = lay_out((Row("Recording", (doubt,)), *ROWS), Axis(0.0, 400.0, 0.0, 800.0), 48.0, 1.0)
    assert low is not None
    (row,) = low.rows
    assert row.bars == (*ROWS[-1].bars, doubt)  # painted last
    only = lay_out((Row("Recording", (doubt,)),), Axis(0.0, 400.0, 0.0, 800.0), 36.0, 1.0)
    assert only is not None
    assert only.rows[0].bars == (doubt,)


def test_markers_keep_their_strip() -> None:
    axis = Axis(0.0, 400.0, 0.0, 800.0)
    with_markers = lay_out(ROWS, axis, 200.0, 2.0, markers=True)
    assert with_markers is not None
    assert with_markers.bottom >= 84.0
    assert with_markers.room.top <= 200.0 - 48.0


def words(picture: Drawing) -> list[str]:
    return [text.words for text in picture.texts]


def measure(text: str, size: float) -> float:
    return 0.6 * size * len(text)


def test_names_are_written_where_there_is_room() -> None:
    assert words(drawn(laid_out(), measure)) == [
        *("Left heel 1", "Left heel 2", "Left toe 1", "ground 1", "flight 1", "ground 2")
    ]
    assert words(drawn(laid_out(0.0, 40000.0), measure)) == []
    assert words(drawn(laid_out(height=64.0), measure)) == []  # rows too low to be read


def test_a_bar_cut_by_the_editor_keeps_its_name_in_sight() -> None:
    bars = laid_out(250.0, 300.0)
    (name,) = [t for t in drawn(bars, measure).texts if t.words == "Left heel 2"]
    assert 0.0 <= name.x < 20.0


def test_nothing_is_drawn_beyond_the_rows() -> None:
    bars = laid_out(100.0, 250.0)
    picture = drawn(bars, measure)
    for corners in (picture.triangles, picture.lines):
        assert corners[:, 0].min() >= -2.0
        assert corners[:, 0].max() <= 802.0
        assert corners[:, 1].min() >= bars.room.bottom - 0.01
        assert corners[:, 1].max() <= bars.room.top + 0.01


def test_hatching_stays_inside() -> None:
    strokes = hatch(Rect(10.0, 5.0, 60.0, 20.0), 7.0)
    assert len(strokes) > 5
    assert strokes[..., 0].min() >= 10.0
    assert strokes[..., 0].max() <= 60.0
    assert strokes[..., 1].min() >= 5.0
    assert strokes[..., 1].max() <= 20.0


def test_phases_follow_from_what_touches() -> None:
    spans = phases([(60.0, 136.0), (100.0, 175.0), (231.0, 400.0)], 60.0, 330.0)
    assert [(s.name, s.start, s.end) for s in spans] == [
        ("ground 1", 60.0, 175.0),
        ("flight 1", 175.0, 231.0),
        ("ground 2", 231.0, 330.0),
    ]
