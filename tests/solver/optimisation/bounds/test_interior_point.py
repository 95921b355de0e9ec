"""Programs of many rows that are near each other in time and have narrow intervals, as torques of a
limp limb: the working set is told, and multipliers from it meet the optimality conditions."""

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.optimisation.bounds.active_set import multipliers_by_active_set
from hangtime.solver.optimisation.bounds.interior_point import predicted_sides

SOFT = 1e-7


def limp(
    rows: int, width: float, seed: int = 0, free: int = 0
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stiffness, lower and upper of rows whose neighbours move together; of the first `free` only
    the upper bound counts."""
    random = np.random.default_rng(seed)
    apart = np.arange(rows)[:, None] - np.arange(rows)
    stiffness = np.exp(-((apart / 6.0) ** 2)) + SOFT * np.eye(rows)
    wanted = np.cumsum(random.normal(size=rows))
    middle = np.convolve(wanted, np.ones(9) / 9.0, mode="same")
    lower, upper = middle - width, middle + width
    lower[:free] = -np.inf
    return stiffness, lower, upper


def assert_optimal(
    stiffness: FloatArray, lower: FloatArray, upper: FloatArray, u: FloatArray
) -> None:
    """Rows are within their bounds, and push only at the bound that their multiplier names."""
    reached, near = -stiffness @ u, 1e-6 * float(np.abs(stiffness @ u).max())
    assert (reached <= upper + near).all()
    assert (reached >= lower - near).all()
    assert reached[u > 0.0] == pytest.approx(upper[u > 0.0], abs=near)
    assert reached[u < 0.0] == pytest.approx(lower[u < 0.0], abs=near)


@pytest.mark.parametrize("free", [0, 60])
@pytest.mark.parametrize("width", [1e-4, 1e-2, 1.0])
def test_the_predicted_set_is_the_one_that_the_active_set_method_ends_in(
    width: float, free: int
) -> None:
    stiffness, lower, upper = limp(200, width, free=free)
    sides = predicted_sides(stiffness, lower, upper)
    assert sides is not None
    u = multipliers_by_active_set(stiffness, lower, upper, np.zeros(200))
    assert u is not None
    assert_optimal(stiffness, lower, upper, u)
    # Rows that hardly push at all may be told either way.
    pushing = np.abs(u) > 1e-6 * np.abs(u).max()
    assert (sides == np.sign(u))[pushing].all()


def test_from_any_guess_the_multipliers_are_the_same() -> None:
    stiffness, lower, upper = limp(200, 1e-3)
    random = np.random.default_rng(1)
    guesses = (np.zeros(200), np.ones(200), random.choice([-1.0, 0.0, 1.0], size=200))
    found = [multipliers_by_active_set(stiffness, lower, upper, guess) for guess in guesses]
    for u in found:
        assert u is not None
        assert_optimal(stiffness, lower, upper, u)
        assert u == pytest.approx(found[0], rel=1e-4, abs=1e-4 * float(np.abs(u).max()))


def test_what_is_not_positive_is_told_as_no_set() -> None:
    stiffness, lower, upper = limp(40, 1e-3)
    assert predicted_sides(-10.0 * stiffness, lower, upper) is None
