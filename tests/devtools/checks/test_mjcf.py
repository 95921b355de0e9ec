"""The exported MJCF and states: what MuJoCo makes of them is what our own kinematics says."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from hangtime.devtools.checks.mjcf import hinge_order, mjcf, qacc, qpos, qvel
from hangtime.devtools.checks.mujoco_check import check_motion, check_npz
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.results.npz_export import sample
from hangtime.tests.helpers.fitted_hop import fitted_hop


def model() -> mujoco.MjModel:
    t = fitted_hop().motion.transcription
    return mujoco.MjModel.from_xml_string(mjcf(t.character, t.points))


def instants() -> np.ndarray:
    """Some instants, none on a knot."""
    return np.linspace(0.0123, fitted_hop().motion.duration - 0.0123, 40)


def test_the_model_is_the_character() -> None:
    character, made = fitted_hop().motion.transcription.character, model()
    assert made.nv == character.n_dofs
    assert made.nq == character.n_dofs + 1
    assert made.nbody == len(character.bodies) + 1
    assert made.ngeom == 0
    np.testing.assert_allclose(made.body_mass.sum(), character.mass)
    np.testing.assert_allclose(made.opt.gravity, [0.0, 0.0, -STANDARD_GRAVITY])
    names = [made.joint(j).name for j in range(1, made.njnt)]
    assert names == [f"angle {i}" for i in hinge_order(character)]


def test_bodies_and_points_are_where_ours_are() -> None:
    motion, times = fitted_hop().motion, instants()
    made = model()
    data = mujoco.MjData(made)
    posed, com = motion.pose(times), motion.com(times)
    points = motion.contact_points(times)
    for i, q in enumerate(qpos(motion, times)):
        data.qpos[:] = q
        mujoco.mj_kinematics(made, data)
        mujoco.mj_comPos(made, data)
        np.testing.assert_allclose(data.subtree_com[1], com[i], atol=1e-12)
        for b, body in enumerate(motion.transcription.character.bodies):
            at = data.body(f"{b} {body.name}")
            np.testing.assert_allclose(at.xpos, posed.centres[i, b] + com[i], atol=1e-12)
            np.testing.assert_allclose(at.xipos, posed.body_coms[i, b] + com[i], atol=1e-12)
        for p in range(points.shape[1]):
            np.testing.assert_allclose(data.site(f"point {p}").xpos, points[i, p], atol=1e-12)


def test_velocities_and_accelerations_are_those_of_the_positions() -> None:
    """By MuJoCo's own difference of positions, which knows the free joint's conventions."""
    motion, times, step = fitted_hop().motion, instants(), 1e-6
    made = model()
    before, after = (qpos(motion, times + sign * step) for sign in (-1, 1))
    speeds, rates = qvel(motion, times), qacc(motion, times)
    slower, faster = (qvel(motion, times + sign * step) for sign in (-1, 1))
    np.testing.assert_allclose((faster - slower) / (2 * step), rates, atol=1e-4)
    for i in range(len(times)):
        numeric = np.zeros(made.nv)
        mujoco.mj_differentiatePos(made, numeric, 2 * step, before[i], after[i])
        np.testing.assert_allclose(numeric, speeds[i], atol=1e-6)


def test_a_fit_is_physical_by_both_checks(tmp_path: Path) -> None:
    motion = fitted_hop().motion
    arrays = sample(motion)
    np.savez(tmp_path / "trajectory.npz", **arrays)
    by_mujoco, _ = check_motion(motion)
    by_newton = check_npz(tmp_path / "trajectory.npz")
    for residual in (by_mujoco, by_newton):
        assert 250 < residual.flying.sum() < len(residual.flying) / 3
        for flying, most in ((True, 0.001), (False, 0.02)):
            assert residual.rms("force", flying) < most
            assert residual.rms("moment", flying) < most


@pytest.mark.parametrize(
    ("array", "factor"),
    [("gravity", 1.01), ("contact_force", 1.05), ("inertia", 2.0)],
)
def test_the_npz_check_notices(tmp_path: Path, array: str, factor: float) -> None:
    arrays = sample(fitted_hop().motion)
    np.savez(tmp_path / "right.npz", **arrays)
    np.savez(tmp_path / "wrong.npz", **{**arrays, array: factor * arrays[array]})
    right, wrong = (check_npz(tmp_path / f"{name}.npz") for name in ("right", "wrong"))
    part = "moment" if array == "inertia" else "force"
    assert wrong.rms(part, flying=False) > 3.0 * right.rms(part, flying=False)
