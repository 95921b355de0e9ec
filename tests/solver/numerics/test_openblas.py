"""CasADi's OpenBLAS against numpy."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.numerics import block_banded, openblas
from hangtime.solver.numerics.block_banded import BlockBanded

BLAS = openblas.bundled()
pytestmark = pytest.mark.skipif(BLAS is None, reason="this CasADi was built without OpenBLAS")


@pytest.mark.parametrize(("m", "k", "n"), [(1, 1, 1), (1, 7, 4), (5, 0, 3), (0, 2, 3), (40, 90, 7)])
def test_products_of_parts_and_transposed_matrices(m: int, k: int, n: int) -> None:
    assert BLAS is not None
    random = np.random.default_rng(k)
    wide, tall = random.normal(size=(m, k + 2)), random.normal(size=(k, n + 3))
    for a in (wide[:, 1 : k + 1], wide[:, :k].T.copy().T):
        for b in (tall[:, 2 : n + 2], tall[:, :n].T.copy().T):
            assert BLAS.product(a, b) == pytest.approx(a @ b, rel=1e-12, abs=1e-13)


def test_other_matrices_are_refused() -> None:
    assert BLAS is not None
    square = np.ones((6, 6))
    with pytest.raises(ValueError, match="contiguous"):
        BLAS.product(square[::2, ::2], square[:3])
    with pytest.raises(ValueError, match="@"):
        BLAS.product(square, square[:3])


def matrix(blocks: int, size: int, band: int) -> BlockBanded:
    """A positive definite one, with unknowns of very different size."""
    random = np.random.default_rng(size)
    banded, wide = BlockBanded(blocks, size, band), (band + 1) * size
    scale = np.tile(10.0 ** random.uniform(-4, 4, size), band + 1)
    rows = random.normal(size=(blocks - band, wide // 2, wide)) * scale
    banded.add_squares(np.arange(blocks - band), rows)
    banded.add_diagonal(np.tile(scale[:size] ** 2, (blocks, 1)))
    return banded


def factor(monkeypatch: pytest.MonkeyPatch, banded: BlockBanded, *, by_blas: bool) -> FloatArray:
    monkeypatch.setattr(block_banded, "openblas", lambda: BLAS if by_blas else None)
    return banded.factor().columns


@pytest.mark.parametrize(("size", "band"), [(1, 3), (6, 4), (66, 3)])
def test_both_find_the_same_factor(monkeypatch: pytest.MonkeyPatch, size: int, band: int) -> None:
    banded = matrix(9, size, band)
    one, other = (factor(monkeypatch, banded, by_blas=each) for each in (False, True))
    for part in (np.s_[:, :size], np.s_[:, size:]):  # inverses of triangles, blocks below them
        assert np.abs(one[part] - other[part]).max() <= 1e-12 * np.abs(one[part]).max()


@pytest.mark.parametrize("by_blas", [False, True])
def test_both_refuse_an_indefinite_matrix(monkeypatch: pytest.MonkeyPatch, by_blas: bool) -> None:
    banded = matrix(6, 3, 3)
    banded.lower[1, 2] *= 1e3  # the diagonal stays positive
    with pytest.raises(np.linalg.LinAlgError):
        factor(monkeypatch, banded, by_blas=by_blas)


@pytest.mark.parametrize(
    ("config", "serves"),
    [
        ({"CONFIG": {"Build Dependencies": {"blas": {"name": "scipy-openblas"}}}}, False),
        ({"CONFIG": {"Build Dependencies": {"blas": {"name": "blas"}}}}, True),
        ({"CONFIG": {"Build Dependencies": {}}}, True),
        ({"blas_ilp64_opt_info": {"libraries": ["openblas64_", "openblas64_"]}}, False),
        ({"blas_opt_info": {}}, True),
    ],
)
def test_numpy_computes_where_it_has_a_tuned_blas_itself(
    monkeypatch: pytest.MonkeyPatch, config: dict[str, object], serves: bool
) -> None:
    monkeypatch.setitem(sys.modules, "numpy.__config__", SimpleNamespace(**config))
    assert (openblas.openblas.__wrapped__() is not None) is serves
    monkeypatch.setattr(openblas, "FILES", ())
    assert openblas.openblas.__wrapped__() is None


def test_a_library_that_does_not_load_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(openblas, "FILES", ("__init__.py",))
    assert openblas.bundled() is None
