"""What is asked of a motion and hardly meant is told, with its limit; and what is usual is not."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from hangtime.operators.words.request_doubt_text import (
    direction_doubts,
    request_doubts,
)
from hangtime.solver.analysis.leaps import Leap
from hangtime.solver.data.contacts import Phase, PhaseKind
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    AddedMass,
    BodyChange,
    Clear,
    ForceRequest,
    LimbChange,
    OrientationRequest,
    PhaseTiming,
    Requests,
    TorqueLimit,
    When,
)

MOON = BodyChange(gravity=1.62)
PHASES = (Phase(PhaseKind.FLIGHT, 1, 0.8, 1.3), Phase(PhaseKind.GROUND, 2, 1.3, 2.3))


def asking(**requests: object) -> MotionProblem:
    return MotionProblem(requests=Requests(**requests))  # type: ignore[arg-type]


def timed(phase: str, **amount: float) -> MotionProblem:
    return asking(timings=(PhaseTiming("Slow", phase, **amount),))


def pinned(turn: float) -> MotionProblem:
    return MotionProblem(pins=(Pin("Spin", "ground 2", turn=radians(turn)),))


def pushed(friction: float) -> MotionProblem:
    return asking(forces=(ForceRequest("Ice", friction=friction),))


def limbs(length: float) -> MotionProblem:
    return asking(body=BodyChange(limbs=(LimbChange("Shin", ("Leg.L",), length=length),)))


@pytest.mark.parametrize(
    "problem",
    [
        timed("flight 1", seconds=0.7),
        timed("flight 1", factor=2.0),
        timed("ground 2", seconds=3.0),
        asking(body=MOON, timings=(PhaseTiming("Slow", "flight 1", seconds=3.0),)),
        pinned(360.0),
        pushed(1.2),
        limbs(0.6),
        asking(torques=(TorqueLimit("Weak", ("Foot.L",), share=0.5),)),
        asking(clears=(Clear("Over", "Hurdle", 0.3),)),
    ],
)
def test_usual_requests_are_not_asked_about(problem: MotionProblem) -> None:
    assert request_doubts(problem, PHASES, ()) == []


@pytest.mark.parametrize(
    ("problem", "words"),
    [
        (
            timed("flight 1", seconds=20.0),
            "“Slow” lets flight 1 last 20 s (recorded: 0.50 s), for which the body must rise by "
            "490 m; nobody jumps higher than 1.50 m",
        ),
        (timed("flight 1", seconds=3.0), "must rise by 11 m"),
        (timed("flight 1", factor=10.0), "last 5 s (recorded: 0.50 s), for which the body must"),
        (timed("flight 1", seconds=0.05), "last 0.05 s (recorded: 0.50 s), 0.1 times as long"),
        (timed("ground 2", seconds=20.0), "last 20 s (recorded: 1.00 s), 20 times as long"),
        (pinned(-720.0), "“Spin” turns ground 2 by -720°, and the body has to make all of these 2"),
        (
            asking(orientations=(OrientationRequest("Aim", "Hips", When(), radians(730.0)),)),
            "“Aim” asks for 730°, which is 10°",
        ),
        (pushed(50.0), "“Ice” asks for a friction of 50"),
        (limbs(5.0), "“Shin” makes “Leg.L” 5 times as long"),
        (limbs(0.01), "“Shin” makes “Leg.L” 0.01 times as long"),
        (asking(torques=(TorqueLimit("All", ("Foot.L",), bound=1e9),)), "“All” allows 1e+09 N·m"),
        (asking(torques=(TorqueLimit("All", ("Foot.L",), share=50.0),)), "50 times the"),
        (asking(clears=(Clear("Over", "Hurdle", 30.0),)), "“Over” asks for a way 30.00 m above"),
        (asking(body=BodyChange(gravity=0.01)), "a jump takes minutes"),
        (
            asking(body=BodyChange(added=(AddedMass("Bag", "Hand", 1.0, offset=(0.0, 9.0, 0.0)),))),
            "“Bag” is 9.00 m from “Hand”",
        ),
    ],
)
def test_requests_that_nobody_means_are_told(problem: MotionProblem, words: str) -> None:
    (told,) = request_doubts(problem, PHASES, ())
    assert words in told


def landing(asked: tuple[float, float, float], run_up: float = 0.1, **body: float) -> list[str]:
    pin = Pin("Landing", "ground 2", offset=(1.0, 0.0, 0.0))
    problem = replace(asking(body=BodyChange(**body)), pins=(pin,))  # type: ignore[arg-type]
    leap = Leap("ground 1", "ground 2", np.array([1.2, 0.0, 0.0]), np.array(asked), run_up)
    return request_doubts(problem, PHASES, [leap])


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ((1.2, 0.0, 3.0), "“Landing”: ground 2 would be 3.00 m above ground 1, and nobody jumps"),
        ((1.2, 0.0, -3.0), "3.00 m below ground 1, and nobody jumps down more than 2.50 m"),
        ((3.6, 4.8, 0.0), "6.00 m from ground 1, and nobody jumps farther than 3.75 m from stand"),
    ],
)
def test_leaps_that_nobody_makes_are_told_with_the_pin_and_the_limit(
    asked: tuple[float, float, float], words: str
) -> None:
    (told,) = landing(asked)
    assert words in told
    assert landing(asked, gravity=1.62) == []


def test_who_runs_up_jumps_farther() -> None:
    assert landing((8.9, 0.0, 0.0), run_up=11.0) == []
    (told,) = landing((12.0, 0.0, 0.0), run_up=8.0)
    assert "farther than 7.70 m from a run-up at 8.0 m/s" in told


def test_a_recorded_leap_is_not_asked_about_however_far_it_goes() -> None:
    way = np.array([5.0, 0.0, 2.0])
    assert (
        request_doubts(MotionProblem(), PHASES, [Leap("ground 1", "ground 2", way, way, 0)]) == []
    )


def test_a_stance_that_contacts_wind_is_told_once() -> None:
    names = ("Left toe 2", "Left heel 2")
    pins = tuple(Pin(name, "ground 2", turn=radians(720.0)) for name in names)
    (told,) = request_doubts(MotionProblem(pins=pins), PHASES, [])
    assert told.startswith("“Left toe 2”, “Left heel 2” turn ground 2 by 720°, and the body has to")


def test_who_moves_a_backward_landing_forward_is_told_which_way_that_is() -> None:
    ahead, up = (Pin("L", "ground 2", offset=offset) for offset in ((0.2, 0, 0), (0, 0, 0.2)))
    told = direction_doubts(MotionProblem(pins=(ahead,)), ["ground 2"])
    assert told == ["“L”: forward is the way it travels, at the body's back"]
    assert direction_doubts(MotionProblem(pins=(ahead,)), ["ground 1"]) == []
    assert direction_doubts(MotionProblem(pins=(up,)), ["ground 2"]) == []
