"""How a take comes back to where it was before a landing was moved."""

import numpy as np
import pytest
from hangtime.bridge.takes.joining.carry import shares_of_return, slid
from hangtime.solver.data.stance_move import StanceMove

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


@pytest.mark.parametrize(("speed", "slides"), [(0.0, 0.5), (0.1, 0.0)])
def test_what_stands_slides_with_the_way_back_and_what_travels_does_not(
    speed: float, slides: float
) -> None:
    move = StanceMove("ground 2", (0.0, 0.0, 0.0), 0.0, (0.3, 0.4, 0.0))
    places = np.zeros((101, 2, 3))
    places[:, 0, 0] = 0.2 * FRAMES
    places[:, 1, 0] = speed * FRAMES
    shares = shares_of_return(FRAMES, places, 0.0, 100.0)
    assert slid(places, move, shares) == pytest.approx(slides, abs=1e-9)
