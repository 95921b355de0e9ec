"""How a take comes back to where it was before a landing was moved."""

import numpy as np
import pytest
from hangtime.bridge.takes.carry import shares_of_return

FRAMES = np.arange(101.0)
STOOD = 60  # frames, after which the foot goes along with the hips


def test_the_way_back_is_made_while_no_foot_stands() -> None:
    """Though the hips travel throughout, as they do above a foot that has just landed."""
    places = np.zeros((101, 2, 3))
    places[:, 0, 0] = 0.02 * FRAMES
    places[STOOD:, 1, 0] = 0.02 * (FRAMES[STOOD:] - STOOD)
    shares = shares_of_return(FRAMES, places, 0.0, 100.0)
    assert (shares[0], shares[100]) == (1.0, 0.0)
    assert np.diff(shares).max() <= 0.0
    assert shares[STOOD - 2] > 0.95


def test_where_everything_stands_the_take_comes_back_all_the_same() -> None:
    shares = shares_of_return(FRAMES, np.zeros((101, 2, 3)), 0.0, 100.0)
    assert shares[50] == pytest.approx(0.5)
    assert shares[100] == 0.0
