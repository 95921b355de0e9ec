"""The move of the last stance, with which the rest of a take goes."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.results.last_stance import last_stance_move
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop


def test_what_nobody_moves_stays_to_the_last_bit() -> None:
    move = last_stance_move(adapt(fitted_hop(), MotionProblem()))
    assert move is not None
    assert move.stays
    assert move.shift == (0.0, 0.0, 0.0)


def test_a_landing_that_is_moved_and_turned_takes_the_rest_along() -> None:
    pin = Pin("Landing", "ground 2", (), offset=(0.1, 0.05, 0.0), turn=radians(20.0))
    adaptation = adapt(fitted_hop(), MotionProblem(pins=(pin,)))
    move = last_stance_move(adaptation)
    assert move is not None
    assert move.phase == "ground 2"
    assert move.turn == pytest.approx(radians(20.0), abs=1e-9)
    assert np.hypot(*move.shift[:2]) == pytest.approx(np.hypot(0.1, 0.05), abs=1e-9)
    assert move.shift[2] == pytest.approx(0.0, abs=1e-9)
    assert not move.stays
    assert move.scaled(2.0).shift == pytest.approx(np.multiply(2.0, move.shift))


@pytest.mark.slow
def test_a_motion_short_of_its_target_takes_the_rest_along_as_far_as_it_goes() -> None:
    pin = Pin("Landing", "ground 2", offset=(0.0, 0.0, 3.0))
    adaptation = adapt(fitted_hop(), MotionProblem(pins=(pin,)))
    move = last_stance_move(adaptation)
    assert move is not None
    assert 0.0 < adaptation.reached < 1.0
    assert move.shift[2] == pytest.approx(3.0 * adaptation.reached, rel=0.01)
