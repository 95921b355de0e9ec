"""Our dynamics against MuJoCo on random trees, and every Jacobian against finite differences."""

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import mujoco
import numpy as np
import pytest
from hangtime.devtools.checks.mjcf import hinge_order, mjcf, state
from hangtime.devtools.checks.mujoco_check import inverse_dynamics, root_wrench
from hangtime.devtools.peers.newton_euler import inverse_dynamics as newton_euler
from hangtime.devtools.peers.newton_euler import momentum_rate
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Body, Character, Joint
from hangtime.solver.body.dynamics import MomentFunction
from hangtime.solver.body.inverse_dynamics import InverseDynamics, JointTorques, Movement
from hangtime.solver.body.joint_axes import JointAxes
from hangtime.solver.body.kinematics import BodyPoint, forward_kinematics, point_velocity
from hangtime.solver.body.passive_joints import moment_components
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.numerics.batch_function import BatchFunction
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.transcription.motion import motion_inverse_dynamics
from hangtime.solver.transcription.transcription import Transcription
from hangtime.tests.helpers.fitted_hop import fitted_hop

SEEDS = range(8)
INSTANTS = 6


def random_body(random: np.random.Generator, name: str) -> Body:
    mass = random.uniform(0.3, 9.0)
    size = random.uniform(0.05, 0.4, 3)
    turn = rotation_matrix(random.normal(size=3))
    inertia = turn @ np.diag(mass * (size @ size - size**2) / 12.0) @ turn.T
    com = 0.2 * random.normal(size=3)
    return Body(
        name, name, Part.SPINE, Side.MIDDLE, mass, com, inertia, com, size, turn, np.zeros(3)
    )


def random_tree(seed: int, bodies: int = 9) -> Character:
    random = np.random.default_rng(seed)
    joints: list[Joint] = []
    first = 0
    for i in range(bodies):
        dofs = 3 if i == 0 else int(random.integers(1, 4))
        before, after = rotation_matrix(random.normal(size=(2, 3)))
        parent = int(random.integers(0, i)) if i else -1
        offset = 0.3 * random.normal(size=3) if i else np.zeros(3)
        joints.append(Joint(parent, offset, JointAxes(dofs, before, after), first))
        first += dofs
    made = [random_body(random, f"body {i}") for i in range(bodies)]
    return Character(tuple(made), tuple(joints), 1.7)


def random_points(seed: int, character: Character, count: int = 4) -> tuple[BodyPoint, ...]:
    random = np.random.default_rng(100 + seed)
    chosen = random.integers(0, len(character.bodies), count)
    return tuple(BodyPoint(int(b), 0.3 * random.normal(size=3)) for b in chosen)


def random_movement(seed: int, n: int) -> list[FloatArray]:
    """Angles, velocities and accelerations (INSTANTS, n)."""
    random = np.random.default_rng(200 + seed)
    return [scale * random.normal(size=(INSTANTS, n)) for scale in (1.2, 4.0, 30.0)]


def relative(ours: FloatArray, theirs: FloatArray) -> float:
    return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


def central(
    function: Callable[[FloatArray], FloatArray], x: FloatArray, step: float = 1e-6
) -> FloatArray:
    """(..., n) derivatives of function at x (n,) by central differences."""
    columns = []
    for i in range(len(x)):
        shift = np.zeros(len(x))
        shift[i] = step
        columns.append((function(x + shift) - function(x - shift)) / (2 * step))
    return np.stack(columns, axis=-1)


# -- against MuJoCo ------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_inverse_dynamics_of_random_trees_is_mujocos(seed: int) -> None:
    character = random_tree(seed)
    points = random_points(seed, character)
    q, v, a = random_movement(seed, character.n_angles)
    random = np.random.default_rng(300 + seed)
    com = [random.normal(size=(INSTANTS, 3)) for _ in range(3)]
    forces = 300.0 * random.normal(size=(INSTANTS, len(points), 3))

    model = mujoco.MjModel.from_xml_string(mjcf(character, points))
    qpos, qvel, qacc = state(character, com, (q, v, a))
    theirs, centre = inverse_dynamics(model, (qpos, qvel, qacc), forces)
    root_force, root_moment = root_wrench(qpos, theirs, centre)
    ours = InverseDynamics(character, points)(q, v, a, com[2], forces)

    np.testing.assert_allclose(centre, com[0], atol=1e-12)
    assert relative(ours.root_force, root_force) < 1e-9
    assert relative(ours.root_moment, root_moment) < 1e-9
    order = hinge_order(character) - 3
    assert relative(ours.torques[:, order], theirs[:, 6:]) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("orthogonal", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_derivatives_of_torques_are_those_of_expressions(seed: int, orthogonal: bool) -> None:
    character, random = random_tree(seed), np.random.default_rng(100 + seed)
    n = character.n_angles
    points = [BodyPoint(int(random.integers(9)), 0.2 * random.normal(size=3)) for _ in range(3)]
    angles = random.permutation(np.arange(3, n))[: n // 2]
    x = ca.SX.sym("x", 3 * n + 12)
    q, v, a, com, forces = ca.vertsplit(x, [0, n, 2 * n, 3 * n, 3 * n + 3, 3 * n + 12])
    every = newton_euler(
        character, points, q, v, a, com, ca.reshape(forces, 3, 3), orthogonal=orthogonal
    )
    wanted = every[(angles + 3).tolist()]
    at = random.normal(size=(INSTANTS, 3 * n + 12))
    value, by = BatchFunction("torques", x, [wanted, ca.jacobian(wanted, x)])(at)
    q, v, a, com, forces = np.split(at, [n, 2 * n, 3 * n, 3 * n + 3], axis=1)
    pose = forward_kinematics(character, q)
    movement = Movement(pose, v, a, com, forces.reshape(-1, 3, 3))
    torques = JointTorques(character, points, angles, orthogonal=orthogonal)
    assert torques.value(movement) == pytest.approx(value, abs=1e-11 * np.abs(value).max())
    found = torques.derivatives(movement)
    parts = [found.by_angle, found.by_speed, found.by_acceleration, found.by_com_acceleration]
    ours = np.concatenate([*parts, found.by_force.reshape(INSTANTS, len(angles), 9)], axis=2)
    assert ours == pytest.approx(by.swapaxes(1, 2), abs=1e-11 * np.abs(by).max())


@pytest.mark.parametrize("seed", SEEDS)
def test_root_rows_of_random_trees_are_mujocos(seed: int) -> None:
    """The solver's own equations: m c'' - m g - sum f, and L' - sum (p - c) x f."""
    character = random_tree(seed)
    points = random_points(seed, character)
    q, v, a = random_movement(seed, character.n_angles)
    random = np.random.default_rng(400 + seed)
    com = [random.normal(size=(INSTANTS, 3)) for _ in range(3)]
    forces = 300.0 * random.normal(size=(INSTANTS, len(points), 3))

    x = [ca.SX.sym(name, character.n_angles) for name in "qva"]
    function = BatchFunction("rate", ca.vertcat(*x), [momentum_rate(character, *x)])
    (rate,) = function(np.concatenate([q, v, a], axis=1))
    arms = forward_kinematics(character, q).points(points)
    ours_moment = rate - np.cross(arms, forces).sum(axis=1)
    gravity = np.array([0.0, 0.0, -STANDARD_GRAVITY])
    ours_force = character.mass * (com[2] - gravity) - forces.sum(axis=1)

    model = mujoco.MjModel.from_xml_string(mjcf(character, points))
    qpos, qvel, qacc = state(character, com, (q, v, a))
    theirs, centre = inverse_dynamics(model, (qpos, qvel, qacc), forces)
    force, moment = root_wrench(qpos, theirs, centre)
    assert relative(ours_force, force) < 1e-9
    assert relative(ours_moment, moment) < 1e-9
    scaled = MomentFunction(character).value(q, v, a) * character.mass * STANDARD_GRAVITY
    assert relative(scaled, rate) < 1e-12


def test_orthogonal_components_are_the_whole_moment_near_gimbal_lock_too() -> None:
    frame, moment = ca.DM(rotation_matrix(np.array([0.2, -0.4, 0.1]))), ca.DM([3.0, -4.0, 12.0])
    for middle in (0.1, 0.5 * np.pi):
        angles = ca.DM([0.3, middle, -0.4])
        whole = moment_components(frame, angles, moment, orthogonal=True)
        assert float(ca.norm_2(whole)) == pytest.approx(13.0)
    along = moment_components(frame, angles, moment, orthogonal=False)
    assert float(along[2]) == pytest.approx(float(along[0]))  # its own axes tell two of three


def test_a_wrong_inertia_is_noticed() -> None:
    """The comparison can fail: one body's inertia off by a thousandth shows."""
    character = random_tree(1)
    q, v, a = random_movement(1, character.n_angles)
    com = [np.zeros((INSTANTS, 3))] * 3
    none = np.zeros((INSTANTS, 0, 3))
    body = character.bodies[3]
    wrong = replace(body, inertia=1.001 * body.inertia)
    other = replace(character, bodies=(*character.bodies[:3], wrong, *character.bodies[4:]))
    model = mujoco.MjModel.from_xml_string(mjcf(other))
    qpos, qvel, qacc = state(character, com, (q, v, a))
    theirs, centre = inverse_dynamics(model, (qpos, qvel, qacc), none)
    _, moment = root_wrench(qpos, theirs, centre)
    ours = InverseDynamics(character)(q, v, a, com[2], none)
    assert relative(ours.root_moment, moment) > 1e-6


# -- Jacobians -----------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_moment_jacobian(seed: int) -> None:
    character = random_tree(seed, bodies=6)
    n = character.n_angles
    function = MomentFunction(character)
    q, v, a = random_movement(seed, n)
    value, jacobian = function.jacobian(q, v, a)
    np.testing.assert_allclose(value, function.value(q, v, a), rtol=1e-12, atol=1e-12)
    for i in range(2):

        def moved(x: FloatArray) -> FloatArray:
            return np.asarray(function.value(*(part[None] for part in np.split(x, 3)))[0])

        numeric = central(moved, np.concatenate([q[i], v[i], a[i]]))
        assert relative(jacobian[i].reshape(3, 3 * n), numeric) < 1e-7


@pytest.mark.parametrize("seed", SEEDS)
def test_moment_jacobian_is_the_expressions(seed: int) -> None:
    """Against CasADi's derivatives of the same equations, to rounding."""
    character = random_tree(seed)
    x = [ca.SX.sym(name, character.n_angles) for name in "qva"]
    rate = momentum_rate(character, *x) / (character.mass * STANDARD_GRAVITY)
    every = ca.vertcat(*x)
    function = BatchFunction("rate", every, [rate, ca.jacobian(rate, every)])
    state = random_movement(seed, character.n_angles)
    value, jacobian = function(np.concatenate(state, axis=1))
    ours_value, ours = MomentFunction(character).jacobian(*state)
    assert relative(ours_value, value) < 1e-12
    theirs = np.swapaxes(jacobian, 1, 2).reshape(ours.shape)
    for order in range(3):
        assert relative(ours[:, :, order], theirs[:, :, order]) < 1e-12


@pytest.mark.parametrize("seed", SEEDS)
def test_point_jacobian(seed: int) -> None:
    character = random_tree(seed)
    points = random_points(seed, character)
    q = random_movement(seed, character.n_angles)[0]
    jacobian = forward_kinematics(character, q).point_jacobian(points)
    for i in range(2):
        numeric = central(lambda x: forward_kinematics(character, x[None]).points(points)[0], q[i])
        assert relative(jacobian[i], numeric) < 1e-7


@pytest.mark.parametrize("seed", SEEDS)
def test_metric_and_gradient_of_points_are_their_jacobians(seed: int) -> None:
    character = random_tree(seed)
    points = random_points(seed, character, 7)
    posed = forward_kinematics(character, random_movement(seed, character.n_angles)[0])
    jacobian = posed.point_jacobian(points)
    squares, total = posed.points_metric(points)
    assert relative(squares, np.einsum("npij,npik->njk", jacobian, jacobian)) < 1e-12
    assert relative(total, jacobian.sum(axis=1)) < 1e-12
    forces = np.random.default_rng(seed).normal(size=(INSTANTS, len(points), 3))
    expected = np.einsum("npij,npi->nj", jacobian, forces)
    assert relative(posed.points_gradient(points, forces), expected) < 1e-12


@pytest.mark.parametrize("seed", SEEDS)
def test_point_velocity_and_its_jacobian(seed: int) -> None:
    character = random_tree(seed, bodies=6)
    points = random_points(seed, character)
    q, v, _ = random_movement(seed, character.n_angles)
    posed = forward_kinematics(character, q)
    speeds, *jacobian = point_velocity(posed, points, v)
    by_angle = posed.point_jacobian(points)
    np.testing.assert_allclose(speeds, np.einsum("npij,nj->npi", by_angle, v), atol=1e-11)
    for i in range(2):

        def moved(x: FloatArray) -> FloatArray:
            angles, rates = np.split(x, 2)
            posed = forward_kinematics(character, angles[None])
            return np.asarray(point_velocity(posed, points, rates[None])[0][0])

        numeric = central(moved, np.concatenate([q[i], v[i]]))
        ours = np.concatenate([by[i] for by in jacobian], axis=-1)
        assert relative(ours, numeric) < 1e-7


# -- the whole system of equations on a real jump ------------------------------------------


def random_unknowns(transcription: Transcription, x: FloatArray) -> FloatArray:
    random = np.random.default_rng(5)
    return x + transcription.active * 0.03 * random.normal(size=x.shape)


PHYSICS = {
    RowKind.BALANCE,
    RowKind.MOMENT,
    RowKind.PIN,
    RowKind.PIN_SPEED,
    RowKind.PUSH,
    RowKind.FRICTION,
}


def test_rows_jacobian() -> None:
    """Along random directions, every row at once; unknowns near a valid motion but off it."""
    fitted = fitted_hop()
    t = fitted.motion.transcription
    x = random_unknowns(t, fitted.motion.x)
    rows = t.rows(x, fitted.places)
    assert set(rows.kind) == PHYSICS
    np.testing.assert_allclose(rows.value, t.values(x, fitted.places), atol=1e-12)
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(4)
    random = np.random.default_rng(6)
    step = 1e-6
    for _ in range(10):
        d = random.normal(size=x.shape) * t.active
        ahead, behind = (t.values(x + sign * step * d, fitted.places) for sign in (1, -1))
        numeric = (ahead - behind) / (2 * step)
        ours = np.einsum("rkn,rkn->r", rows.jacobian, d[blocks])
        for kind in PHYSICS:
            of_kind = rows.kind == kind
            assert relative(ours[of_kind], numeric[of_kind]) < 1e-6, kind


def test_every_force_row_knows_its_own_unknowns() -> None:
    """A row's Jacobian is complete: single unknowns, not only directions, change what it says."""
    fitted = fitted_hop()
    t = fitted.motion.transcription
    x = random_unknowns(t, fitted.motion.x)
    rows = t.rows(x, fitted.places)
    dense = np.zeros((len(rows.span), *x.shape))
    blocks = t.basis.first_coefficient[rows.span][:, None] + np.arange(4)
    np.add.at(dense, (np.arange(len(rows.span))[:, None], blocks), rows.jacobian)
    random = np.random.default_rng(7)
    candidates = np.argwhere(t.active)
    for block, column in candidates[random.choice(len(candidates), 40, replace=False)]:
        d = np.zeros_like(x)
        d[block, column] = 1e-6
        ahead, behind = (t.values(x + sign * d, fitted.places) for sign in (1, -1))
        numeric = (ahead - behind) / 2e-6
        np.testing.assert_allclose(dense[:, block, column], numeric, atol=2e-6)


@pytest.mark.slow
def test_efforts_of_an_adapted_jump_leave_nothing_at_the_root() -> None:
    fitted = fitted_hop()
    adapted = adapt(fitted, MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.2, 0, 0)),)))
    assert adapted.solved
    motion = adapted.motion
    t = motion.transcription
    efforts = motion_inverse_dynamics(InverseDynamics(t.character, t.points), motion, t.node_times)
    weight = t.character.mass * STANDARD_GRAVITY
    assert np.abs(efforts.root_force).max() < 1e-4 * weight
    assert np.abs(efforts.root_moment).max() < 1e-4 * weight
    assert 50.0 < np.abs(efforts.torques).max() < 2000.0
