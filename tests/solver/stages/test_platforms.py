"""Contacts that ride on objects: trains, discs, swings, carts that speed up, treadmills."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.devtools.checks.mujoco_check import check_motion
from hangtime.solver.data.faults import GroundNotThere, JerkyGround
from hangtime.solver.data.problem import MotionProblem, OffsetAxes, Pin
from hangtime.solver.data.reports.constraints import MovingGroundReport
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.requests import PhaseTiming, Requests
from hangtime.solver.data.scene import SceneObject, SteadyMotion
from hangtime.solver.data.solver_options import SolverOptions
from hangtime.solver.data.status import DragStatus, Status
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.results.certificate import loaded_drifts
from hangtime.solver.results.npz_export import sample
from hangtime.solver.results.report import report
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.interactive import Follower
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.moving import ground, keyed

FIRST, RATE, LAST = 20.0, 120.0, 190.0  # scene frames of the hop, and of what moves
TAKE_OFF, TOUCH_DOWN = 0.39234099228035585, 0.7576559112004481  # s
VELOCITY = np.array([3.0, 1.0, 0.0])
TRAIN = ground(SteadyMotion(velocity=(3.0, 1.0, 0.0)), "train")
TRAM = ground(SteadyMotion(velocity=(0.5, 0.2, 0.0)), "tram")
FROM, ONTO = (Pin(f"on {phase}", phase, on="train") for phase in ("ground 1", "ground 2"))


def path(pose: Callable[[float], tuple[np.ndarray, np.ndarray]], last: float = LAST) -> SceneObject:
    return keyed(pose, (FIRST, RATE, last), "train")


def speeding_up(t: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([1.5 * t**2, 0.0, 0.0]), np.eye(3)  # 3 m/s²


def swinging(t: float) -> tuple[np.ndarray, np.ndarray]:
    """On ropes of three metres from (0.5, 1, 3), 25 degrees to each side."""
    angle = np.radians(25.0) * np.sin(np.sqrt(9.81 / 3.0) * (t - 0.3))
    low = np.array([0.0, 3.0 * np.sin(angle), -3.0 * np.cos(angle)])
    return np.array([0.5, 1.0, 3.0]) + low, axis_rotation(0, angle)


def lifting(t: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([0.0, 0.0, 0.5 * t + 0.2 * np.sin(3.0 * t)]), np.eye(3)


def asked(thing: SceneObject, *pins: Pin, timings: tuple[PhaseTiming, ...] = ()) -> MotionProblem:
    """Limbs may go through it: that is another test's, and takes longer."""
    requests = Requests(timings=timings, solution=SolverOptions(solid=False))
    return MotionProblem(scene=(thing,), pins=pins, requests=requests)


CASES = {
    "from a train": asked(TRAIN, FROM),
    "onto a train": asked(TRAIN, ONTO),
    "from a disc": asked(
        ground(SteadyMotion(spin=np.radians(60.0), pivot=(0.3, 0.5, 0.0)), "train"), FROM
    ),
    "onto a disc": asked(
        ground(SteadyMotion(spin=np.radians(60.0), pivot=(0.3, 0.5, 0.0)), "train"), ONTO
    ),
    "from a swing": asked(path(swinging), FROM),
    "from a cart": asked(path(speeding_up), FROM),
    "within a lift": asked(path(lifting), FROM, ONTO),
    "onto a belt": asked(ground(SteadyMotion(belt=(0.0, 1.5, 0.0)), "train"), ONTO),
}


@cache
def solved(name: str) -> Adaptation:
    return adapt(fitted_hop(), CASES[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_physics_holds_by_mujoco_and_nothing_slides_on_its_ground(name: str) -> None:
    found = solved(name)
    assert found.outcome.status is Status.SOLVED
    assert found.reached == 1.0
    residual, _ = check_motion(found.motion)
    for flying in (True, False):
        assert residual.rms("force", flying) < 0.003
        assert residual.rms("moment", flying) < 0.001
    drifts = loaded_drifts(found.motion)
    assert max(drift.slide.max(initial=0.0) for drift in drifts) < 0.001


def test_nothing_slides_on_a_belt() -> None:
    """The same quickly, of one case."""
    found = solved("onto a belt")
    assert found.outcome.status is Status.SOLVED
    assert max(drift.slide.max(initial=0.0) for drift in loaded_drifts(found.motion)) < 0.001
    arrays = sample(found.motion, 200.0)
    held = np.isfinite(arrays["contact_place"][..., 0])
    place = arrays["contact_place"][:, arrays["contact_names"] == "Left toe"][:, 0]
    times = arrays["time"]
    stands = held[:, arrays["contact_names"] == "Left toe"][:, 0] & (times > 0.76)
    went = place[stands][-1] - place[stands][0]
    lasted = times[stands][-1] - times[stands][0]
    np.testing.assert_allclose(went, [0.0, 1.5 * lasted, 0.0], atol=1e-9)


# ---------------------------------------------------------------- Galilei


def assert_carried(
    found: Adaptation, still: Adaptation, velocity: np.ndarray, atol: float = 1e-5
) -> None:
    times = np.linspace(0.0, still.motion.duration, 200)
    ridden = found.motion.com(times) - times[:, None] * velocity
    np.testing.assert_allclose(ridden, still.motion.com(times), atol=atol)
    np.testing.assert_allclose(found.motion.angles(times), still.motion.angles(times), atol=atol)


@pytest.mark.parametrize("belt", [False, True])
def test_everything_on_a_train_is_the_recording_carried_along(belt: bool) -> None:
    velocity = tuple(VELOCITY.tolist())
    steady = SteadyMotion(belt=velocity) if belt else SteadyMotion(velocity=velocity)
    found = adapt(fitted_hop(), asked(ground(steady, "train"), FROM, ONTO))
    platform = asked(ground(None, "train"), FROM, ONTO)
    assert_carried(found, adapt(fitted_hop(), platform.keeping_times()), VELOCITY)


def test_a_pins_offset_is_the_same_on_a_train() -> None:
    further = Pin("Landing", "ground 2", offset=(0.05, 0.0, 0.0), axes=OffsetAxes.WORLD, on="train")
    found = adapt(fitted_hop(), asked(TRAIN, FROM, further))
    platform = asked(ground(None, "train"), FROM, further).keeping_times()
    assert_carried(found, adapt(fitted_hop(), platform), VELOCITY, 1e-4)


# ---------------------------------------------------------------- take-offs


@pytest.mark.slow
def test_a_stance_that_no_pin_names_is_carried_on_by_the_take_off() -> None:
    target = solved("from a train").setup.target
    fit = fitted_hop()
    moved = target.places - fit.places
    landed = [c.start > TAKE_OFF for c in fit.schedule.contacts]
    np.testing.assert_allclose(moved[landed], TOUCH_DOWN * VELOCITY * np.ones((4, 1)), atol=1e-9)
    np.testing.assert_allclose(moved[~np.array(landed)], 0.0, atol=0.005)  # onto its face
    assert all(ride is None for ride, later in zip(target.rides, landed, strict=True) if later)


def test_a_carried_landing_keeps_its_height_and_turns_as_a_disc_did() -> None:
    disc = ground(SteadyMotion(spin=1.0, pivot=(0.3, 0.5, 0.0)), "train")
    target = adapt(fitted_hop(), asked(disc, FROM)).setup.target
    before, after = fitted_hop().places[4:6], target.places[4:6]  # both toes
    np.testing.assert_allclose(after[:, 2], before[:, 2])
    turned = axis_rotation(2, TOUCH_DOWN) @ (before[1] - before[0])
    np.testing.assert_allclose(after[1] - after[0], turned, atol=1e-9)


def test_from_a_train_onto_another_the_body_leaves_with_its_speed() -> None:
    along = (0.5 * TOUCH_DOWN, 0.2 * TOUCH_DOWN, 0.0)
    beside = ground(SteadyMotion(velocity=(0.5, 0.2, 0.0)), "other")
    land = Pin("Land", "ground 2", offset=along, axes=OffsetAxes.WORLD, on="other")
    problem = asked(TRAM, Pin("Leave", "ground 1", on="tram"), land)
    both = adapt(fitted_hop(), replace(problem, scene=(TRAM, beside)))
    at = np.array([TAKE_OFF])
    still = adapt(fitted_hop(), asked(ground(None, "train"), FROM, ONTO).keeping_times())
    gained = both.motion.com(at, 1) - still.motion.com(at, 1)
    np.testing.assert_allclose(gained, [[0.5, 0.2, 0.0]], atol=1e-4)


@pytest.mark.slow
def test_the_report_tells_who_rides_and_who_is_carried_on() -> None:
    name = "from a train"
    told = report(solved(name), CASES[name], Origin("hop.bvh")).moving_ground
    rides, carried = told
    speed = float(np.linalg.norm(VELOCITY))
    assert (rides.phase, rides.object, rides.pin) == ("ground 1", "train", "on ground 1")
    assert rides.ground_speed_m_s == pytest.approx((speed, speed))
    assert rides.kept_speed_share == pytest.approx(0.75, abs=0.1)
    assert (carried.phase, carried.object) == ("ground 2", None)
    assert carried.moved_m == pytest.approx(tuple(TOUCH_DOWN * VELOCITY))
    assert isinstance(carried, MovingGroundReport)


def test_where_nothing_moves_the_report_says_nothing() -> None:
    problem = asked(TRAIN, Pin("Landing", "ground 2"))
    found = adapt(fitted_hop(), problem)
    assert report(found, problem, Origin("hop.bvh")).moving_ground == ()


# ---------------------------------------------------------------- time


def test_durations_stay_on_moving_ground() -> None:
    further = Pin("Landing", "ground 2", offset=(0.15, 0.0, 0.0), on="tram")
    found = adapt(fitted_hop(), asked(TRAM, Pin("a", "ground 1", on="tram"), further))
    assert found.setup.context.timeline.unchanged


def test_a_platform_moves_by_the_results_clock() -> None:
    slow = PhaseTiming("Slow", "ground 1", factor=1.2)
    found = adapt(fitted_hop(), asked(TRAM, Pin("a", "ground 1", on="tram"), timings=(slow,)))
    assert found.outcome.status is Status.SOLVED
    (toe,) = (i for i, c in enumerate(found.setup.schedule.contacts) if c.name == "Left toe 1")
    end = found.setup.schedule.contacts[toe].end
    assert end == pytest.approx(1.2 * TAKE_OFF)
    held = found.motion.transcription.contacts[toe].holds(np.array([end])).shift
    np.testing.assert_allclose(held[0, :2], [0.5 * end, 0.2 * end], atol=1e-9)


# ---------------------------------------------------------------- drag


def test_the_ghost_rides_too() -> None:
    problem = asked(TRAM, Pin("a", "ground 1", on="tram"), Pin("b", "ground 2", on="tram"))
    follower = Follower(fitted_hop(), MotionProblem())
    ended = [follower.follow(problem) for _ in range(3)]
    assert ended[-1] is DragStatus.CONVERGED
    times = np.linspace(0.0, 1.29, 50)
    ridden = follower.motion.com(times) - times[:, None] * np.array([0.5, 0.2, 0.0])
    np.testing.assert_allclose(ridden, fitted_hop().motion.com(times), atol=5e-3)


@pytest.mark.slow
def test_a_ghost_that_lands_on_what_moves_comes_to_rest_on_it() -> None:
    problem = asked(TRAIN, Pin("b", "ground 2", on="train"))
    follower = Follower(fitted_hop(), asked(TRAIN))
    for _ in range(30):
        if follower.follow(problem) is DragStatus.CONVERGED:
            break
    else:
        raise AssertionError("never there")
    for i, drift in enumerate(loaded_drifts(follower.motion)):
        assert drift.slide.max(initial=0.0) < 0.003, i


# ---------------------------------------------------------------- faults


def test_an_object_whose_keys_end_too_early_is_refused() -> None:
    with pytest.raises(GroundNotThere) as caught:
        adapt(fitted_hop(), asked(path(lifting, last=60.0), FROM))
    assert caught.value.known == (FIRST, 60.0)
    assert caught.value.needed == pytest.approx((FIRST, FIRST + RATE * TAKE_OFF))


def test_an_object_that_comes_too_late_is_refused() -> None:
    late = keyed(lifting, (FIRST + 30.0, RATE, LAST), "train")
    with pytest.raises(GroundNotThere):
        adapt(fitted_hop(), asked(late, FROM))


def test_an_object_that_jumps_is_refused() -> None:
    def jumping(t: float) -> tuple[np.ndarray, np.ndarray]:
        return np.array([0.3 if t > 0.2 else 0.0, 0.0, 0.0]), np.eye(3)

    with pytest.raises(JerkyGround) as caught:
        adapt(fitted_hop(), asked(path(jumping), FROM))
    assert caught.value.frame == pytest.approx(FIRST + 0.2 * RATE, abs=2.0)
