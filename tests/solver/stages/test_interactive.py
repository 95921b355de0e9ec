"""A motion that follows a dragged pin: quick, smooth, and near what the solve then finds."""

from dataclasses import replace
from math import degrees

import numpy as np
import pytest
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import ForceRequest, Requests
from hangtime.solver.data.solver_options import HumanRanges
from hangtime.solver.data.status import DragStatus
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.interactive import Follower
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.motion import dynamics_residual
from hangtime.tests.helpers.fitted_hop import fitted_hop


def moved(forward: float, up: float = 0.0) -> MotionProblem:
    return MotionProblem(pins=(Pin("Landing", "ground 2", offset=(forward, 0.0, up)),))


def careless(problem: MotionProblem, *, solid: bool) -> MotionProblem:
    """The same of a figure that is no human, whose feet and arms go further astray."""
    solution = replace(problem.requests.solution, human=HumanRanges.OFF, solid=solid)
    return replace(problem, requests=replace(problem.requests, solution=solution))


def free(problem: MotionProblem) -> MotionProblem:
    """The same of a figure that is no human."""
    solution = replace(problem.requests.solution, human=HumanRanges.OFF)
    return replace(problem, requests=replace(problem.requests, solution=solution))


def settled(follower: Follower, problem: MotionProblem, most: int = 30) -> int:
    """Updates until the pin is reached."""
    for update in range(1, most + 1):
        if follower.follow(problem) is DragStatus.CONVERGED:
            return update
    raise AssertionError(f"not there after {most} updates")


@pytest.mark.slow
def test_the_ghost_is_near_the_solve() -> None:
    fit = fitted_hop()
    follower = Follower(fit, moved(0.0))
    for step in range(1, 6):
        follower.follow(moved(0.04 * step, 0.02 * step))
    settled(follower, moved(0.2, 0.1))
    solved = adapt(fit, moved(0.2, 0.1))
    times = np.linspace(0.0, fit.motion.duration, 100)
    apart = follower.motion.joint_centres(times) - solved.motion.joint_centres(times)
    assert np.linalg.norm(apart, axis=2).max() < 0.05
    left = dynamics_residual(follower.motion, np.linspace(0.01, fit.motion.duration - 0.01, 200))
    assert np.sqrt((left.moment**2).sum(axis=1).mean()) < 0.003


def deepest(follower: Follower) -> float:
    """How deep floor and limbs are in each other, m, beyond the fit."""
    setup = set_up(fitted_hop(), moved(0.0))
    assert setup.solid is not None
    world = replace(setup.solid, to_old=lambda times: times)
    return max((each.amount for each in world.penetrations(follower.motion).worst()), default=0.0)


@pytest.mark.slow
def test_floor_and_limbs_are_solid_while_the_pin_is_dragged() -> None:
    kept, through = (
        Follower(fitted_hop(), careless(moved(0.0), solid=solid)) for solid in (True, False)
    )
    depths = []
    for step in range(1, 13):
        kept.follow(careless(moved(0.05 * step), solid=True))
        through.follow(careless(moved(0.05 * step), solid=False))
        depths.append((deepest(kept), deepest(through)))
    most = np.max(depths, axis=0)
    assert most[0] < 0.005 < 0.01 < most[1]


def furthest_bent(follower: Follower) -> float:
    """How far a joint is beyond its range, degrees."""
    human = set_up(fitted_hop(), moved(0.0)).human
    assert human is not None
    return max((degrees(each.amount) for each in human.violations(follower.motion)), default=0.0)


@pytest.mark.slow
def test_joints_keep_to_their_ranges_while_the_pin_is_dragged() -> None:
    kept, any_body = Follower(fitted_hop(), moved(0.0)), Follower(fitted_hop(), free(moved(0.0)))
    beyond = []
    for step in range(1, 31):
        kept.follow(moved(0.02 * step))
        any_body.follow(free(moved(0.02 * step)))
        beyond.append((furthest_bent(kept), furthest_bent(any_body)))
    most = np.max(beyond, axis=0)
    assert most[0] < 3.0 < 2.0 * most[0] + 3.0 < most[1]


@pytest.mark.slow
def test_times_follow_once_the_pin_rests() -> None:
    fit = fitted_hop()
    follower = Follower(fit, moved(0.0))
    for step in range(1, 6):
        follower.follow(moved(0.03 * step))
        assert follower.motion.duration == fit.motion.duration
    settled(follower, moved(0.15))
    assert follower.motion.duration == adapt(fit, moved(0.15)).motion.duration
    assert follower.motion.duration > fit.motion.duration + 0.005
    settled(follower, moved(0.0))
    assert follower.motion.duration == fit.motion.duration


@pytest.mark.slow
def test_a_far_jump_of_the_mouse_takes_some_updates() -> None:
    follower = Follower(fitted_hop(), moved(0.0))
    assert follower.follow(moved(0.9)) is DragStatus.CONVERGING
    assert 1 < settled(follower, moved(0.9)) < 30


@pytest.mark.slow
def test_where_nobody_can_jump_the_motion_stays_where_it_last_could_follow() -> None:
    follower = Follower(fitted_hop(), moved(0.0))
    settled(follower, moved(0.1))
    for _ in range(60):
        if follower.follow(moved(30.0)) is DragStatus.DIVERGED:
            break
    else:
        raise AssertionError("thirty metres were reached")
    times = np.linspace(0.0, follower.motion.duration, 300)
    forces = np.linalg.norm(follower.motion.forces(times).sum(axis=1), axis=1)
    assert forces.max() / (follower.motion.transcription.character.mass * 9.81) < 100.0
    settled(follower, moved(0.1), most=60)


@pytest.mark.slow
def test_it_goes_back_to_where_it_began() -> None:
    fit = fitted_hop()
    follower = Follower(fit, moved(0.0))
    settled(follower, moved(0.15))
    settled(follower, moved(0.0))
    times = np.linspace(0.0, fit.motion.duration, 100)
    apart = follower.motion.joint_centres(times) - fit.motion.joint_centres(times)
    assert np.linalg.norm(apart, axis=2).max() < 0.01


@pytest.mark.slow
def test_it_begins_at_an_adaptation_of_the_same_problem() -> None:
    fit = fitted_hop()
    last = adapt(fit, moved(0.2))
    follower = Follower(fit, moved(0.2), last)
    assert follower.follow(moved(0.2)) is DragStatus.CONVERGED
    times = np.linspace(0.0, fit.motion.duration, 100)
    apart = follower.motion.joint_centres(times) - last.motion.joint_centres(times)
    assert np.linalg.norm(apart, axis=2).max() < 0.003
    settled(follower, moved(0.22))


@pytest.mark.slow
def test_other_requests_than_pins_are_taken_in() -> None:
    follower = Follower(fitted_hop(), moved(0.1))
    settled(follower, moved(0.1))
    cap = ForceRequest("Softer", peak=2.6)
    softer = replace(moved(0.1), requests=Requests(forces=(cap,)))
    settled(follower, softer, most=30)
    times = np.linspace(0.0, follower.motion.duration, 500)
    forces = np.linalg.norm(follower.motion.forces(times).sum(axis=1), axis=1)
    weight = follower.motion.transcription.character.mass * 9.81
    assert forces.max() / weight == pytest.approx(2.6, abs=0.1)
