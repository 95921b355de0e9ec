"""What a batch tells of its progress where nothing can be written in place."""

from collections import Counter
from io import StringIO

from hangtime.batch.records.manifest import CellPlan
from hangtime.batch.records.result import CellResult, State
from hangtime.batch.running.progress import SILENCE_S, STILL_S, Progress

PLAN = CellPlan("00001-ab", "hop.bvh", "", "further.toml", "")
DONE = CellResult(PLAN.cell, State.DONE, "hop.bvh", "further.toml", "0.1.0")


def test_a_log_has_a_line_now_and_then_and_fewer_while_no_cell_ends() -> None:
    out, now = StringIO(), [0.0]
    progress = Progress(out, 3, Counter(), clock=lambda: now[0])
    while now[0] < 2 * STILL_S:  # a cell of two minutes
        now[0] += 0.5
        progress.tick()
    assert out.getvalue() == "0 of 3 cells\n" * 2
    now[0] += SILENCE_S
    progress.ended(PLAN, DONE)
    assert out.getvalue().splitlines()[2:] == ["1 of 3 cells; 130.0 s each, 4 min left"]
    progress.ended(PLAN, DONE)
    progress.ended(PLAN, DONE)
    assert out.getvalue().splitlines()[3:] == ["3 of 3 cells; 43.3 s each"]
