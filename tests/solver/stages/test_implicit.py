"""Adaptations of a real hop: pins are met, physics holds, and the impossible ends."""

from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.pins.pinned_places import pinned_places
from hangtime.solver.data.faults import ContradictoryPins, OutOfReach
from hangtime.solver.data.problem import MotionProblem, OffsetAxes, Pin
from hangtime.solver.data.requests import BodyChange, Requests
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.data.status import Status
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.optimisation.sqp import Step
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.motion import dynamics_residual
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.validity import assert_valid

LANDING = "ground 2"
EDITS = {
    "forward": Pin("landing", LANDING, offset=(0.3, 0.0, 0.0)),
    "up": Pin("landing", LANDING, offset=(0.0, 0.0, 0.2)),
    "both": Pin("landing", LANDING, offset=(0.3, 0.0, 0.2)),
    "back": Pin("landing", LANDING, offset=(-0.3, 0.0, 0.0)),
    "aside": Pin("landing", LANDING, offset=(0.0, 0.3, 0.0)),
    "down": Pin("landing", LANDING, offset=(0.0, 0.0, -0.2)),
}
QUICK = {"forward", "both", "down"}  # the others are of the same kinds
ALL = [n if n in QUICK else pytest.param(n, marks=pytest.mark.slow) for n in EDITS]


def adapted(*pins: Pin) -> Adaptation:
    return adapt(fitted_hop(), MotionProblem(pins=pins))


@cache
def edited(name: str) -> Adaptation:
    return adapted(EDITS[name])


@cache
def whole_fit(relative: str) -> Fit:
    """Of a whole recording."""
    analysis = analyse(load_recording(relative), MotionProblem())
    return fit(analysis.performance, analysis.schedule)


def landed() -> np.ndarray:
    schedule = fitted_hop().schedule
    phase = next(p for p in schedule.phases if p.name == LANDING)
    return np.array([c in schedule.of_phase(phase) for c in schedule.contacts])


def contact_places(adaptation: Adaptation) -> np.ndarray:
    """(n_contacts, 3) m: where the points really are in the middle of their contacts."""
    motion = adaptation.motion
    contacts = motion.transcription.contacts
    middles = np.array([0.5 * (c.contact.start + c.contact.end) for c in contacts])
    at = motion.contact_points(middles)
    return at[np.arange(len(contacts)), [c.point for c in contacts]]


@pytest.mark.parametrize("name", ALL)
def test_the_landing_goes_exactly_where_it_is_asked_to(name: str) -> None:
    adaptation = edited(name)
    fitted = fitted_hop()
    assert adaptation.outcome.status is Status.SOLVED
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    goal = pinned_places(MotionProblem(pins=(EDITS[name],)), fitted.performance, fitted.schedule)
    assert np.abs(contact_places(adaptation) - goal).max() < 0.001
    moved = goal - fitted.places
    offset = np.linalg.norm(EDITS[name].offset)
    assert np.linalg.norm(moved[landed()], axis=1) == pytest.approx(offset)
    assert not moved[~landed()].any()


def test_without_pins_the_fit_comes_back() -> None:
    adaptation = adapted()
    assert adaptation.solved
    times = np.linspace(0.0, adaptation.motion.duration, 100)
    same = fitted_hop().motion.joint_centres(times)
    assert adaptation.motion.joint_centres(times) == pytest.approx(same, abs=1e-3)


def test_a_pin_on_both_phases_carries_the_whole_hop() -> None:
    """Nothing but the place changes, so nothing else may."""
    shift = (0.5, 0.3, 0.0)
    pins = [Pin(p, p, offset=shift, axes=OffsetAxes.WORLD) for p in ("ground 1", LANDING)]
    adaptation = adapted(*pins)
    assert adaptation.solved
    times = np.linspace(0.0, adaptation.motion.duration, 100)
    carried = fitted_hop().motion.joint_centres(times) + np.array(shift)
    assert adaptation.motion.joint_centres(times) == pytest.approx(carried, abs=1e-3)


def test_a_longer_jump_rises_or_lasts_as_physics_asks() -> None:
    """In flight the centre of mass is a parabola from take-off to the new landing."""
    adaptation = edited("both")
    flight = adaptation.setup.schedule.flights[0]
    times = np.linspace(flight.start, flight.end, 30)
    com = adaptation.motion.com(times)
    parabola = np.polynomial.polynomial.polyfit(times - times[0], com, 2)
    assert 2.0 * parabola[2] == pytest.approx([0.0, 0.0, -9.81], abs=1e-3)
    before = fitted_hop().schedule.flights[0]
    was = fitted_hop().motion.com(np.array([before.start, before.end]))
    assert com[-1, 2] - was[-1, 2] > 0.1
    assert np.linalg.norm((com[-1] - com[0])[:2]) > np.linalg.norm((was[1] - was[0])[:2]) + 0.1


@pytest.mark.parametrize("degrees", [90.0, pytest.param(-90.0, marks=pytest.mark.slow)])
def test_a_quarter_turn_of_the_landing(degrees: float) -> None:
    pin = Pin("turned", LANDING, turn=np.radians(degrees))
    adaptation = adapted(pin)
    assert adaptation.outcome.status is Status.SOLVED
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    end = np.array([adaptation.motion.duration])
    hips = [
        motion.joint_centres(end)[0][[1, 5]] for motion in (fitted_hop().motion, adaptation.motion)
    ]
    was, now = ((h[1] - h[0])[:2] for h in hips)
    turned = np.degrees(np.arctan2(was[0] * now[1] - was[1] * now[0], was @ now))
    assert turned == pytest.approx(degrees, abs=25.0)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [180.0, -180.0])
def test_a_half_turn_goes_the_way_that_was_asked(degrees: float) -> None:
    """Places alone cannot tell left from right here."""
    adaptation = adapted(Pin("turned", LANDING, turn=np.radians(degrees)))
    assert adaptation.outcome.status is Status.SOLVED
    root = adaptation.motion.transcription.character.joints[0].first
    ends = np.array([0.0, adaptation.motion.duration])
    was, now = (
        float(np.diff(motion.angles(ends)[:, root])[0])
        for motion in (fitted_hop().motion, adaptation.motion)
    )
    assert np.degrees(now - was) == pytest.approx(degrees, abs=40.0)


def finite(adaptation: Adaptation) -> bool:
    times = np.linspace(0.0, adaptation.motion.duration, 50)
    centres = adaptation.motion.joint_centres(times)
    return bool(np.isfinite(centres).all() and np.isfinite(adaptation.outcome.x).all())


def test_feet_that_land_ten_metres_apart_are_refused_before_a_step() -> None:
    """No body can stand so."""
    steps: list[Step] = []
    pins = (
        Pin("left", LANDING, touching=("LeftFoot", "LeftToeBase"), offset=(0.0, 5.0, 0.0)),
        Pin("right", LANDING, touching=("RightFoot", "RightToeBase"), offset=(0.0, -5.0, 0.0)),
    )
    problem = MotionProblem(pins=pins)
    with pytest.raises(ContradictoryPins):
        adapt(fitted_hop(), problem, progress=lambda step, _: steps.append(step))
    assert not steps


def test_ten_metres_further_is_out_of_a_persons_reach() -> None:
    problem = MotionProblem(pins=(Pin("far", LANDING, offset=(10.0, 0.0, 8.0)),))
    with pytest.raises(OutOfReach):
        adapt(fitted_hop(), problem)


@pytest.mark.slow
def test_ten_metres_further_ends_in_bounded_steps() -> None:
    """Of a figure that is no human. What is returned obeys physics, falls short of the landing, and
    is marked as such."""
    steps: list[Step] = []
    far, anything = (
        Pin("far", LANDING, offset=(10.0, 0.0, 8.0)),
        SolverOptions(human=HumanRanges.OFF),
    )
    problem = MotionProblem(pins=(far,), requests=Requests(solution=anything))
    adaptation = adapt(fitted_hop(), problem, progress=lambda step, _: steps.append(step))
    assert not adaptation.solved
    assert adaptation.outcome.violation > 1.0
    assert len(steps) < 200
    assert finite(adaptation)
    assert 0.0 < adaptation.reached < 1.0
    motion = adaptation.motion
    times = np.linspace(0.0, motion.duration, 300)
    assert np.abs(dynamics_residual(motion, times).force).max() < 1e-3
    assert np.linalg.norm(contact_places(adaptation) - motion.places, axis=1).max() > 1.0


@pytest.mark.slow
def test_progress_is_reported_step_by_step() -> None:
    seen: list[Step] = []
    problem = MotionProblem(pins=(EDITS["up"],))
    adaptation = adapt(fitted_hop(), problem, progress=lambda step, _: seen.append(step))
    assert seen == [step for outcome in adaptation.outcomes for step in outcome.steps]
    assert seen


def test_adapting_leaves_the_fit_alone() -> None:
    fitted = fitted_hop()
    x, places = fitted.outcome.x.copy(), fitted.places.copy()
    metric = fitted.metric.lower.copy()
    adapted(EDITS["forward"])
    assert (fitted.outcome.x == x).all()
    assert (fitted.places == places).all()
    assert (fitted.metric.lower == metric).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize(
    "relative",
    [
        "forward_jump_116cm.bvh",
        "high_jump.bvh",
        "run_1.bvh",
        "fair1_jumping.bvh",
    ],
)
def test_other_recordings_adapt(relative: str, name: str) -> None:
    adaptation = adapt(whole_fit(relative), MotionProblem(pins=(EDITS[name],)))
    assert adaptation.outcome.status is Status.SOLVED
    assert_valid(adaptation.motion, adaptation.setup.schedule)


@pytest.mark.slow
@pytest.mark.parametrize("gravity", [9.81, 2.5])
def test_the_beginning_stays_where_the_take_comes_from(gravity: float) -> None:
    """In a quarter of the gravity it took a run-up from 25 cm behind."""
    requests = Requests(body=BodyChange(gravity=gravity))
    found = adapt(fitted_hop(), MotionProblem(pins=(EDITS["up"],), requests=requests))
    assert found.solved
    first = np.zeros(1)
    off = found.motion.joint_centres(first) - fitted_hop().motion.joint_centres(first)
    assert np.linalg.norm(off.mean(axis=(0, 1))) < 0.02
