"""Every request on a real hop: solved, physically valid, and met between the rows too."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np
import pytest
from hangtime.solver.body.kinematics import BodyPoint
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    AddedMass,
    AngleLimit,
    BodyChange,
    ConeLimit,
    ConeShape,
    ForceRequest,
    Hold,
    Lift,
    LimbChange,
    Moment,
    OrientationRequest,
    Path,
    PhaseTiming,
    PointAxes,
    PointRequest,
    PoseRequest,
    Reference,
    Requests,
    TorqueLimit,
    TwistLimit,
    When,
)
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.status import Status
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.constraint import dense_violation
from hangtime.solver.transcription.friction_cones import FrictionCones
from hangtime.solver.transcription.joint_measures import BendAngle
from hangtime.solver.transcription.motion import dynamics_residual
from hangtime.tests.helpers.fitted_hop import fitted_hop

LANDING = When(phase="ground 2")
APEX = When(phase="flight 1", moment=Moment.APEX)
FALLING = When(frames=(79.0, 104.0))
FREE = (None, None)
LEGS = ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")
FIRST, LAST = 20.0, 176.0  # scene frames of the hop
TAKE_OFF, TOUCH_DOWN = 0.394, 0.7575  # s


def degrees(*angles: float) -> list[float]:
    return [float(np.radians(a)) for a in angles]


def frame(time: float) -> float:
    return FIRST + 120.0 * time


def carried() -> Path:
    """Where the left hand went in the fit, a little above."""
    times = np.linspace(TAKE_OFF, TOUCH_DOWN, 96)
    places = fitted_hop().motion.joint_centres(times)[:, body("LeftHand")] + [0.0, 0.0, 0.05]
    return Path(tuple(frame(t) for t in times), tuple(map(tuple, places.tolist())))


def body(bone: str) -> int:
    return [b.bone for b in fitted_hop().motion.transcription.character.bodies].index(bone)


@dataclass(frozen=True)
class Case:
    """What is asked, and how many constraints that makes."""

    make: Callable[[], Requests]
    constraints: int = 1
    pins: tuple[Pin, ...] = field(default_factory=tuple)


CASES = {
    "point": Case(
        lambda: Requests(
            points=(
                PointRequest(
                    "hand", "LeftHand", APEX, relative=(0.1, 0, 0.1), axes=PointAxes.TRAVEL
                ),
            )
        )
    ),
    "point in bounds": Case(
        lambda: Requests(
            points=(PointRequest("toe", "LeftToeBase", APEX, bounds=(FREE, FREE, (0.35, None))),)
        )
    ),
    "point on a path": Case(
        lambda: Requests(points=(PointRequest("hand", "LeftHand", FALLING, path=carried()),))
    ),
    "grip": Case(
        lambda: Requests(
            points=(PointRequest("bar", "LeftHand", LANDING, environment=True, grip=True),)
        ),
        constraints=0,
    ),
    "lift": Case(
        lambda: Requests(lifts=(Lift("one leg", "ground 2", ("LeftFoot", "LeftToeBase")),)),
        constraints=0,
    ),
    "angle": Case(lambda: Requests(angles=(AngleLimit("knee", "LeftLeg", *degrees(15.0, 70.0)),))),
    "fixed angle": Case(
        lambda: Requests(angles=(AngleLimit("elbow", "LeftForeArm", *degrees(50.0, 50.0)),))
    ),
    "cone": Case(lambda: Requests(cones=(ConeLimit("arm", "LeftArm", *degrees(15.0)),))),
    "twist": Case(
        lambda: Requests(twists=(TwistLimit("thigh", "LeftUpLeg", *degrees(-8.0, 8.0)),))
    ),
    "torque": Case(
        lambda: Requests(torques=(TorqueLimit("knee", ("LeftLeg",), bound=60.0, when=LANDING),))
    ),
    "share of a torque": Case(
        lambda: Requests(torques=(TorqueLimit("arm", ("LeftArm",), share=0.5),))
    ),
    "limp": Case(lambda: Requests(torques=(TorqueLimit("arm", ("RightArm",), bound=0.0),))),
    "pose": Case(
        lambda: Requests(poses=(PoseRequest("pose", APEX, frame=FIRST + 20.0, slack=0.01),))
    ),
    "rest": Case(
        lambda: Requests(poses=(PoseRequest("arm", APEX, ("LeftForeArm",), Reference.REST),))
    ),
    "orientation": Case(
        lambda: Requests(
            orientations=(OrientationRequest("turn", "Hips", APEX, *degrees(20.0, 10.0, 0.5)),)
        )
    ),
    "peak": Case(lambda: Requests(forces=(ForceRequest("soft", peak=2.0, when=LANDING),))),
    "friction": Case(lambda: Requests(forces=(ForceRequest("rubber", friction=0.5),)), 0),
    "pyramid": Case(
        lambda: Requests(forces=(ForceRequest("flat", friction=0.5, shape=ConeShape.PYRAMID),)), 0
    ),
    "briefcase": Case(
        lambda: Requests(body=BodyChange(added=(AddedMass("case", "RightHand", share=0.1),))), 0
    ),
    "long legs": Case(
        lambda: Requests(body=BodyChange(limbs=(LimbChange("legs", LEGS, length=1.1),))), 0
    ),
    "moon": Case(lambda: Requests(body=BodyChange(gravity=1.62)), 0),
    "timing": Case(lambda: Requests(timings=(PhaseTiming("long", "flight 1", factor=1.15),)), 0),
    "hold": Case(lambda: Requests(holds=(Hold("stand", LAST - 2.0, 0.3),)), 0),
    "hold that ends": Case(lambda: Requests(holds=(Hold("float", frame(0.6), 0.1, ends=True),)), 0),
    "pin and cone": Case(
        lambda: Requests(cones=(ConeLimit("arm", "LeftArm", *degrees(20.0)),)),
        pins=(Pin("landing", "ground 2", offset=(0.2, 0.0, 0.1)),),
    ),
}
SLOW = {"twist", "share of a torque", "rest", "pyramid", "hold that ends", "limp", "pin and cone"}
SLOW |= {"grip", "pose", "moon"}
# The others are quick: each is also seen from outside, below.
ALL = [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in CASES]


@cache
def adapted(name: str) -> Adaptation:
    case = CASES[name]
    return adapt(fitted_hop(), MotionProblem(pins=case.pins, requests=case.make()))


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_it_is_solved_and_met_everywhere(name: str) -> None:
    adaptation = adapted(name)
    assert adaptation.outcome.status is Status.SOLVED
    assert adaptation.outcome.violation <= 1.0
    t, x = adaptation.motion.transcription, adaptation.motion.x
    assert len(t.constraints) == CASES[name].constraints
    for constraint in t.constraints:
        found = dense_violation(constraint, t.character, t.basis, t.layout, x)
        assert found.amount <= found.kind.tolerance, found


@pytest.mark.parametrize("name", ALL)
def test_physics_holds_between_the_nodes(name: str) -> None:
    motion = adapted(name).motion
    times = np.arange(0.0, motion.duration, 1.0 / 480.0)
    left = dynamics_residual(motion, times)
    assert np.sqrt((left.force**2).sum(axis=1).mean()) < 1e-4
    assert np.sqrt((left.moment**2).sum(axis=1).mean()) < 0.005


# -- what they do, seen from outside --------------------------------------------------------


def height(adaptation: Adaptation, bone: str, time: float) -> float:
    motion, index = adaptation.motion, body(bone)
    middle = BodyPoint(index, 0.5 * motion.transcription.character.bodies[index].tip)
    times = np.array([time])
    return float((motion.pose(times).points([middle])[:, 0] + motion.com(times))[0, 2])


def apex(adaptation: Adaptation) -> float:
    (constraint,) = adaptation.motion.transcription.constraints
    assert constraint.start == constraint.end
    return constraint.start


def test_the_toe_is_up_at_the_apex() -> None:
    found = adapted("point in bounds")
    assert 0.55 < apex(found) < 0.62
    assert height(found, "LeftToeBase", apex(found)) > 0.3497


def test_the_hand_rises_by_what_was_asked() -> None:
    found = adapted("point")
    was = fitted_hop().motion
    at = np.array([apex(found)])
    middle = BodyPoint(
        body("LeftHand"), 0.5 * was.transcription.character.bodies[body("LeftHand")].tip
    )
    before = (was.pose(at).points([middle])[:, 0] + was.com(at))[0, 2]
    assert height(found, "LeftHand", apex(found)) == pytest.approx(before + 0.1, abs=5e-4)


@pytest.mark.slow
def test_a_grip_holds_its_hand_still_and_may_pull() -> None:
    motion = adapted("grip").motion
    t = motion.transcription
    index = [c.contact.name for c in t.contacts].index("bar")
    contact = t.contacts[index]
    times = np.linspace(contact.contact.start, contact.contact.end, 60)
    assert motion.drift(index, times).max() < 0.001
    cones = FrictionCones(t.basis, t.layout, t.contacts)
    assert index not in set(cones.rows(motion.x)[0].owner)


def test_a_lifted_foot_carries_nothing_and_comes_off_the_other_only() -> None:
    motion = adapted("lift").motion
    names = [c.contact.name for c in motion.transcription.contacts]
    assert not {"Left toe 2", "Left heel 2"} & set(names)
    assert {"Right toe 2", "Right heel 2", "Left toe 1"} <= set(names)


def test_a_fixed_elbow_reads_its_angle() -> None:
    motion = adapted("fixed angle").motion
    (constraint,) = motion.transcription.constraints
    assert isinstance(constraint.function, BendAngle)
    character = motion.transcription.character
    elbow = body("LeftForeArm")
    upper, fore = (character.bodies[body(b)].tip for b in ("LeftArm", "LeftForeArm"))
    posed = motion.pose(np.linspace(0.0, motion.duration, 50)).rotations
    one, two = posed[:, body("LeftArm")] @ upper, posed[:, elbow] @ fore
    cosine = (one * two).sum(axis=1) / np.linalg.norm(upper) / np.linalg.norm(fore)
    assert np.degrees(np.arccos(cosine)) == pytest.approx(50.0, abs=0.5)


def test_a_soft_landing_is_under_its_peak() -> None:
    motion = adapted("peak").motion
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    times = np.linspace(TOUCH_DOWN, motion.duration, 300)
    for each, most in ((adapted("peak").motion, 2.01), (fitted_hop().motion, np.inf)):
        total = np.linalg.norm(each.forces(times).sum(axis=1), axis=1).max() / weight
        assert total < most
    assert total > 2.1  # else nothing was asked of it


@pytest.mark.parametrize("name", ["friction", pytest.param("pyramid", marks=pytest.mark.slow)])
def test_feet_do_not_push_more_sideways_than_friction_lets_them(name: str) -> None:
    motion = adapted(name).motion
    mu = 0.5
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    forces = motion.forces(np.linspace(0.0, motion.duration, 800)) / weight
    was = fitted_hop().motion.forces(np.linspace(0.0, motion.duration, 800)) / weight
    order = 1 if name == "pyramid" else 2  # of the norm that is bounded
    excess, before = (
        (np.linalg.norm(f[..., :2], ord=order, axis=-1) - mu * f[..., 2]).max()
        for f in (forces, was)
    )
    assert excess < RowKind.FRICTION.tolerance + 1e-6
    assert before > 2.0 * RowKind.FRICTION.tolerance  # else nothing was asked of it


def test_a_briefcase_is_carried_by_the_ground() -> None:
    before, after = fitted_hop().motion, adapted("briefcase").motion
    masses = [m.transcription.character.mass for m in (before, after)]
    assert masses[1] == pytest.approx(1.1 * masses[0])
    times = np.linspace(0.0, after.duration, 2000)
    impulse = after.forces(times).sum(axis=1)[:, 2].mean() * after.duration
    gained = np.diff(after.com(times[[0, -1]], 1)[:, 2])[0] + STANDARD_GRAVITY * after.duration
    assert impulse == pytest.approx(masses[1] * gained, rel=2e-3)


def test_long_legs_are_longer_and_stand_where_the_others_stood() -> None:
    motion = adapted("long legs").motion
    lengths = [
        np.linalg.norm(m.transcription.character.bodies[body("LeftLeg")].tip)
        for m in (fitted_hop().motion, motion)
    ]
    assert lengths[1] == pytest.approx(1.1 * lengths[0])
    for i, contact in enumerate(motion.transcription.contacts):
        assert motion.places[i] == pytest.approx(fitted_hop().places[i])
        times = np.linspace(contact.contact.start, contact.contact.end, 20)
        assert motion.drift(i, times).max() < 0.001


def test_on_the_moon_one_falls_slowly() -> None:
    motion = adapted("moon").motion
    times = np.linspace(TAKE_OFF + 0.01, TOUCH_DOWN - 0.01, 20)
    assert motion.com(times, 2) == pytest.approx(np.tile([0, 0, -1.62], (20, 1)), abs=1e-3)


def test_a_longer_flight_lasts_longer_and_rises_higher() -> None:
    longer = adapted("timing")
    assert longer.motion.duration == pytest.approx(
        fitted_hop().motion.duration + 0.15 * (TOUCH_DOWN - TAKE_OFF), abs=0.001
    )
    assert [p.name for p in longer.setup.schedule.phases] == ["ground 1", "flight 1", "ground 2"]
    times = np.linspace(0.0, longer.motion.duration, 400)
    was = fitted_hop().motion.com(np.linspace(0.0, fitted_hop().motion.duration, 400))
    assert np.ptp(longer.motion.com(times)[:, 2]) > np.ptp(was[:, 2])


def test_a_hold_is_a_pause() -> None:
    """The pose hardly moves during it, and the feet stay where they were."""
    held = adapted("hold")
    assert held.motion.duration == pytest.approx(fitted_hop().motion.duration + 0.3, abs=1e-6)
    (span,) = held.setup.context.timeline.holds
    speeds = np.abs(held.motion.angles(np.linspace(span.start, span.end, 30), 1))
    recorded = np.abs(fitted_hop().motion.angles(np.array([1.28]), 1))
    assert speeds.mean() < recorded.mean()


@pytest.mark.slow
def test_a_hold_that_ends_is_the_end() -> None:
    held = adapted("hold that ends")
    assert held.motion.duration == pytest.approx(0.7, abs=1e-6)
    ends = {c.contact.end for c in held.motion.transcription.contacts}
    assert max(ends) < TAKE_OFF + 0.001


def test_asking_for_what_is_so_already_changes_nothing() -> None:
    requests = Requests(angles=(AngleLimit("knee", "LeftLeg", *degrees(-30.0, 170.0)),))
    found = adapt(fitted_hop(), MotionProblem(requests=requests))
    assert found.solved
    assert found.motion.x == pytest.approx(fitted_hop().motion.x, abs=1e-12)
