"""Steps on one factor: sane where rounding is as large as what a change costs."""

import numpy as np
import pytest
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.optimisation.kkt_step import PENALTY, ROW_SCALES, LinearisedProblem
from hangtime.solver.optimisation.span_rows import SpanRows
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.rows import by_kind
from hangtime.tests.helpers.fitted_hop import fitted_hop

FURTHER = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.2, 0.0, 0.0)),)).keeping_times()


def test_where_rounding_spoils_the_factor_no_joint_whirls() -> None:
    """A ten-thousandth of the metric is a rounding beside what the rows put into the matrix."""
    setup = set_up(fitted_hop(), FURTHER)
    t, light = setup.start.transcription, setup.metric.copy()
    light.lower *= 1e-4
    rows = t.rows(setup.start.x, setup.target_places)
    equal, system = np.flatnonzero(rows.equal), light.copy()
    scale = by_kind(rows.kind[equal], ROW_SCALES)
    equalities = SpanRows.of(rows, equal, scale, t.basis.first_coefficient, None)
    equalities.add_normal(system, PENALTY)
    with pytest.raises(np.linalg.LinAlgError):
        system.factor()
    linearised = LinearisedProblem(t, rows, light)
    step = linearised.step(rows.value)
    assert linearised.violation(rows.value + step.change) < 1.0
    assert np.abs(step.d[:, t.layout.angles]).max() < 1.0  # rad; with too large a ridge 86
