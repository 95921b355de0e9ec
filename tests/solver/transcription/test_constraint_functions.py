"""Constraint functions: their values on an arm, and Jacobians on figures small and real."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import Character
from hangtime.solver.body.kinematics import BodyPoint
from hangtime.solver.constraints.joint_constraints import bend_function
from hangtime.solver.human.wider_cone import WiderCone
from hangtime.solver.numerics.rotations import axis_rotation, rotation_matrix, rotation_vector, unit
from hangtime.solver.transcription.constraint import ConstraintFunction
from hangtime.solver.transcription.constraint_functions import (
    BodyOrientation,
    JointAngles,
    OrientationDistance,
    PeakForce,
    PointPosition,
)
from hangtime.solver.transcription.joint_measures import (
    BendAngle,
    ConeAngle,
    SideAngle,
    TwistAngle,
)
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.solver.transcription.torque_constraint import TorqueFunction
from hangtime.solver.transcription.transcription import Transcription
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import (
    arm,
    context,
    figure,
    jacobian_error,
    random_state,
    seen,
    standing,
    still,
)
from hypothesis import given
from hypothesis import strategies as st

DOWN = np.array([0.0, 0.0, -1.0])
ACROSS = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # a cone downwards
ANGLE = st.floats(-3.0, 3.0)
SWING = st.floats(-1.3, 1.3)


def constant(value: np.ndarray) -> Callable[[FloatArray], FloatArray]:
    return lambda times: np.broadcast_to(value, (len(times), *value.shape))


def turned(R: np.ndarray) -> State:
    """The arm's joint turned by R."""
    character = arm(3)
    angles = character.joints[1].axes.angles(R[None])[0]
    return still(character, np.concatenate([np.zeros(3), angles]))


# -- truth ---------------------------------------------------------------------------------


@given(ANGLE)
def test_a_bend_about_the_hinge_reads_its_angle(angle: float) -> None:
    """The arm hangs down; about x, positive angles bring it to +y."""
    character = arm(1)
    bend = BendAngle(character.joints[1], DOWN, DOWN, np.array([0.0, 1.0, 0.0]))
    state = still(character, np.array([0.1, 0.2, 0.3, angle]))
    assert bend.value(state)[0, 0] == pytest.approx(angle)
    other = replace(bend, flexion=-bend.flexion)
    assert other.value(state)[0, 0] == pytest.approx(-angle)


def test_a_bend_of_thirty_degrees_is_thirty_degrees_in_a_skew_hinge() -> None:
    """About any axis at right angles to both: the small figure's knees."""
    joint = figure().joints[2]
    axis = joint.axes.before[:, 0]
    straight = unit(np.cross(axis, [0.3, 1.0, 0.0]))
    along = joint.axes.rotation(np.zeros((1, 1)))[0].T @ straight
    bend = BendAngle(joint, along, straight, np.cross(axis, straight))
    angles = np.zeros(figure().n_angles)
    angles[joint.first] = np.radians(30.0)
    assert bend.value(still(figure(), angles))[0, 0] == pytest.approx(np.radians(30.0))


def test_a_joint_bends_towards_where_it_bends_in_the_fit() -> None:
    """Positive in the recording's own direction, on a real figure's knees and elbows."""
    motion = fitted_hop().motion
    real = replace(context(), fitted=motion, reference=motion)
    names = [body.bone for body in motion.transcription.character.bodies]
    angles = motion.angles(np.linspace(0.0, motion.duration, 40))
    for bone in ("LeftLeg", "RightLeg", "LeftForeArm", "RightForeArm"):
        bend = bend_function(real, names.index(bone))
        assert abs(bend.straight @ bend.flexion) < 1e-12
        found = np.array([bend.value(still(real.character, q))[0, 0] for q in angles])
        assert np.degrees(found).min() > -5.0
        assert np.degrees(found).max() > 30.0


@given(SWING, SWING, ANGLE)
def test_a_cone_s_angle_is_that_between_bone_and_axis(x: float, y: float, spin: float) -> None:
    R = axis_rotation(0, x) @ axis_rotation(1, y) @ axis_rotation(2, spin)
    cone = ConeAngle(arm(3).joints[1], DOWN, ACROSS, np.ones(2))
    angle = np.arccos(np.clip((R @ DOWN) @ DOWN, -1.0, 1.0))
    assert cone.value(turned(R))[0, 0] == pytest.approx(angle, abs=1e-7)


def test_a_bone_half_a_turn_from_its_cone_s_axis_has_a_way_back() -> None:
    cone = ConeAngle(arm(3).joints[1], DOWN, ACROSS, np.ones(2))
    opposite = axis_rotation(0, np.pi)[None]
    (way,) = cone.gradient(opposite)
    assert np.linalg.norm(way) == pytest.approx(1.0)
    back = rotation_matrix(-0.1 * way) @ opposite
    assert cone.of(back)[0] == pytest.approx(np.pi - 0.1)


@pytest.mark.parametrize(("axis", "tangent"), [(0, 0.5), (1, 2.0)])
def test_a_cone_s_stretch_widens_it(axis: int, tangent: float) -> None:
    """At 45 degrees sideways (about y) or forwards (about x), with sideways halved."""
    cone = ConeAngle(arm(3).joints[1], DOWN, ACROSS, np.array([0.5, 2.0]))
    state = turned(axis_rotation(axis, np.radians(45.0)))
    assert np.tan(cone.value(state)[0, 0]) == pytest.approx(tangent)


@pytest.mark.parametrize(("axis", "stretch"), [(0, 2.0), (1, 0.5)])
def test_how_far_a_bone_is_past_a_stretched_cone_is_an_angle_in_space(
    axis: int, stretch: float
) -> None:
    half, bent = np.radians(30.0), np.radians(75.0)
    cone = ConeAngle(arm(3).joints[1], DOWN, ACROSS, np.array([0.5, 2.0]))
    edge = np.arctan(stretch * np.tan(half))
    past = cone.past(axis_rotation(axis, bent)[None], -np.inf, half)[1]
    assert past == pytest.approx(bent - edge)
    assert cone.past(np.eye(3)[None], -np.inf, np.inf)[1] == -np.inf


@given(ANGLE, SWING, SWING)
def test_twist_does_not_see_swings(twist: float, x: float, y: float) -> None:
    along = unit(np.array([0.2, -0.3, -1.0]))
    first = unit(np.cross(along, [1.0, 0.0, 0.0]))
    swing = rotation_matrix(x * first + y * np.cross(along, first))
    function = TwistAngle(arm(3).joints[1], along)
    found = function.value(turned(swing @ rotation_matrix(twist * along)))[0, 0]
    assert found == pytest.approx(twist, abs=1e-6)


@pytest.mark.parametrize("angle", [0.0, 1e-6, 0.5, 2.0, np.pi - 1e-6])
def test_orientation_is_the_turn_that_is_missing(angle: float) -> None:
    axis = unit(np.array([1.0, -2.0, 0.5]))
    R = rotation_matrix(np.array([0.4, -0.2, 0.3]))
    wanted = R @ rotation_matrix(-angle * axis)
    function = BodyOrientation(1, constant(wanted))
    found = function.value(turned(R))[0]
    assert found == pytest.approx(angle * axis, abs=1e-8)


def test_a_place_is_measured_from_its_own_along_its_axes() -> None:
    character = arm(1)
    state = still(character, np.zeros(4), com=np.array([1.0, 2.0, 3.0]))
    tip = BodyPoint(1, character.bodies[1].tip)
    at = state.pose.points([tip])[0, 0] + [1.0, 2.0, 3.0]
    slope = unit(np.array([[0.0, 1.0, 1.0], [0.0, -1.0, 1.0]])).T
    away = np.array([0.3, 0.2, 0.1])
    function = PointPosition(tip, lambda times: np.tile(at - away, (len(times), 1)), slope)
    assert function.value(state)[0] == pytest.approx([0.3 / np.sqrt(2.0), -0.1 / np.sqrt(2.0)])


def test_peak_is_of_the_sum_of_forces() -> None:
    t, x = standing(), random_state(0)
    times = t.basis.breaks[:2]
    x[:, t.layout.forces] = np.tile([0.0, 0.3, 0.4, 0.0, 0.3, 0.4], (len(x), 1))
    from_both, from_one = (
        PeakForce(np.array(points)).value(_state(t, x, times)) for points in ((0, 1), (1,))
    )
    assert from_both == pytest.approx(1.0)
    assert from_one == pytest.approx(0.5)


def _state(t: Transcription, x: np.ndarray, times: np.ndarray) -> State:
    return State(t.character, t.layout, Instants(t.basis, times), x)


# -- Jacobians --------------------------------------------------------------------------------


def moving_place(times: FloatArray) -> FloatArray:
    return np.stack([times, 0.5 * times, 1.0 - times], axis=1)


def functions(t: Transcription, body: int) -> dict[str, ConstraintFunction]:
    """Every constraint function, on one jointed body of a figure."""
    character: Character = t.character
    joint = character.joints[body]
    along = unit(character.bodies[body].tip)
    straight = unit(np.array([0.1, 0.5, -0.8]))
    flexion = unit(np.cross(straight, [1.0, 0.2, 0.0]))
    frame = np.stack([straight, flexion, np.cross(straight, flexion)])
    slope = rotation_matrix(np.array([0.2, 0.1, 0.4]))[:, :2]
    wanted = np.array([0.5, 0.1, -0.4])
    mine = np.arange(joint.first, joint.dofs.stop)
    point = BodyPoint(body, np.array([0.02, -0.05, 0.1]))
    return {
        "bend": BendAngle(joint, along, straight, flexion),
        "cone": ConeAngle(joint, along, frame, np.ones(2)),
        "stretched cone": ConeAngle(joint, along, frame, np.array([0.6, 1.7])),
        "wider cone": WiderCone(joint, along, frame, np.array([0.6, 1.7]), half=0.7, by=0.3),
        "aside": SideAngle(joint, along, flexion),
        "twist": TwistAngle(joint, along),
        "twist from a pose": TwistAngle(joint, along, zero=rotation_matrix(wanted)),
        "place": PointPosition(point, moving_place, slope),
        "orientation": BodyOrientation(body, constant(rotation_matrix(wanted))),
        "orientation's distance": OrientationDistance(
            BodyOrientation(body, constant(rotation_matrix(wanted)))
        ),
        "angles": JointAngles(mine, constant(0.1 * mine)),
        "peak": PeakForce(np.arange(t.layout.n_points)),
        "torques": TorqueFunction(character, t.points, mine),
    }


NAMES = tuple(functions(standing(), 1))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", NAMES)
def test_jacobians_on_a_small_figure(name: str, seed: int) -> None:
    function = functions(standing(), 1 + seed)[name]
    assert jacobian_error(seen(standing(), random_state(seed)), function, 20 + seed) < 1e-6


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("bone", ["LeftUpLeg", "RightArm"])
def test_jacobians_on_a_real_figure(bone: str, name: str) -> None:
    motion = fitted_hop().motion
    t = motion.transcription
    body = [b.bone for b in t.character.bodies].index(bone)
    assert jacobian_error(seen(t, motion.x), functions(t, body)[name], 30) < 1e-5


@pytest.mark.parametrize("angle", [1e-5, 1.0, 3.0, np.pi - 1e-3])
def test_orientation_s_jacobian_holds_up_to_half_a_turn(angle: float) -> None:
    """Of a constant pose and a target `angle` from it about a random axis."""
    character = arm(3)
    q = np.array([0.2, -0.3, 0.1, 0.4, 0.2, -0.5])
    axis = unit(np.array([0.3, -1.0, 0.6]))
    now = still(character, q).pose.rotations[0, 1]
    function = BodyOrientation(1, constant(now @ rotation_matrix(-angle * axis)))
    (jacobian,) = function.jacobians(still(character, q))
    for k in range(6):
        step = 1e-6 * np.eye(6)[k]
        ahead, behind = (function.value(still(character, q + s * step))[0] for s in (1.0, -1.0))
        assert jacobian.matrix[0, :, k] == pytest.approx((ahead - behind) / 2e-6, abs=1e-5)


def test_an_orientation_beyond_half_a_turn_reads_the_shorter_way() -> None:
    R = axis_rotation(2, 4.0)
    found = BodyOrientation(1, constant(np.eye(3))).value(turned(R))[0]
    assert found == pytest.approx(rotation_vector(R))
    assert np.linalg.norm(found) == pytest.approx(2.0 * np.pi - 4.0)


def test_a_bone_on_its_cone_s_axis_has_a_finite_jacobian() -> None:
    cone = ConeAngle(arm(3).joints[1], DOWN, ACROSS, np.ones(2))
    state = turned(np.eye(3))
    assert cone.value(state)[0, 0] == pytest.approx(0.0)
    assert np.isfinite(cone.jacobians(state)[0].matrix).all()
