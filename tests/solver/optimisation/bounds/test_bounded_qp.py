"""Bounds in a step: the small program and the correction against other solvers of the same."""

from collections.abc import Callable

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray, IntArray
from hangtime.solver.numerics.block_banded import BANDWIDTH, BlockBanded, LocalColumns
from hangtime.solver.optimisation.bounds import bounded_qp
from hangtime.solver.optimisation.bounds.active_set import multipliers_by_active_set
from hangtime.solver.optimisation.bounds.bounded_qp import BoundedStep
from hangtime.solver.transcription.rows import violation
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear, nnls

SEED = st.integers(0, 2**31)
SIZE = 3
WINDOW = BANDWIDTH + 1


def random_root(random: np.random.Generator, m: int) -> np.ndarray:
    half = random.normal(size=(m, m + 2))
    return np.linalg.cholesky(half @ half.T)


def random_bounds(random: np.random.Generator, m: int) -> tuple[np.ndarray, np.ndarray]:
    """Some two-sided, some one-sided, some equal, most of them missed at zero."""
    middle, half = random.normal(size=m), np.abs(random.normal(size=m))
    lower, upper = middle - half, middle + half
    kind = random.integers(0, 4, m)
    lower[kind == 0], upper[kind == 1] = -np.inf, np.inf
    return lower, np.where(kind == 2, lower, upper)


def program(random: np.random.Generator, m: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Root (m, m), lower and upper bounds (m,)."""
    return random_root(random, m), *random_bounds(random, m)


def answer(
    root: FloatArray, lower: FloatArray, upper: FloatArray, guess: FloatArray | None = None
) -> FloatArray:
    u = multipliers_by_active_set(
        root @ root.T, lower, upper, np.zeros(len(root)) if guess is None else guess
    )
    assert u is not None
    return u


def assert_optimal(
    stiffness: FloatArray, u: FloatArray, lower: FloatArray, upper: FloatArray
) -> None:
    """The optimality conditions, which are enough where everything is convex."""
    reached = -stiffness @ u
    size = 1e-8 * (1.0 + np.abs(reached).max())
    assert np.abs(violation(reached, lower, upper)).max() < size
    at = np.where(lower == upper, upper, np.where(u > 0.0, upper, lower))
    assert reached[u != 0.0] == pytest.approx(at[u != 0.0], abs=size)


@settings(max_examples=60)
@given(SEED, st.integers(1, 12))
def test_the_small_program_s_answer_is_scipy_s(seed: int, m: int) -> None:
    """With y = root w it is a least-squares problem with bounds on y."""
    root, lower, upper = program(np.random.default_rng(seed), m)
    u = answer(root, lower, upper)
    apart = np.where(lower == upper, upper + 1e-10, upper)  # scipy wants them so
    best = lsq_linear(np.linalg.inv(root), np.zeros(m), (lower, apart), tol=1e-14)
    w = -root.T @ u
    assert root @ w == pytest.approx(best.x, abs=1e-5 * (1.0 + np.abs(best.x).max()))


@pytest.mark.parametrize("worst", [np.nan, np.inf])
def test_no_program_is_solved_that_is_not_of_numbers(worst: float) -> None:
    with pytest.raises(np.linalg.LinAlgError):
        answer(np.eye(2), np.array([0.0, worst]), np.array([1.0, worst]))


@settings(max_examples=100)
@given(SEED, st.integers(1, 30))
def test_multipliers_push_from_the_bound_they_are_at_whatever_the_guess(seed: int, m: int) -> None:
    random = np.random.default_rng(seed)
    root, lower, upper = program(random, m)
    u = answer(root, lower, upper, random.normal(size=m))
    assert_optimal(root @ root.T, u, lower, upper)


@settings(max_examples=20)
@given(SEED, st.floats(1e-4, 1e-1))
@pytest.mark.slow
def test_rows_that_hardly_differ_are_told_apart(seed: int, width: float) -> None:
    """A torque's at instants close together, kept between narrow bounds: of such programs a
    primal-dual active set method cycles in most."""
    random, m = np.random.default_rng(seed), 120
    apart = np.subtract.outer(np.arange(m), np.arange(m)) / 6.0
    stiffness = np.exp(-(apart**2)) + 1e-7 * np.eye(m)
    middle = np.cumsum(random.normal(size=m)) / 10.0
    lower, upper = middle - width, middle + width
    u = multipliers_by_active_set(stiffness, lower, upper, np.zeros(m))
    assert u is not None
    assert_optimal(stiffness, u, lower, upper)
    again = multipliers_by_active_set(stiffness, lower, upper, u)
    assert again == pytest.approx(u, abs=1e-6 * np.abs(u).max())


def test_bounds_that_hold_need_no_push() -> None:
    root = random_root(np.random.default_rng(0), 5)
    assert not answer(root, np.full(5, -1.0), np.full(5, np.inf)).any()


def test_no_row_is_lost_in_the_rounding_of_another_unit() -> None:
    """Two rows in thousandths that contradict each other, and one in thousands that is beyond."""
    root = np.array([[1e-3, 0.0], [1e-3, 0.0], [0.0, 1e3]])
    stiffness = root @ root.T
    stiffness += np.diag(1e-7 * np.diagonal(stiffness))
    lower = upper = np.array([-1e-2, 1e-2, -0.5])
    u = multipliers_by_active_set(stiffness, lower, upper, np.array([1.0, -1.0, 0.0]))
    assert u is not None
    assert -stiffness @ u == pytest.approx(upper, abs=1e-6)


# -- the correction of a step ---------------------------------------------------------------


class Problem:
    """min 1/2 d'A d subject to lower <= z + G d <= upper, banded and dense."""

    def __init__(self, seed: int, blocks: int, rows: int) -> None:
        random = np.random.default_rng(seed)
        n = WINDOW * SIZE
        half = random.normal(size=(blocks - BANDWIDTH, n, n + 1))
        windows = half @ np.swapaxes(half, 1, 2)
        banded = BlockBanded(blocks, SIZE)
        banded.add_windows(
            np.arange(blocks - BANDWIDTH), windows.reshape(-1, WINDOW, SIZE, WINDOW, SIZE)
        )
        banded.add_diagonal(np.full((blocks, SIZE), 0.5))
        self.factor = banded.factor()
        units = np.eye(blocks * SIZE).reshape(-1, blocks, SIZE)
        self.A = np.stack([banded.times(unit).ravel() for unit in units])
        self.G = np.zeros((rows, blocks, SIZE))
        for row in self.G:
            first = random.integers(0, blocks - BANDWIDTH)
            row[first : first + WINDOW] = random.normal(size=(WINDOW, SIZE))
        self.z = random.normal(size=rows)
        self.lower, self.upper = random_bounds(random, rows)

    @property
    def times(self) -> Callable[[FloatArray], FloatArray]:
        return lambda d: np.einsum("rkn,kn->r", self.G, d)

    def columns(self, rows: IntArray) -> LocalColumns:
        return LocalColumns(0, np.moveaxis(self.G[rows], 0, 2))

    def step(self, sides: FloatArray | None = None, series: int = 0) -> BoundedStep:
        """series: how many the rows are of; 0 each is its own."""
        each = np.arange(len(self.z))
        return BoundedStep(
            self.factor,
            self.columns,
            np.zeros(len(self.z), dtype=int),
            each % series if series else each,
            (self.lower, self.upper),
            np.full(len(self.z), 1e-6),
            np.zeros(len(self.z)) if sides is None else sides,
        )

    def reference(self) -> np.ndarray:
        """d by non-negative least squares: least distance programming (Lawson & Hanson 23.4)."""
        G = self.G.reshape(len(self.z), -1)
        lower, upper = self.lower - self.z, self.upper - self.z
        above, below = np.isfinite(lower), np.isfinite(upper)
        least = np.concatenate([lower[above], -upper[below]])
        root = np.linalg.cholesky(self.A)
        rows = np.linalg.solve(root, np.concatenate([G[above], -G[below]]).T)
        both = np.vstack([rows, least])
        last = np.eye(len(both))[-1]
        residual = both @ nnls(both, last)[0] - last
        assert abs(residual[-1]) > 1e-9, "the rows contradict each other"
        return np.linalg.solve(root.T, -residual[:-1] / residual[-1]).reshape(self.G.shape[1:])


def corrected(problem: Problem, bounded: BoundedStep) -> np.ndarray:
    """Of no step at all."""
    still = np.zeros(problem.G.shape[1:])
    change, reached = bounded.correct(still, problem.z, problem.times)
    assert reached == pytest.approx(problem.z + problem.times(change))
    return change


def settled(problem: Problem, bounded: BoundedStep) -> np.ndarray:
    """As often corrected as the sweeps of a step would, for the rows' softness to vanish."""
    for _ in range(4):
        change = corrected(problem, bounded)
    return change


@settings(max_examples=40)
@example(5971459, 4, 9)  # on which CasADi's qrqp ends outside the bounds and says success
@given(SEED, st.integers(WINDOW, 9), st.integers(1, 10))
def test_the_corrected_step_is_the_dense_program_s(seed: int, blocks: int, rows: int) -> None:
    problem = Problem(seed, blocks, rows)
    change = settled(problem, problem.step())
    best = problem.reference()
    assert change == pytest.approx(best, abs=1e-4 * (1.0 + np.abs(best).max()))


@settings(max_examples=20)
@given(SEED)
def test_multipliers_balance_the_step(seed: int) -> None:
    """A d + G'u = 0."""
    problem = Problem(seed, 6, 8)
    bounded = problem.step()
    change = settled(problem, bounded)
    push = np.einsum("rkn,r->kn", problem.G, bounded.multipliers)
    assert problem.A @ change.ravel() == pytest.approx(-push.ravel(), abs=1e-7)


@settings(max_examples=20)
@given(SEED)
def test_rows_to_begin_with_change_the_way_not_the_answer(seed: int) -> None:
    problem = Problem(seed, 6, 8)
    cold, warm = problem.step(), problem.step(np.ones(8))
    found = settled(problem, warm)
    assert settled(problem, cold) == pytest.approx(found, abs=1e-5 * (1.0 + np.abs(found).max()))


@settings(max_examples=20)
@given(SEED, st.integers(1, 3))
def test_series_change_the_way_not_the_answer(seed: int, count: int) -> None:
    problem = Problem(seed, 6, 8)
    found = settled(problem, problem.step(series=count))
    alone = settled(problem, problem.step())
    assert found == pytest.approx(alone, abs=1e-5 * (1.0 + np.abs(alone).max()))


def test_of_a_series_all_peaks_join_at_once_and_nothing_beside_them() -> None:
    problem = Problem(0, 6, 8)
    problem.z[:] = 0.0
    problem.lower = np.array([1.0, 3.0, 2.0, -1.0, 2.0, -1.0, 1.0, 1.5])
    problem.upper = np.full(8, np.inf)
    joined: list[list[int]] = []

    def columns(rows: IntArray) -> LocalColumns:
        joined.append(rows.tolist())
        return Problem.columns(problem, rows)

    problem.columns = columns  # type: ignore[method-assign]
    corrected(problem, problem.step(series=1))
    assert joined[0] == [1, 4, 7]


def test_a_step_within_its_bounds_is_left_alone() -> None:
    problem = Problem(1, 6, 5)
    problem.lower, problem.upper = problem.z - 1.0, problem.z + 1.0
    bounded = problem.step()
    assert not corrected(problem, bounded).any()
    assert not bounded.sides.any()


def test_a_program_without_an_answer_leaves_the_step_as_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is asked once then, not six times, and again in the next step."""
    problem = Problem(3, 6, 5)
    bounded = problem.step()
    asked: list[int] = []

    def no_answer(stiffness: FloatArray, *_: FloatArray) -> None:
        asked.append(len(stiffness))

    with monkeypatch.context() as lost:
        lost.setattr(bounded_qp, "multipliers_by_active_set", no_answer)
        assert not corrected(problem, bounded).any()
        assert len(asked) == 1
        assert not bounded.sides.any()
    best = problem.reference()
    assert settled(problem, bounded) == pytest.approx(best, abs=1e-4 * (1.0 + np.abs(best).max()))


def test_rows_that_say_the_same_are_one() -> None:
    """Two feet planted: the same row twice, and thrice as large."""
    once = Problem(2, 6, 1)
    once.lower, once.upper = once.z + 1.0, np.array([np.inf])
    thrice = Problem(2, 6, 1)
    thrice.G = np.concatenate([once.G, once.G, 3.0 * once.G])
    thrice.z = np.array([1.0, 1.0, 3.0]) * once.z
    thrice.lower = thrice.z + np.array([1.0, 1.0, 3.0])
    thrice.upper = np.full(3, np.inf)
    best = settled(once, once.step())
    assert once.times(best) == pytest.approx([1.0], abs=1e-5)
    assert settled(thrice, thrice.step()) == pytest.approx(best, abs=1e-5)


@settings(max_examples=20)
@given(SEED)
def test_rows_that_contradict_each_other_still_give_a_finite_step(seed: int) -> None:
    problem = Problem(seed, 6, 4)
    problem.G[1], problem.z[1] = problem.G[0], problem.z[0]
    problem.lower[:2], problem.upper[:2] = [1.0, -np.inf], [np.inf, -1.0]
    bounded = problem.step()
    assert np.isfinite(settled(problem, bounded)).all()
    assert np.isfinite(bounded.multipliers).all()
    empty = np.zeros_like(problem.G)
    problem.G = empty  # no step can change anything
    assert np.isfinite(settled(problem, problem.step())).all()


def test_of_too_many_rows_the_worst_are_met(monkeypatch) -> None:
    """The program stays small enough to be solved; the others are left for the next step."""
    problem = Problem(3, 6, 8)
    monkeypatch.setattr(bounded_qp, "MOST_ROWS", 2)
    off = np.abs(violation(problem.z, problem.lower, problem.upper))
    worst = np.argsort(-off)[:2]
    assert np.count_nonzero(off) > 2
    bounded = problem.step()
    reached = problem.z + problem.times(settled(problem, bounded))
    left = np.abs(violation(reached, problem.lower, problem.upper))
    assert left[worst] == pytest.approx(0.0, abs=1e-5)
    assert set(np.flatnonzero(bounded.multipliers)) <= set(worst)
