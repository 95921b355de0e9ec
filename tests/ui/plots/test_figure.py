"""Plots before they are painted: axes, cards, legends, playhead; no Blender."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hangtime.bridge.plots.curves import Cap, Chart, Curve, Take
from hangtime.bridge.plots.screen import Axis, Rect, round_range
from hangtime.bridge.rows.phases import phases
from hangtime.ui.plots import looks
from hangtime.ui.plots.drawing import playhead, readings, still
from hangtime.ui.plots.figure import PlotFigure, lay_out
from hangtime.ui.plots.layout import cards, free_room
from hangtime.ui.plots.numbers import number, thinned

FRAMES = np.arange(60.0, 331.0)
FALL = np.where(FRAMES < 200.0, 2.7, 0.0)
CARD = Rect(10.0, 8.0, 310.0, 158.0)


def measure(words: str, size: float) -> float:
    return 0.6 * size * len(words)


def chart(*caps: Cap, values: np.ndarray = FALL) -> Chart:
    curve = Curve(Take.ADAPTED, FRAMES, values)
    return Chart("Contact Force", "body weights", (curve,), 2, caps=caps)


def laid_out(*charts: Chart, card: Rect = CARD, scale: float = 1.0) -> PlotFigure:
    spans = phases([(60.0, 175.0), (231.0, 330.0)], 60.0, 330.0)
    beside = [
        Rect(card.left + i * 400.0, card.bottom, card.right + i * 400.0, card.top)
        for i in range(len(charts))
    ]
    made = lay_out(charts, spans, tuple(beside), scale, measure)
    assert made is not None
    return made


# ---------------------------------------------------------------- axes


@pytest.mark.parametrize(
    ("first", "last", "ticks"),
    [
        (60.0, 330.0, (100.0, 200.0, 300.0)),
        (0.0, 4.0, (0.0, 1.0, 2.0, 3.0, 4.0)),
        (-0.13, 0.21, (-0.1, 0.0, 0.1, 0.2)),
        (1000.0, 1003.0, (1000.0, 1001.0, 1002.0, 1003.0)),
    ],
)
def test_ticks_are_round_and_apart(first: float, last: float, ticks: tuple[float, ...]) -> None:
    axis = Axis(first, last, 0.0, 200.0)
    assert axis.ticks(45.0) == pytest.approx(ticks)


def test_frames_are_never_marked_between_whole_ones() -> None:
    assert Axis(10.0, 12.0, 0.0, 800.0).ticks(46.0, finest=1.0) == (10.0, 11.0, 12.0)


@pytest.mark.parametrize(
    "values", [(0.0, 2.7), (0.83, 1.21), (0.0, 0.0), (5.0, 5.0), (-3.0, 410.0)]
)
def test_axes_end_at_round_values_around_what_is_shown(values: tuple[float, float]) -> None:
    low, high = round_range(*values, 4)
    assert low <= values[0]
    assert high >= values[1]
    assert high > low
    assert high - low <= 2.6 * max(values[1] - values[0], abs(values[1]), 1.0)


def test_numbers() -> None:
    assert number(2.345, 1) == "2.3"
    assert number(-0.001, 2) == "0.00"
    assert number(-12.0, 0) == "\N{MINUS SIGN}12"


def test_a_long_curve_keeps_its_peak() -> None:
    frames, values = np.arange(10000.0), np.zeros(10000)
    values[4321] = 7.0
    few, thin = thinned(frames, values, 200)
    assert len(few) <= 402
    assert thin.max() == 7.0
    assert few[thin.argmax()] == 4321.0
    assert (np.diff(few) > 0.0).all()


# ---------------------------------------------------------------- cards


def test_cards_avoid_what_lies_upon_the_viewport() -> None:
    overlaps = (
        ("LEFT", Rect(0.0, 0.0, 58.0, 640.0)),
        ("RIGHT", Rect(1000.0, 0.0, 1300.0, 640.0)),
        ("TOP", Rect(0.0, 640.0, 1300.0, 692.0)),
        ("BOTTOM", Rect(0.0, -81.0, 1300.0, 0.0)),  # below, not upon it
    )
    free = free_room(1300.0, 692.0, overlaps)
    assert free == Rect(58.0, 0.0, 1000.0, 640.0)
    places = cards(free, 4, 1.0)
    assert len(places) == 4
    for place in places:
        assert place.left >= 58.0
        assert place.right <= 1000.0
        assert place.top <= 0.4 * 640.0
    assert all(a.right < b.left for a, b in pairwise(places))


def test_small_viewports_show_fewer_cards_or_none() -> None:
    assert len(cards(Rect(0.0, 0.0, 620.0, 300.0), 4, 1.0)) == 3
    assert len(cards(Rect(0.0, 0.0, 620.0, 600.0), 4, 1.0)) == 4  # two below two
    assert cards(Rect(0.0, 0.0, 150.0, 600.0), 4, 1.0) == ()
    assert cards(Rect(0.0, 0.0, 900.0, 200.0), 4, 1.0) == ()
    assert cards(Rect(0.0, 0.0, 0.0, 0.0), 4, 1.0) == ()
    assert cards(Rect(0.0, 0.0, 900.0, 900.0), 0, 1.0) == ()


# ---------------------------------------------------------------- what is drawn


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_everything_stays_in_its_card(scale: float) -> None:
    card = Rect(0.0, 0.0, 300.0 * scale, 150.0 * scale)
    made = laid_out(chart(Cap("Soft landing", 231.0, 330.0, 2.0)), card=card, scale=scale)
    picture = still(made, measure)
    for corners in (picture.triangles, picture.lines):
        assert corners.min() >= 0.0
        assert corners[:, 0].max() <= card.right
        assert corners[:, 1].max() <= card.top
    for text in (*picture.texts, *readings(made, 231.0)):
        width = measure(text.words, text.size)
        left = text.x - text.align.value * width
        assert left >= 0.0, text
        assert left + width <= card.right, text
        assert 0.0 <= text.y <= card.top - text.size, text


def test_title_unit_legend_ticks_and_phases_are_written() -> None:
    made = laid_out(chart())
    words = [text.words for text in still(made, measure).texts]
    for each in ("Contact Force", "(body weights)", "Adapted", "ground 1", "flight 1", "ground 2"):
        assert each in words
    assert {"0", "1", "2", "3"} <= set(words)
    assert {"100", "200", "300"} <= {text.words for text in readings(made, 500.0)}


def test_the_value_at_the_playhead_is_printed() -> None:
    made = laid_out(chart(values=FRAMES / 100.0))
    assert "2.32" in [text.words for text in readings(made, 232.0)]
    assert "231.5" in [text.words for text in readings(made, 231.5)]
    axis = made.panels[0].frames
    assert made.playhead(231.5) == pytest.approx(axis.at(231.5) - axis.start)


def test_beyond_the_clip_there_is_neither_playhead_nor_value() -> None:
    made = laid_out(chart())
    assert made.playhead(400.0) is None
    assert not {"0.00", "400"} & {text.words for text in readings(made, 400.0)}


def test_one_shift_moves_the_playheads_of_all_charts() -> None:
    wide = chart(values=1000.0 * FALL)  # with broader numbers beside its axis
    made = laid_out(chart(), wide)
    a, b = made.panels
    assert a.plot.left - a.card.left == pytest.approx(b.plot.left - b.card.left)
    shift = made.playhead(200.0)
    lines = playhead(made).lines
    for panel in made.panels:
        assert shift is not None
        assert np.abs(lines[:, 0] + shift - panel.frames.at(200.0)).min() < 0.01


def dashes(made: PlotFigure) -> np.ndarray:
    picture = still(made, measure)
    return picture.lines[(picture.strokes == np.float32(looks.CAP)).all(axis=1)]


def test_a_cap_is_a_dashed_line_over_its_frames() -> None:
    made = laid_out(chart(Cap("Soft landing", 231.0, 280.0, 2.0)))
    panel, ends = made.panels[0], dashes(made)
    assert ends[:, 0].min() == pytest.approx(panel.frames.at(231.0), abs=0.01)
    assert ends[:, 0].max() <= panel.frames.at(280.0) + 0.01
    assert ends[:, 1] == pytest.approx(panel.values.at(2.0), abs=0.01)
    assert "Soft landing 2.0" in [text.words for text in still(made, measure).texts]


def test_a_cap_far_above_does_not_flatten_the_curve() -> None:
    made = laid_out(chart(Cap("Weak", -np.inf, np.inf, 50.0)))
    assert made.panels[0].values.last == pytest.approx(3.0)
    assert len(dashes(made)) == 0
    assert "Weak 50 ↑" in [text.words for text in still(made, measure).texts]


def test_a_chart_without_curves_says_why() -> None:
    empty = Chart("Torque", "N·m", (), 0, missing="Select a bone in Pose Mode")
    made = laid_out(chart(), empty)
    words = [text.words for text in still(made, measure).texts]
    assert "Select a bone in Pose Mode" in words
    assert lay_out((empty,), (), (CARD,), 1.0, measure) is None
