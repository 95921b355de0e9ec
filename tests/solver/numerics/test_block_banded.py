"""Block-banded factorisation against dense numpy."""

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.numerics.block_banded import (
    BANDWIDTH,
    BlockBanded,
    LocalColumns,
)
from hypothesis import given, settings
from hypothesis import strategies as st

WINDOW = BANDWIDTH + 1


def random_matrix(seed: int, blocks: int, size: int) -> tuple[BlockBanded, FloatArray]:
    """A positive definite matrix of windows, banded and dense."""
    random = np.random.default_rng(seed)
    n = WINDOW * size
    half = random.normal(size=(blocks - BANDWIDTH, n, n + 2))
    windows = half @ np.swapaxes(half, 1, 2)
    extra = random.uniform(0.1, 1.0, (blocks, size))
    banded = BlockBanded(blocks, size)
    shaped = windows.reshape(-1, WINDOW, size, WINDOW, size)
    banded.add_windows(np.arange(blocks - BANDWIDTH), shaped)
    banded.add_diagonal(extra)
    dense = np.diag(extra.ravel())
    for k, window in enumerate(windows):
        at = slice(k * size, k * size + n)
        dense[at, at] += window
    return banded, dense


@settings(max_examples=25)
@given(st.integers(0, 2**31), st.integers(WINDOW, 12), st.integers(1, 6))
def test_product_and_solution_are_those_of_the_dense_matrix(
    seed: int, blocks: int, size: int
) -> None:
    banded, dense = random_matrix(seed, blocks, size)
    b = np.random.default_rng(seed + 1).normal(size=(blocks, size))
    assert banded.times(b).ravel() == pytest.approx(dense @ b.ravel(), rel=1e-10, abs=1e-10)
    x = banded.factor().solve(b)
    assert x.ravel() == pytest.approx(np.linalg.solve(dense, b.ravel()), rel=1e-6, abs=1e-8)


def test_windows_may_skip_blocks() -> None:
    """Double knots put the windows two blocks apart."""
    random = np.random.default_rng(5)
    first = np.array([0, 2, 3])
    half = random.normal(size=(3, 8, 9))
    windows = half @ np.swapaxes(half, 1, 2)
    banded = BlockBanded(7, 2)
    banded.add_windows(first, windows.reshape(3, 4, 2, 4, 2))
    dense = np.zeros((14, 14))
    for k, window in zip(first, windows, strict=True):
        dense[2 * k : 2 * k + 8, 2 * k : 2 * k + 8] += window
    x = random.normal(size=(7, 2))
    assert banded.times(x).ravel() == pytest.approx(dense @ x.ravel(), abs=1e-10)


def test_a_copy_overwrites_all_of_a_wider_matrix() -> None:
    banded, dense = random_matrix(2, 6, 2)
    used = BlockBanded(6, 2, BANDWIDTH + 1)
    used.lower[:] = 7.0
    x = np.random.default_rng(3).normal(size=(6, 2))
    for twin in (banded.copy(band=BANDWIDTH + 1, into=used), banded.copy(into=banded.copy())):
        assert twin.times(x).ravel() == pytest.approx(dense @ x.ravel(), abs=1e-10)
    assert not used.cleared().times(x).any()


def test_squares_of_rows_are_added_where_their_window_is() -> None:
    """Some windows have fewer rows, or none; the matrix has a wider band than they."""
    random = np.random.default_rng(9)
    first = np.array([0, 2, 3])
    rows, counts = random.normal(size=(3, 11, WINDOW * 2)), np.array([3, 0, 11])
    banded, dense = BlockBanded(7, 2, BANDWIDTH + 1), np.zeros((14, 14))
    banded.add_squares(first, rows, counts, 3.0)
    for k, J, count in zip(first, rows, counts, strict=True):
        dense[2 * k : 2 * k + 8, 2 * k : 2 * k + 8] += 3.0 * J[:count].T @ J[:count]
    x = random.normal(size=(7, 2))
    assert banded.times(x).ravel() == pytest.approx(dense @ x.ravel(), abs=1e-10)


def test_unknowns_of_very_different_size_keep_their_digits() -> None:
    """A force's and an angle's differ by 1e9."""
    banded, dense = random_matrix(4, 9, 6)
    scale = np.tile(10.0 ** np.linspace(-4.5, 4.5, 6), 9)
    for j in range(BANDWIDTH + 1):
        banded.lower[j] *= scale[:6, None] * scale[:6]
    x = np.random.default_rng(5).normal(size=54)
    found = banded.factor().solve(((dense @ x) * scale).reshape(9, 6)).ravel()
    assert found * scale == pytest.approx(x, rel=1e-9)


def test_many_right_sides_are_solved_at_once() -> None:
    banded, dense = random_matrix(4, 7, 3)
    b = np.random.default_rng(6).normal(size=(7, 3, 5))
    factor = banded.factor()
    x = factor.backward(factor.forward(b))
    assert x.reshape(21, 5) == pytest.approx(np.linalg.solve(dense, b.reshape(21, 5)))
    half = factor.forward(b).reshape(21, 5)
    assert half.T @ half == pytest.approx(b.reshape(21, 5).T @ x.reshape(21, 5))


def test_another_basis_of_every_block() -> None:
    """A reduced figure's matrix: T'AT."""
    banded, dense = random_matrix(5, 6, 4)
    T = np.random.default_rng(7).normal(size=(4, 2))
    changed = banded.congruent(T)
    whole = np.kron(np.eye(6), T)
    x = np.random.default_rng(8).normal(size=(6, 2))
    assert changed.times(x).ravel() == pytest.approx(whole.T @ dense @ whole @ x.ravel())


def test_solving_leaves_matrix_and_right_side_alone() -> None:
    banded, dense = random_matrix(2, 6, 3)
    b = np.ones((6, 3))
    factor = banded.factor()
    factor.solve(b)
    assert (b == 1.0).all()
    assert banded.times(b).ravel() == pytest.approx(dense.sum(axis=1))


def test_an_indefinite_matrix_is_refused() -> None:
    banded, _ = random_matrix(3, 6, 3)
    banded.add_diagonal(np.full((6, 3), -50.0))
    with pytest.raises(np.linalg.LinAlgError):
        banded.factor()


def test_far_off_in_time_nothing_couples() -> None:
    """Forward substitution that ends where nothing is left finds the products of the whole one."""
    banded, _ = random_matrix(7, 200, 3)
    factor = banded.factor()
    random = np.random.default_rng(9)
    parts = [LocalColumns(first, random.normal(size=(WINDOW, 3, 2))) for first in (0, 10, 150, 196)]
    found = [factor.forward_locally(part) for part in parts]
    assert max(len(each.values) for each in found) < 100
    whole = np.zeros((200, 3, 8))
    for i, part in enumerate(parts):
        whole[part.first : part.first + WINDOW, :, 2 * i : 2 * i + 2] = part.values
    half = factor.forward(whole).reshape(-1, 8)
    products = np.block([[one.products(other) for other in found] for one in found])
    assert products == pytest.approx(half.T @ half, abs=1e-7 * np.abs(half.T @ half).max())
    weights = random.normal(size=2)
    total = np.zeros((200, 3))
    found[1].add_times(weights, total)
    assert total.ravel() == pytest.approx(half[:, 2:4] @ weights, abs=1e-7)


def test_a_factor_may_take_the_matrix_s_place_and_the_next_matrix_the_factor_s() -> None:
    banded, dense = random_matrix(8, 9, 3)
    used = banded.copy()
    first = used.factor(overwrite=True)
    b = np.ones((9, 3))
    expected = np.linalg.solve(dense, b.ravel())
    assert first.solve(b).ravel() == pytest.approx(expected)
    again = banded.copy(into=used).factor(overwrite=True)
    assert again.solve(b).ravel() == pytest.approx(expected)
