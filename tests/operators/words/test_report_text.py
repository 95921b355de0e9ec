"""The report's words for differences."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from hangtime.operators.words.report_text import (
    fit_excess_lines,
    gravity_lines,
    higher,
    moving_ground_lines,
)
from hangtime.solver.data.contacts import phase_title
from hangtime.solver.data.reports.joints import RecordedRange
from hangtime.solver.data.reports.report import RecordedOverlap


@pytest.mark.parametrize(
    ("centimetres", "said"),
    [
        (1.34, "1.3 cm higher"),
        (-1.34, "1.3 cm lower"),
        (0.04, "as high as recorded"),
        (-0.0, "as high as recorded"),
    ],
)
def test_a_difference_of_heights_is_said_where_there_is_one(centimetres: float, said: str) -> None:
    assert higher(centimetres) == said


def test_body_weights_are_told_to_be_the_earths_where_gravity_is_another() -> None:
    assert gravity_lines(9.81) == []
    assert gravity_lines(1.62) == ["1.62 m/s²; body weights (BW) are those on Earth all the same"]


@pytest.mark.parametrize(
    ("phase", "shown"), [("Bar Grab", "Bar Grab"), ("ground 2", "Ground 2"), ("hang on", "hang on")]
)
def test_the_artists_name_of_a_held_frame_is_told_as_it_was_given(phase: str, shown: str) -> None:
    ride = SimpleNamespace(phase=phase, moved_m=(0.5, 0.0), object=None)
    (line,) = moving_ground_lines(SimpleNamespace(moving_ground=(ride,)))
    assert line == f"{shown:<11} is carried on by 0.50 m, with the speed of the ground left"
    assert phase_title(phase) == shown


def test_what_is_measured_on_the_fit_is_not_told_of_the_recording() -> None:
    overlaps = (RecordedOverlap("Right thigh in the floor", 446.0, 39.0),)
    ranges = (RecordedRange("Left ankle bends", 205.0, 39.0),)
    made = SimpleNamespace(recorded_overlaps=overlaps, recorded_ranges=ranges)
    assert [line.strip() for line in fit_excess_lines(made)] == [
        "it has right thigh in the floor by 446 mm (frame 39), which the result may keep",
        "its left ankle bends 205° beyond a person's range (frame 39), which the result may keep",
    ]
