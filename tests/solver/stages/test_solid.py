"""Solid by default: nothing new goes through floor or limbs; what cannot be kept out is told."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.operators.words.headline import headline
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.requests import Lift, PointRequest, Requests, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.results.report import report
from hangtime.solver.solid.solid_world import floor_heights
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import set_up
from hangtime.solver.stages.surroundings import floor_of
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.validity import assert_valid

NEW = 0.005  # m, of what may go in


def soft(problem: MotionProblem) -> MotionProblem:
    """The same where nothing is solid."""
    solution = replace(problem.requests.solution, solid=False)
    return replace(problem, requests=replace(problem.requests, solution=solution))


def new_depths(adaptation: Adaptation, solid: Adaptation) -> dict[str, float]:
    """m, by the names of what is in what. solid: the same with floor and limbs solid."""
    world = solid.setup.solid
    assert world is not None
    return {each.name: each.amount for each in world.penetrations(adaptation.motion).worst()}


def at_bone(bone: str, seconds: float, place: np.ndarray, **more: object) -> MotionProblem:
    """A bone's head is asked to a place for a moment."""
    frame = float(fitted_hop().performance.recording.frames[0]) + 120.0 * seconds
    when = When(frames=(frame - 1.0, frame + 1.0))
    x, y, z = place.tolist()
    asked = PointRequest("Reach", bone, when, offset=(0.0, 0.0, 0.0), place=(x, y, z), **more)
    return MotionProblem(requests=Requests(points=(asked,)))


def in_thigh() -> MotionProblem:
    """The left wrist is asked into the middle of the left thigh, as it was in the fit."""
    hip, knee = fitted_hop().motion.joint_centres(np.array([0.3]))[0, [1, 2]]
    return at_bone("LeftHand", 0.3, 0.5 * (hip + knee))


@cache
def through_thigh() -> Adaptation:
    """The same where nothing is solid."""
    return adapt(fitted_hop(), soft(in_thigh()))


@pytest.mark.slow
def test_a_foot_stays_above_the_floor() -> None:
    """In flight the ankle is asked nearly as low as it stands, which pushes the ball in."""
    height = np.array([0.0, 0.0, fitted_hop().schedule.floor_m + 0.1])
    free = (None, None)
    problem = at_bone("LeftFoot", 0.6, height, bounds=(free, free, (0.0, 0.0)))
    adaptation = adapt(fitted_hop(), problem)
    before = new_depths(adapt(fitted_hop(), soft(problem)), adaptation)
    assert before["Left foot in the floor"] > 0.01
    assert adaptation.solved
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    assert max(new_depths(adaptation, adaptation).values(), default=0.0) < NEW


@pytest.mark.slow
def test_a_hand_stays_out_of_the_thigh() -> None:
    adaptation = adapt(fitted_hop(), in_thigh())
    before = new_depths(through_thigh(), adaptation)
    assert before["Left hand in left thigh"] > 0.05
    assert adaptation.solved
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    assert max(new_depths(adaptation, adaptation).values(), default=0.0) < NEW
    rows = report(adaptation, in_thigh(), Origin("hop")).conditions
    kept = {row.name: row for row in rows if row.kind is RowKind.SOLID}
    assert kept["Left hand in left thigh"].met


@pytest.mark.slow
def test_limbs_alone_are_in_each_other_as_in_the_whole_world() -> None:
    world = set_up(fitted_hop(), in_thigh()).solid
    assert world is not None
    motion = through_thigh().motion
    whole, alone = (
        {each.name: each.amount for each in solids.penetrations(motion).worst()}
        for solids in (world, world.limbs_alone())
    )
    assert alone["Left hand in left thigh"] > 0.05
    assert alone == {name: depth for name, depth in whole.items() if "floor" not in name}


def test_a_fit_alone_is_unchanged() -> None:
    solid, without = (
        adapt(fitted_hop(), problem) for problem in (MotionProblem(), soft(MotionProblem()))
    )
    np.testing.assert_array_equal(solid.outcome.x, without.outcome.x)


@pytest.mark.slow
def test_what_is_off_has_no_rows() -> None:
    adaptation = through_thigh()
    assert adaptation.setup.solid is None
    assert adaptation.motion.transcription.guard(RowKind.SOLID) is None
    told = report(adaptation, soft(in_thigh()), Origin("hop"))
    assert not told.recorded_overlaps
    assert all(each.kind is not RowKind.SOLID for each in told.conditions)


@pytest.mark.slow
def test_what_is_asked_for_under_the_floor_is_reached_and_told() -> None:
    """The ball of the foot is asked lower than a foot is thick, which no foot can be; how far its
    joints may go is not the question here."""
    height = np.array([0.0, 0.0, fitted_hop().schedule.floor_m + 0.02])
    free = (None, None)
    problem = at_bone("LeftToeBase", 0.6, height, bounds=(free, free, (0.0, 0.0)))
    solution = replace(problem.requests.solution, human=HumanRanges.OFF)
    problem = replace(problem, requests=replace(problem.requests, solution=solution))
    adaptation = adapt(fitted_hop(), problem)
    assert adaptation.solved
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    told = report(adaptation, problem, Origin("hop"))
    assert [row.met for row in told.conditions if row.name == "Reach"] == [True]
    assert {row.name for row in told.given_up} >= {"Left foot in the floor"}
    assert any("Left foot in the floor" in line for line in headline(told))


def test_the_recordings_own_overlaps_are_told_once() -> None:
    told = report(adapt(fitted_hop(), MotionProblem()), MotionProblem(), Origin("hop"))
    assert told.recorded_overlaps
    assert not told.given_up


def test_a_landing_that_is_pinned_lower_has_its_own_floor() -> None:
    schedule = fitted_hop().schedule
    places = np.array([contact.place for contact in schedule.contacts])
    places[:, 2] = schedule.floor_m
    landing = schedule.of_phase(schedule.phases[-1])
    places[[c in landing for c in schedule.contacts], 2] -= 0.2
    heights = floor_heights(schedule, places)(np.array([0.1, 0.6, 1.2]))
    floor = schedule.floor_m
    assert heights == pytest.approx([floor, floor - 0.2, floor - 0.2])


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_the_floor_stays_where_it_was_recorded_when_a_foot_is_lifted(side: str) -> None:
    """One of the two stood the lowest. Without it the floor rose into the other foot."""
    fit = fitted_hop()
    lift = Lift("one leg", "ground 2", (f"{side}Foot", f"{side}ToeBase"))
    setup = set_up(fit, MotionProblem(requests=Requests(lifts=(lift,))))
    times = np.linspace(0.0, setup.start.duration, 50)
    before = floor_heights(fit.schedule, fit.places)(setup.context.timeline.to_old(times))
    assert floor_of(fit, setup.context, setup.target_places)(times) == pytest.approx(before)


def test_solid_is_what_is_asked_for_by_default() -> None:
    assert SolverOptions().solid
