"""What is told before a fit as hardly meant, and what is not."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.doubt_text import doubts_of
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import AddedMass, BodyChange, PhaseTiming, Requests

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
        (asking(added=(AddedMass("Anvil", "Hand", share=20.0),)), "“Anvil”: 20 times"),
        (asking(added=(AddedMass("Anvil", "Hand", mass=1400.0),)), "“Anvil”: 20 times"),
        (asking(gravity=98.1), "Gravity is 98.1"),
        (
            replace(USUAL, requests=Requests(timings=(PhaseTiming("Slow", "flight 1", 40.0),))),
            "“Slow” lets flight 1 last 40 times",
        ),
    ],
)
def test_amounts_that_nobody_means_are_told(problem: MotionProblem, words: str) -> None:
    (told,) = doubts_of(problem, 1.76, FRAMES)
    assert words in told


def test_a_child_with_a_man_s_mass_is_told_by_its_measured_height() -> None:
    assert "1.20 m" in doubts_of(USUAL, 1.2, FRAMES)[0]
