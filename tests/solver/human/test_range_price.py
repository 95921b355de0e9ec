"""The price of turning joints: shares of a person's ranges, and what a reach makes of it."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.kinematics import forward_kinematics
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import PointAxes, PointRequest, Requests, When
from hangtime.solver.data.solver_options import HumanRanges
from hangtime.solver.human.ranges import rest_figure
from hangtime.solver.objectives.joint_price import JointPrice
from hangtime.solver.objectives.tracking_cost import marker_points
from hangtime.solver.results.joint_report import joint_turns
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.validity import assert_valid

BEFORE = 6.0  # frames after the first


def price() -> JointPrice:
    return fitted_hop().price


def cost(body: int | None, axis: FloatArray, degrees: float) -> float:
    """The price of a body's turn about an axis (3,) of its own frame."""
    assert body is not None
    turn = np.radians(degrees) * axis
    return float(turn @ price().turns[body] @ turn)


def knee() -> float:
    """The price of a left knee's whole range."""
    character = fitted_hop().motion.transcription.character
    return cost(character.body(Part.SHANK, Side.LEFT), rest_figure(character).left, 145.0)


def whole_range(part: Part, axis: FloatArray, degrees: float) -> float:
    """The price of a left joint's turn, in that of a knee's whole range."""
    body = fitted_hop().motion.transcription.character.body(part, Side.LEFT)
    return cost(body, axis, degrees) / knee()


def test_the_whole_range_of_any_joint_costs_the_same() -> None:
    """The thighs are spread at rest, so that a turn about the left axis is partly a spreading."""
    figure = rest_figure(fitted_hop().motion.transcription.character)
    assert whole_range(Part.THIGH, figure.left, 150.0) == pytest.approx(1.0, rel=0.4)
    assert whole_range(Part.CLAVICLE, figure.forward, 55.0) == pytest.approx(1.0, rel=0.15)


def test_bones_that_share_a_range_cost_together_what_one_joint_would() -> None:
    """Three bones of a spine: each has a third of 105 degrees, and a third of the price."""
    motion = fitted_hop().motion
    character = motion.transcription.character
    figure = rest_figure(character)
    spine = figure.parts[Part.SPINE, Side.MIDDLE]
    bodies = [i for i, body in enumerate(character.bodies) if body.bone in spine]
    each = 105.0 / len(spine)
    assert sum(cost(i, figure.left, each) for i in bodies) == pytest.approx(knee(), rel=0.15)


def test_turning_costs_in_the_mean_what_it_moves() -> None:
    """Of the joints one by one: the mean square of the points over the price of the turn."""
    motion = fitted_hop().motion
    character = motion.transcription.character
    posed = forward_kinematics(character, motion.angles(np.linspace(0.0, motion.duration, 50)))
    points = list(marker_points(character))
    again = price().as_dear_as_movement(posed, points)
    assert again.turns == pytest.approx(price().turns, rel=1e-9)
    doubled = JointPrice(2.0 * price().turns, price().share)
    assert doubled.as_dear_as_movement(posed, points).turns == pytest.approx(again.turns, rel=1e-9)


def test_the_price_does_not_depend_on_how_joints_are_parametrised() -> None:
    """A turn's price by the metric of the angles is that of the turn itself."""
    motion = fitted_hop().motion
    character = motion.transcription.character
    angles = motion.angles(np.array([0.3]))
    metric = price().metric(forward_kinematics(character, angles))[0]
    rates = np.random.default_rng(5).normal(size=character.n_angles)
    step = 1e-6
    expected = 0.0
    for i, joint in enumerate(character.joints):
        before, after = (
            joint.axes.rotation((angles[0] + s * step * rates)[joint.dofs]) for s in (-1.0, 1.0)
        )
        skew = before.T @ (after - before) / (2.0 * step)
        turn = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
        expected += float(turn @ price().turns[i] @ turn)
    assert float(rates @ metric @ rates) == pytest.approx(expected, rel=1e-6)


def test_the_root_turns_for_nothing() -> None:
    assert not price().turns[0].any()
    others = price().turns[1:]
    assert np.linalg.eigvalsh(others).min() > 0.0


def reach(human: bool) -> Adaptation:
    """The right hand 0.3 m further forwards, before the hop."""
    frame = float(fitted_hop().performance.recording.frames[0]) + BEFORE
    when = When(frames=(frame - 2.0, frame + 2.0))
    hand = PointRequest("Reach", "RightHand", when, relative=(0.3, 0.0, 0.0))
    requests = Requests(points=(replace(hand, axes=PointAxes.TRAVEL),))
    ranges = HumanRanges.SOFT if human else HumanRanges.OFF
    solution = replace(requests.solution, human=ranges)
    return adapt(fitted_hop(), MotionProblem(requests=replace(requests, solution=solution)))


def turned(adaptation: Adaptation, *parts: Part) -> float:
    """Degrees, summed over the right side's and the middle's joints of these parts."""
    motion = adaptation.motion
    turns = joint_turns(adaptation, np.linspace(0.0, motion.duration, 200)).max(axis=0)
    bodies = motion.transcription.character.bodies
    mine = [b.part in parts and b.side is not Side.LEFT for b in bodies]
    return float(np.degrees(turns[mine].sum()))


def spine_to_hip(adaptation: Adaptation) -> float:
    """By how much more the spine bends than a hip; of people who lean to reach 0.2 to 1.2."""
    return turned(adaptation, Part.SPINE) / turned(adaptation, Part.THIGH)


@pytest.mark.slow
def test_a_reach_is_shared_by_the_body_as_people_do() -> None:
    """The arm first (Kaminski et al. 1995), then spine, hips and knees (Thomas et al. 1998)."""
    plain, shared = reach(human=False), reach(human=True)
    assert shared.solved
    assert_valid(shared.motion, shared.setup.schedule)
    small = (Part.CLAVICLE, Part.HAND, Part.NECK, Part.HEAD)
    assert turned(shared, *small) < 0.2 * turned(plain, *small)
    assert turned(shared, Part.UPPER_ARM, Part.FOREARM) > 5.0 * turned(shared, *small)
    assert spine_to_hip(shared) < 0.8 * spine_to_hip(plain)
