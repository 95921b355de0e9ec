"""What a flight's summary says of the crouch before it."""

from dataclasses import replace

import pytest
from hangtime.solver.results.flight_summary import jumps
from hangtime.tests.helpers.fitted_hop import fitted_hop


def test_a_crouch_on_something_higher_is_as_deep() -> None:
    fit = fitted_hop()
    x = fit.motion.x.copy()
    x[:, 2] += 0.25  # m; all of the body goes up
    (jump,) = jumps(fit, replace(fit.motion, x=x), fit.schedule)
    assert jump.crouch_deeper_cm == pytest.approx(0.0, abs=1e-6)
    assert jump.apex_higher_cm == pytest.approx(25.0)
