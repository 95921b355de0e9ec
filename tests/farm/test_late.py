"""Results that are seen late."""

import shutil
from pathlib import Path
from threading import Timer

import pytest
from hangtime.batch.cluster.late import await_results
from hangtime.batch.records.faults import FolderGone
from hangtime.batch.records.result import CELLS, RESULT, CellResult, State, written_cell


def put(folder: Path) -> None:
    with written_cell(folder, "1-a") as aside:
        result = CellResult("1-a", State.DONE, "a.bvh", "r.toml", "1")
        (aside / RESULT).write_text(result.as_json())


def test_results_that_are_there_are_not_waited_for(tmp_path: Path) -> None:
    put(tmp_path)
    told: list[str] = []
    await_results(tmp_path, ["1-a"], told.append)
    assert told == []


def test_results_that_come_late_are_waited_for_with_a_sentence(tmp_path: Path) -> None:
    put(tmp_path)
    hidden = tmp_path / "elsewhere"
    (tmp_path / CELLS / "1-a").rename(hidden)
    Timer(0.2, shutil.move, [hidden, tmp_path / CELLS / "1-a"]).start()
    told: list[str] = []
    await_results(tmp_path, ["1-a"], told.append)
    assert len(told) == 1
    assert "1 results are not yet to be seen" in told[0]


def test_results_that_never_come_are_a_fault(tmp_path: Path) -> None:
    with pytest.raises(FolderGone, match=r"such as 1-a.*same command again"):
        await_results(tmp_path, ["1-a"], lambda _: None, longest=0.0)
