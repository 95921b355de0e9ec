"""Functions at many points at once, in threads and without."""

import casadi as ca
import numpy as np
import pytest
from hangtime.solver.numerics.batch_function import BatchFunction
from hangtime.solver.one_thread import SOLVER_THREADS


@pytest.mark.parametrize("threads", ["1", "2", "4"])
@pytest.mark.parametrize("points", [1, 63, 64, 301])
def test_every_point_has_its_value(
    points: int, threads: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SOLVER_THREADS, threads)
    x = ca.SX.sym("x", 3)
    function = BatchFunction("f", x, [ca.sin(x[:2]) * x[2], x @ x.T])
    at = np.random.default_rng(points).normal(size=(points, 3))
    sines, outer = function(at)
    np.testing.assert_allclose(sines, np.sin(at[:, :2]) * at[:, 2:], rtol=1e-15)
    np.testing.assert_allclose(outer, at[:, :, None] * at[:, None, :], rtol=1e-15)
