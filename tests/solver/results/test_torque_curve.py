"""Torques as splines of their own density."""

import numpy as np
import pytest
from hangtime.solver.results.torque_curve import exact_torques, torque_curve
from hangtime.solver.transcription.torque_constraint import joint_torques
from hangtime.tests.helpers.fitted_hop import fitted_hop


def test_the_chosen_density_is_near_enough() -> None:
    motion = fitted_hop().motion
    torques = joint_torques(motion.transcription)
    curve = torque_curve(motion, torques)
    times = np.linspace(0.01, motion.duration - 0.01, 500)
    exact = exact_torques(motion, torques, times)
    assert curve.error < 0.012 * np.abs(exact).max()
    off = np.sqrt(((curve.at(times) - exact) ** 2).mean(axis=0)).max()
    assert off < 2.0 * curve.error + 1e-6


def test_denser_splines_are_nearer_and_larger() -> None:
    motion = fitted_hop().motion
    torques = joint_torques(motion.transcription)
    coarse, fine = (torque_curve(motion, torques, longest=span) for span in (0.2, 0.05))
    assert fine.error < coarse.error
    assert fine.n_coefficients > coarse.n_coefficients


def test_a_jump_belongs_to_the_stretch_after_it() -> None:
    motion = fitted_hop().motion
    torques = joint_torques(motion.transcription)
    curve = torque_curve(motion, torques, longest=0.02)
    edge = curve.pieces[1].basis.breaks[0]
    at = curve.at(np.array([edge]))
    after = exact_torques(motion, torques, np.array([edge + 1e-5]))
    assert at[0] == pytest.approx(after[0], abs=0.1 * np.abs(after).max())
