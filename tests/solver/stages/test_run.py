"""The run of the gallery: its contacts, its fit, and every recipe that changes it."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hangtime.bridge.recipe.problem import parse_recipe, read_recipe_text
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.body.anatomy import Part
from hangtime.solver.constraints.joint_constraints import bend_function
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.human.human_guard import MOST_BEYOND
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import Setup
from hangtime.solver.transcription.constraint import dense_violation
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.validity import assert_valid, joint_error, measure

RUN = "run_3.bvh"
RECIPES = sorted((Path(__file__).parents[3] / "examples" / "gallery").glob("run_*.toml"))
NAMES = [recipe.stem for recipe in RECIPES]
HARDEST = 4.5  # BW; a hurdler's landing


def problem_of(name: str) -> MotionProblem:
    recipe = RECIPES[NAMES.index(name)]
    return parse_recipe(read_recipe_text(recipe)).problem


@cache
def run() -> Analysis:
    return analyse(load_recording(RUN), problem_of("run_fit"))


@cache
def fitted() -> Fit:
    return fit(run().performance, run().schedule)


@cache
def adapted(name: str) -> Adaptation:
    return adapt(fitted(), problem_of(name))


def flights(setup: Setup) -> list[float]:
    """Durations, s."""
    return [p.end - p.start for p in setup.schedule.phases if p.kind is PhaseKind.FLIGHT]


def apex(name: str, flight: int) -> float:
    """Height of the centre of mass, m."""
    found = adapted(name)
    span = found.setup.schedule.flights[flight]
    return float(found.motion.com(np.linspace(span.start, span.end, 50))[:, 2].max())


def test_all_eight_are_there_and_begin_with_what_they_are() -> None:
    steps = {"cross_step", "wide_step", "bouncy_step", "skip_step", "cross_step_pca"}
    assert set(NAMES) == {f"run_{s}" for s in {*steps, "wide_step_pca", "hurdle", "fit"}}
    for recipe in RECIPES:
        assert read_recipe_text(recipe).startswith("# "), recipe.name


def test_they_share_one_fit() -> None:
    window = problem_of("run_fit")
    for name in NAMES:
        problem = problem_of(name)
        assert (problem.frames, problem.mass, problem.contacts) == (window.frames, 70.0, ()), name


def test_four_stances_on_alternate_feet_with_flights_between() -> None:
    schedule = run().schedule
    stances = [p for p in schedule.phases if p.kind is PhaseKind.GROUND]
    sides = [{c.point.split()[0] for c in schedule.of_phase(p)} for p in stances]
    assert sides == [{"Right"}, {"Left"}, {"Right"}, {"Left"}]
    assert all(0.1 < f.end - f.start < 0.2 for f in schedule.flights)
    assert len(schedule.flights) == 3


@pytest.mark.slow
def test_fit_is_near_the_recording() -> None:
    found = fitted()
    assert found.solved
    assert joint_error(found) < 0.017
    times = found.performance.times
    centres = found.motion.joint_centres(times)
    for flight in found.schedule.flights:
        inside = (times >= flight.start) & (times <= flight.end)
        apexes = [h[inside, 0, 2].max() for h in (centres, found.performance.centres)]
        assert abs(apexes[0] - apexes[1]) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_recipe_is_solved(name: str) -> None:
    found = adapted(name)
    assert found.solved
    motion, t = found.motion, found.motion.transcription
    for constraint in t.constraints:
        worst = dense_violation(constraint, t.character, t.basis, t.layout, motion.x)
        assert worst.amount <= worst.kind.tolerance, worst
    assert_valid(motion, found.setup.schedule)
    assert measure(motion, found.setup.schedule).peak < HARDEST


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_feet_go_where_the_pins_say(name: str) -> None:
    found, problem = adapted(name), problem_of(name)
    schedule = fitted().schedule
    asked = {pin.phase: np.linalg.norm(pin.offset) for pin in problem.pins}
    for phase in schedule.phases:
        there = [i for i, c in enumerate(schedule.contacts) if c in schedule.of_phase(phase)]
        moved = np.linalg.norm(found.places[there] - fitted().places[there], axis=1)
        # The fit lets contacts settle by millimetres; a pin moves the contact that was found.
        assert moved == pytest.approx(asked.get(phase.name, 0.0), abs=0.01), phase.name


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_no_knee_bends_backwards_and_no_foot_sinks(name: str) -> None:
    found = adapted(name)
    motion, t = found.motion, found.motion.transcription
    times = np.linspace(0.0, motion.duration, 300)
    state = State(t.character, t.layout, Instants(t.basis, times), motion.x)
    for i, body in enumerate(t.character.bodies):
        if body.part is Part.SHANK:
            bend = np.degrees(bend_function(found.setup.context, i).value(state))
            assert bend.min() > -np.degrees(MOST_BEYOND)  # what ranges let be
            assert bend.max() < 135.0  # AAOS 1965
    floor = min(float(c.place[2]) for c in found.setup.schedule.contacts)
    assert motion.contact_points(times)[..., 2].min() > floor - 0.005


@pytest.mark.slow
def test_bounces_are_longer_and_higher() -> None:
    before, after = (flights(adapted(name).setup) for name in ("run_fit", "run_bouncy_step"))
    assert after == pytest.approx([1.6 * seconds for seconds in before], abs=1e-6)
    for flight in range(3):
        assert apex("run_bouncy_step", flight) > apex("run_fit", flight) + 0.02


@pytest.mark.slow
def test_hurdler_flies_longer_and_higher() -> None:
    before, after = (flights(adapted(name).setup) for name in ("run_fit", "run_hurdle"))
    assert after[1:] == pytest.approx([0.36, 0.2], abs=1e-6)
    assert after[0] == pytest.approx(before[0], abs=1e-6)
    assert apex("run_hurdle", 1) > apex("run_fit", 1) + 0.1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run_cross_step", "run_wide_step"])
def test_reduction_keeps_the_joints_in_its_plane(name: str) -> None:
    found = adapted(f"{name}_pca")
    basis = found.setup.basis
    assert basis is not None
    assert basis.shape[1] < basis.shape[0]
    t = found.motion.transcription
    assert t.basis.n_coefficients == fitted().motion.transcription.basis.n_coefficients
    change = found.motion.x - found.setup.start.x
    inside = change @ basis @ np.linalg.pinv(basis.T @ basis) @ basis.T
    assert np.abs(change - inside).max() < 1e-9
