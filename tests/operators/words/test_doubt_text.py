"""What is told before a fit as hardly meant, and what is not."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.doubt_text import (
    distance_doubts,
    doubts_of,
    floor_doubts,
    rise_doubts,
    up_doubts,
)
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    AddedMass,
    AngleLimit,
    BodyChange,
    PointRequest,
    Requests,
    When,
)
from hangtime.solver.doctor.repairs import UpAxis

FRAMES = np.arange(140.0, 331.0)
USUAL = MotionProblem(frames=(140.0, 330.0), mass=70.0)


def asking(**body: object) -> MotionProblem:
    return replace(USUAL, requests=Requests(body=BodyChange(**body)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "problem",
    [
        USUAL,
        replace(USUAL, frames=None),
        replace(USUAL, frames=(-np.inf, np.inf)),
        replace(USUAL, mass=22.0, height=1.2),
        asking(added=(AddedMass("Briefcase", "Hand", share=0.2),), gravity=1.62),
    ],
)
def test_usual_amounts_are_not_asked_about(problem: MotionProblem) -> None:
    assert doubts_of(problem, 1.76, FRAMES) == []


@pytest.mark.parametrize(
    ("problem", "words"),
    [
        (replace(USUAL, frames=(140.0, 9999.0)), "Frame 9999 was asked for"),
        (replace(USUAL, frames=(-50.0, 330.0)), "begins at 140"),
        (replace(USUAL, height=1.2), "70 kg is a mass that nobody of 1.20 m has"),
        (replace(USUAL, height=0.1), "nobody of 10.0 cm has; people's build gives 120 to 450 g."),
        (replace(USUAL, height=0.4), "nobody of 40.0 cm has; people's build gives 1.9 to 7.2 kg."),
        (asking(added=(AddedMass("Anvil", "Hand", share=20.0),)), "“Anvil”: 20 times"),
        (asking(added=(AddedMass("Anvil", "Hand", mass=1400.0),)), "“Anvil”: 20 times"),
        (asking(gravity=98.1), "Gravity is 98.1"),
        (asking(mass=700.0), "700 kg is a mass that nobody of 1.76 m has"),
        (asking(mass=7.0), "7 kg is a mass that nobody"),
    ],
)
def test_amounts_that_nobody_means_are_told(problem: MotionProblem, words: str) -> None:
    (told,) = doubts_of(problem, 1.76, FRAMES)
    assert words in told


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ((1.0, 900.0), True),
        ((-50.0, 200.0), True),
        ((150.0, 200.0), False),
        ((800.0, 900.0), False),
    ],
)
def test_a_request_that_goes_on_beyond_the_clip_is_told(
    asked: tuple[float, float], *, told: bool
) -> None:
    """What is all beside it is refused."""
    limit = AngleLimit("Bent", "Leg.L", None, 1.9, When(frames=asked))
    lines = doubts_of(MotionProblem(requests=Requests(angles=(limit,))), 1.76, FRAMES)
    begins, ends = FRAMES[0], FRAMES[-1]
    words = f"“Bent” is about frames {asked[0]:g} to {asked[1]:g}, but the adapted frames are "
    assert lines == (
        [f"{words}{begins:g} to {ends:g}, and it holds in these alone"] if told else []
    )


HEADS = np.array([[[0.0, 0.0, 1.0], [0.1, 0.0, 0.1]], [[2.0, 0.0, 1.0], [2.1, 0.0, 0.1]]])


@pytest.mark.parametrize(
    "pin",
    [Pin("Landing", "ground 2", offset=(5.0, 0.0, 2.0)), Pin("On", "ground 2", place=(9, 0, 0))],
)
def test_places_within_a_jump_are_not_asked_about(pin: Pin) -> None:
    assert distance_doubts(replace(USUAL, pins=(pin,)), HEADS) == []


def test_places_that_nobody_means_are_told_by_name_and_the_furthest_distance() -> None:
    pins = (
        Pin("Near", "ground 1", offset=(0.1, 0.0, 0.0)),
        Pin("Landing", "ground 2", offset=(40.0, 0.0, 0.0)),
        Pin("Elsewhere", "ground 3", place=(102.1, 0.0, 0.1)),
    )
    points = (PointRequest("Moon", "Hand", When(), place=(52.0, 0.0, 1.0)),)
    (told,) = distance_doubts(replace(USUAL, pins=pins, requests=Requests(points=points)), HEADS)
    assert told.startswith("“Landing”, “Elsewhere”, “Moon”: 100 m away")


def test_a_point_that_nobody_jumps_to_is_told_but_on_the_moon() -> None:
    requests = Requests(points=(PointRequest("Ball", "Hand", When(), place=(2.0, 0.0, 3.0)),))
    (told,) = distance_doubts(replace(USUAL, requests=requests), HEADS)
    assert told.startswith("“Ball” is 2.00 m above all that was recorded")
    moon = replace(requests, body=BodyChange(gravity=1.62))
    assert distance_doubts(replace(USUAL, requests=moon), HEADS) == []


def test_a_point_in_the_ground_is_told_where_nothing_stands_lower() -> None:
    requests = Requests(points=(PointRequest("Ball", "Hand", When(), place=(2.0, 0.0, -2.0)),))
    asked = replace(USUAL, requests=requests)
    (told,) = distance_doubts(asked, HEADS)
    assert told.startswith("“Ball” is 2.10 m below all that was recorded, in the ground")
    down = Pin("Down", "ground 2", offset=(0.0, 0.0, -2.0))
    assert distance_doubts(replace(asked, pins=(down,)), HEADS) == []


def test_a_child_with_a_man_s_mass_is_told_by_its_measured_height() -> None:
    assert "1.20 m" in doubts_of(USUAL, 1.2, FRAMES)[0]


@pytest.mark.parametrize("stated", [5.0, 1e6, -0.5, 300.0])
def test_a_floor_on_which_no_foot_stands_is_told_with_where_they_stand(stated: float) -> None:
    (told,) = floor_doubts(stated, 0.02 - stated, on_objects=False)
    assert f"floor = {stated:g}" in told
    assert "stand at 0.02 m" in told


@pytest.mark.parametrize(
    ("stated", "feet", "on_objects"),
    [(0.0, 0.4, False), (0.12, 0.0, False), (0.12, -0.08, False), (-0.4, 0.4, True)],
)
def test_a_floor_within_soles_or_below_objects_is_not_asked_about(
    stated: float, feet: float, on_objects: bool
) -> None:
    assert floor_doubts(stated, feet, on_objects=on_objects) == []


def test_a_rise_that_takes_the_feet_off_is_told() -> None:
    (told,) = rise_doubts(-4.0)
    assert "rise = -4" in told
    assert rise_doubts(0.2) == []


def test_a_figure_that_was_turned_to_lie_is_told() -> None:
    (told,) = up_doubts(UpAxis.X, lies=True)
    assert "up = X" in told
    assert up_doubts(UpAxis.Z, lies=True) == up_doubts(UpAxis.MINUS_Y, lies=False) == []
