"""When a constraint holds: the same for the overlay, the plots and the solver."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.traces_store import keep
from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.plots.charts import plotted
from hangtime.bridge.rows.times import Clip, when_of
from hangtime.solver.analysis.timeline import Timeline, active_interval
from hangtime.solver.data.contacts import Phase, PhaseKind
from hangtime.tests.blender.helpers.overlays import adapted, constrain, seen, traced
from mathutils import Matrix

pytestmark = pytest.mark.usefixtures("_enabled")

FLIGHT = (12.0, 18.0)  # frames, of helpers/overlays
APEX = 14.0  # not the flight's middle
RATE = 24.0  # Hz


@pytest.mark.parametrize(
    ("instant", "frame"), [("START", 12.0), ("MIDDLE", 15.0), ("APEX", APEX), ("END", 18.0)]
)
def test_overlay_plot_and_solver_agree(instant: str, frame: float) -> None:
    armature = adapted(Matrix())
    for owner, other in ((armature, False), (armature.hangtime.adapted, True)):
        traces = traced(armature, adapted=other)
        traces.com[:, 2] = 1.0 - 0.01 * (traces.frames - APEX) ** 2
        keep(owner, traces, armature.matrix_world)
    row = constrain(
        armature,
        KINDS["FORCE"],
        span="PHASE",
        phase="flight 1",
        instant=instant,
    )
    armature.hangtime.use_range = True
    armature.hangtime.first_frame, armature.hangtime.last_frame = 1, 24
    assert seen(armature).span(row) == (frame, frame)
    shown = plotted(armature, bpy.context.scene.hangtime.view)
    assert shown is not None
    (cap,) = shown.content.force_caps
    assert 0.5 * (cap.start + cap.end) == frame
    assert solved(armature, row, traces) == pytest.approx(frame)


def solved(armature: bpy.types.Object, row: bpy.types.PropertyGroup, traces: object) -> float:
    """The frame at which the solver lets a row hold, in a recording that is not retimed."""
    times = (traces.frames - 1.0) / RATE
    line = Timeline(times[[0, -1]], times[[0, -1]], (), 1.0, RATE)
    phase = Phase(PhaseKind.FLIGHT, 1, *((f - 1.0) / RATE for f in FLIGHT))
    when = when_of(row, Clip.of(armature.hangtime))
    heights = np.stack([times, traces.com[:, 2]], axis=1)
    first, last = active_interval(row.name, when, line, (phase,), heights)
    assert first == last
    return 1.0 + RATE * first
