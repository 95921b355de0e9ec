"""Tied unknowns against the dense KKT system."""

import numpy as np
from hangtime.solver.numerics.block_banded import BlockBanded
from hangtime.solver.numerics.tied_factor import TiedFactor

BLOCKS, SIZE, TIES = 9, 4, 6


def system() -> tuple[BlockBanded, np.ndarray, np.ndarray]:
    """A banded matrix, the same dense, and ties (R, K n) of its first blocks to its last."""
    rng = np.random.default_rng(3)
    band = BlockBanded(BLOCKS, SIZE)
    for first in range(BLOCKS - 3):
        root = rng.normal(size=(4 * SIZE, 4 * SIZE))
        band.add_windows(np.array([first]), (root @ root.T).reshape(1, 4, SIZE, 4, SIZE))
    unit = np.eye(BLOCKS * SIZE).reshape(-1, BLOCKS, SIZE)
    dense = np.stack([band.times(column).ravel() for column in unit], axis=1)
    ties = np.zeros((TIES, BLOCKS, SIZE))
    ties[:, :2] = rng.normal(size=(TIES, 2, SIZE))
    ties[:, -2:] = rng.normal(size=(TIES, 2, SIZE))
    return band, dense, ties.reshape(TIES, -1)


def tied(band: BlockBanded, ties: np.ndarray) -> TiedFactor:
    return TiedFactor.of(band.factor(), ties.T.reshape(BLOCKS, SIZE, TIES))


def test_solve_is_the_least_under_ties() -> None:
    band, dense, ties = system()
    b = np.random.default_rng(4).normal(size=(BLOCKS, SIZE))
    kkt = np.block([[dense, ties.T], [ties, np.zeros((TIES, TIES))]])
    expected = np.linalg.solve(kkt, np.concatenate([b.ravel(), np.zeros(TIES)]))[: b.size]
    found = tied(band, ties).solve(b)
    np.testing.assert_allclose(found.ravel(), expected, atol=1e-9)
    np.testing.assert_allclose(ties @ found.ravel(), 0.0, atol=1e-12)


def test_closing_is_the_least_change() -> None:
    band, dense, ties = system()
    off = np.random.default_rng(5).normal(size=TIES)
    kkt = np.block([[dense, ties.T], [ties, np.zeros((TIES, TIES))]])
    expected = np.linalg.solve(kkt, np.concatenate([np.zeros(len(dense)), -off]))[: len(dense)]
    found = tied(band, ties).closing(off)
    np.testing.assert_allclose(found.ravel(), expected, atol=1e-9)
