"""Files of a job are delivered together, or not at all."""

import shutil
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


def write_where_nothing_is(folder: Path) -> None:
    with Outbox(folder) as outbox:
        outbox.write_text("report.txt", "new")
        shutil.rmtree(folder.parent)
        outbox.deliver()


def write_below_a_file(folder: Path) -> None:
    with Outbox(folder) as outbox:
        shutil.rmtree(folder)
        folder.write_text("a file of its name")
        outbox.write_text("report.txt", "new")


def write_over_a_folder(folder: Path) -> None:
    with Outbox(folder) as outbox:
        outbox.write_text("report.json", "new")
        outbox.write_text("report.txt", "new")
        outbox.deliver()


def test_a_folder_that_goes_away_meanwhile(tmp_path: Path) -> None:
    folder = tmp_path / "made" / "out"
    for write in (write_where_nothing_is, write_below_a_file):
        with pytest.raises(OutputNotWritable):
            write(folder)
    assert folder.read_text() == "a file of its name"


def test_nothing_is_delivered_where_a_folder_has_a_files_name(tmp_path: Path) -> None:
    (tmp_path / "report.txt").mkdir()
    (tmp_path / "report.json").write_text("old")
    with pytest.raises(OutputNotWritable):
        write_over_a_folder(tmp_path)
    assert (tmp_path / "report.json").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 2


def test_what_a_killed_run_has_left_is_removed_and_nothing_else(tmp_path: Path) -> None:
    killed = Outbox(tmp_path)
    killed.write_text("sheet.png", "half of it")
    (tmp_path / "unfinished-symphony.txt").write_text("the artist's")
    with Outbox(tmp_path) as outbox:
        outbox.sweep(["sheet.png", "film.mp4"])
    assert [path.name for path in tmp_path.iterdir()] == ["unfinished-symphony.txt"]
