"""What `dev.py farm` makes of what it measured."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from hangtime.batch.records.result import CELLS, RESULT
from hangtime.devtools.farm import main as farm
from hangtime.devtools.farm.limits import EQUAL, OVERHEAD, SPEED_UP
from hangtime.devtools.farm.runs import results

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
