"""Dense Cholesky factors beside numpy's own solutions."""

import numpy as np
import pytest
from hangtime.solver.numerics.dense_cholesky import DenseCholesky


@pytest.mark.parametrize("size", [0, 1, 7, 130])
def test_solution_and_inverse(size: int) -> None:
    root = np.random.default_rng(0).normal(size=(size, size))
    matrix, right = root @ root.T + np.eye(size), np.arange(float(size))
    before = matrix.copy()
    factor = DenseCholesky.of(matrix)
    assert factor.solve(right) == pytest.approx(np.linalg.solve(matrix, right))
    assert factor.inverse() == pytest.approx(np.linalg.inv(matrix))
    assert (matrix == before).all()
    assert (right == np.arange(size)).all()


def test_what_is_not_positive_definite_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        DenseCholesky.of(np.diag([1.0, -1.0, 1.0]))
