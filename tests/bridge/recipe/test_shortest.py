"""Numbers of single precision, written as typed."""

import math

import numpy as np
import pytest
from hangtime.bridge.recipe.shortest import shortest
from hypothesis import given
from hypothesis import strategies as st


@pytest.mark.parametrize("typed", [0.3, 70.3, -1.1, 1e-5, 3.0, math.radians(30.0)])
def test_what_single_precision_made_of_a_number_is_undone(typed: float) -> None:
    assert shortest((float(np.float32(typed)),)) == (typed,)


@given(st.floats(width=32, allow_nan=False))
def test_the_number_stays_the_same_in_single_precision(number: float) -> None:
    assert np.float32(shortest(number)) == np.float32(number)


@given(st.floats())
def test_a_number_of_double_precision_stays(number: float) -> None:
    if abs(number) < 1e30 and float(np.float32(number)) != number:
        assert shortest(number) == number
