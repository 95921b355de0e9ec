"""Passive joint torques: a relaxed limb hangs, and its swing dies away as in the pendulum test."""

import numpy as np
import pytest
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Character, Joint
from hangtime.solver.body.joint_axes import JointAxes
from hangtime.solver.body.passive_joints import evaluate_passive_torques, neutral_rotation
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.tests.helpers.toy_problems import body, figure

ARM = body("arm", Part.UPPER_ARM, Side.LEFT, 3.5, (0.6, 0.0, 0.0))  # sideways at rest
SHANK_MASS, SHANK_CENTRE, SHANK_INERTIA = 4.3, 0.25, 0.4  # with its foot; about the knee


def random_pose(seed: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    return random.normal(size=(1, figure().n_angles)), random.normal(size=(1, figure().n_angles))


def hinge(mass: float) -> Character:
    """A trunk of such a mass that the whole weighs `mass`, and a shank on a hinge."""
    trunk = body("trunk", Part.PELVIS, Side.MIDDLE, mass - SHANK_MASS, (0.0, 0.0, 0.5))
    shank = body("shank", Part.SHANK, Side.LEFT, SHANK_MASS, (0.0, 0.0, -0.5))
    axes = JointAxes(3, np.eye(3), np.eye(3)), JointAxes(1, np.eye(3), np.eye(3))
    joints = Joint(-1, np.zeros(3), axes[0], 0), Joint(0, np.zeros(3), axes[1], 3)
    return Character((trunk, shank), joints, 1.7)


def passive(angle: float, speed: float, mass: float = 70.0) -> float:
    """N·m at the knee of `hinge`."""
    q, v = np.array([[0.0, 0.0, 0.0, angle]]), np.array([[0.0, 0.0, 0.0, speed]])
    return float(evaluate_passive_torques(hinge(mass), q, v)[0, 3])


def test_an_arm_that_is_sideways_at_rest_hangs_when_relaxed() -> None:
    assert neutral_rotation(ARM) @ [1.0, 0.0, 0.0] == pytest.approx([0.0, 0.0, -1.0])
    assert np.linalg.det(neutral_rotation(ARM)) == pytest.approx(1.0)


def test_they_are_none_in_the_neutral_pose_and_grow_with_the_mass() -> None:
    assert passive(0.0, 0.0) == 0.0
    assert passive(0.1, 0.0) == pytest.approx(-0.4, rel=0.01)  # 4 N·m/rad
    assert passive(0.1, 0.0, 140.0) == pytest.approx(2.0 * passive(0.1, 0.0))


@pytest.mark.parametrize("seed", range(3))
def test_the_spring_is_an_energy_and_the_damper_takes_some(seed: int) -> None:
    """Round a loop of poses the springs do no work; a movement always loses some."""
    q, v = random_pose(seed)
    loop = np.linspace(0.0, 2.0 * np.pi, 401)[:, None]
    poses = q + 0.5 * np.sin(loop + v)
    moved = np.gradient(poses, loop[:, 0], axis=0)
    still = evaluate_passive_torques(figure(), poses, np.zeros_like(poses))
    power = (still * moved).sum(axis=1)
    assert np.abs(power).max() > 0.1
    assert abs(np.trapz(power, loop[:, 0])) < 1e-3
    lost = evaluate_passive_torques(figure(), poses, moved) - still
    assert ((lost * moved).sum(axis=1) < 0.0).all()


def test_a_relaxed_shank_swings_two_thirds_as_far_each_time() -> None:
    """Wartenberg's pendulum test: 0.94, 0.60, 0.38 and 0.26 rad of a healthy leg."""
    stiffness, damping = -passive(1e-3, 0.0) / 1e-3, -passive(0.0, 1.0)
    stiffness += SHANK_MASS * STANDARD_GRAVITY * SHANK_CENTRE
    natural = np.sqrt(stiffness / SHANK_INERTIA)
    decay = 0.5 * damping / SHANK_INERTIA
    period = 2.0 * np.pi / np.sqrt(natural**2 - decay**2)
    assert np.exp(-decay * period) == pytest.approx(0.64, abs=0.05)
    assert period == pytest.approx(1.1, abs=0.1)
