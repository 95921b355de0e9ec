"""What `dev.py farm` makes of what it measured."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hangtime.batch.records.result import CELLS, RESULT, CellResult, State
from hangtime.devtools.farm import main as farm
from hangtime.devtools.farm.limits import EQUAL, OVERHEAD, SPEED_UP
from hangtime.devtools.farm.plans import plan_hops
from hangtime.devtools.farm.runs import at_work, cell_of, results

ALIKE = EQUAL + "2 workers"


@pytest.mark.parametrize(
    ("differing", "tell", "code"), [(0.0, False, 1), (0.0, True, 0), (1.0, True, 1)]
)
def test_of_a_slow_machine_times_may_be_told_alone_but_never_cells(
    differing: float, tell: bool, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def measured(scratch: Path, *, quick: bool) -> Iterator[tuple[str, float]]:  # noqa: ARG001
        yield from ((ALIKE, differing), (SPEED_UP, 0.9), (OVERHEAD, 1000.0))

    monkeypatch.setattr(farm, "measured", measured)
    assert farm.main(["--out", str(tmp_path), *["--tell"][: int(tell)]]) == code


def test_a_result_that_a_killed_worker_had_aside_is_none_yet(tmp_path: Path) -> None:
    for name in ("1-a", ".2-b.host.7.x"):
        (tmp_path / CELLS / name).mkdir(parents=True)
        (tmp_path / CELLS / name / RESULT).touch()
    assert [path.parent.name for path in results(tmp_path)] == ["1-a"]
    assert [cell_of(aside) for aside in at_work(tmp_path)] == ["2-b"]


def test_what_a_cell_takes_beside_its_solve_is_by_the_walls_clock(tmp_path: Path) -> None:
    """Handing over, and the way onto the disk, are no part of what the cell itself tells."""
    manifest = plan_hops(tmp_path / "one", 3)
    for k, plan in enumerate(manifest.cells):
        folder = tmp_path / "one" / CELLS / plan.cell
        folder.mkdir(parents=True)
        seconds = {"fit": 2.0 * (k == 0), "solve": 0.5, "report": 0.0, "total": 0.5}
        result = CellResult(plan.cell, State.DONE, "", "", "", seconds=seconds)
        (folder / RESULT).write_text(result.as_json())
        os.utime(folder / RESULT, (1000.0 + 0.7 * k, 1000.0 + 0.7 * k))
    (tmp_path / "one" / "fits" / "a").mkdir(parents=True)
    found = dict(farm.told_times(tmp_path / "one", manifest))
    assert found[OVERHEAD] == pytest.approx(200.0, abs=1.0)
    assert found["seconds a cell, one core"] == pytest.approx(0.7, abs=1e-3)
