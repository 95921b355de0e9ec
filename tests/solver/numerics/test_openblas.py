"""OpenBLAS against numpy."""

import numpy as np
import pytest
from hangtime.solver.numerics.block_banded import BlockBanded
from hangtime.solver.numerics.openblas import openblas


@pytest.mark.parametrize(("m", "k", "n"), [(1, 1, 1), (1, 7, 4), (5, 0, 3), (0, 2, 3), (40, 90, 7)])
def test_products_of_parts_and_transposed_matrices(m: int, k: int, n: int) -> None:
    random = np.random.default_rng(k)
    wide, tall = random.normal(size=(m, k + 2)), random.normal(size=(k, n + 3))
    for a in (wide[:, 1 : k + 1], wide[:, :k].T.copy().T):
        for b in (tall[:, 2 : n + 2], tall[:, :n].T.copy().T):
            assert openblas().product(a, b) == pytest.approx(a @ b, rel=1e-12, abs=1e-13)


def test_other_matrices_are_refused() -> None:
    square = np.ones((6, 6))
    with pytest.raises(ValueError, match="contiguous"):
        openblas().product(square[::2, ::2], square[:3])
    with pytest.raises(ValueError, match="@"):
        openblas().product(square, square[:3])


@pytest.mark.parametrize(("size", "band"), [(1, 3), (6, 4), (66, 3)])
def test_a_step_of_the_factor_is_numpys(size: int, band: int) -> None:
    random = np.random.default_rng(size)
    half = random.normal(size=((band + 1) * size, (band + 2) * size))
    whole = half @ half.T
    columns = random.normal(size=(3 + band, (band + 1) * size, size))
    columns[1] = whole[:, :size]
    found = columns.copy()
    openblas().eliminate(found, 1)
    lower = np.linalg.cholesky(whole[:size, :size])
    panel = whole[size:, :size] @ np.linalg.inv(lower).T
    assert np.tril(found[1, :size]) == pytest.approx(np.linalg.inv(lower), abs=1e-9)
    assert found[1, size:] == pytest.approx(panel, abs=1e-9)
    for j in range(band):
        rest = slice(j * size, None)
        update = panel[rest] @ panel[j * size : (j + 1) * size].T
        at = 2 + j, slice(0, (band - j) * size)
        assert (columns - found)[at] == pytest.approx(update, abs=1e-8)


def test_an_indefinite_matrix_is_refused() -> None:
    banded = BlockBanded(6, 3)
    banded.add_diagonal(np.ones((6, 3)))
    banded.lower[1, 2] = 1e3  # the diagonal stays positive
    with pytest.raises(np.linalg.LinAlgError):
        banded.factor()
