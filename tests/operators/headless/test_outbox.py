"""Files of a job are delivered together, or not at all."""

from pathlib import Path

import pytest
from hangtime.operators.headless.outbox import Outbox
from hangtime.solver.data.faults import OutputNotWritable


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputNotWritable), Outbox(tmp_path / "file" / "out"):
        pass


def test_a_failing_run_leaves_the_folder_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    with Outbox(tmp_path) as outbox:
        outbox.write_text("a.txt", "new")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


def test_delivered_files_replace_the_old_ones(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    with Outbox(tmp_path) as outbox:
        outbox.write_text("a.txt", "new")
        assert (tmp_path / "a.txt").read_text() == "old"
        assert outbox.deliver() == [tmp_path / "a.txt"]
    assert (tmp_path / "a.txt").read_text() == "new"
    assert len(list(tmp_path.iterdir())) == 1
