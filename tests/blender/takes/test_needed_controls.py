"""Which controls a motion needs, whatever their units."""

import numpy as np
import pytest
from hangtime.bridge.controls.needed import Effects, needed


@pytest.mark.parametrize("unit", [1.0, 1e-12])
def test_as_many_dofs_are_kept_as_the_bodies_have(unit: float) -> None:
    """Of a tiny armature a metre of a control moves bodies by 1e12 m."""
    random = np.random.default_rng(0)
    wanted = np.linalg.qr(random.normal(size=(12, 9)))[0].T
    done = random.normal(size=(40, 9)) @ wanted / unit
    kept = needed([[dof] for dof in range(40)], [Effects(done, wanted)])
    assert len(kept) == 9
    assert np.linalg.matrix_rank(done[kept]) == 9
