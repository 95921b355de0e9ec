"""Files of a job are delivered together, or not at all."""

import os
import shutil
import subprocess
import sys
from errno import EACCES, EDEADLK, EIO
from pathlib import Path
from types import SimpleNamespace
from typing import IO, Any

import pytest
from hangtime.operators.files import lock as locking
from hangtime.operators.files.lock import LOCK
from hangtime.operators.files.outbox import OWN_LOCK, Outbox, write_new
from hangtime.operators.words.messages import sentence
from hangtime.solver.data.faults import NotWrittenOver, OutputFolderBusy, OutputNotWritable


def kept_open(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Nobody can remove the file of this name, as on Windows while a program shows it."""
    unlink = Path.unlink

    def barred(path: Path, missing_ok: bool = False) -> None:
        if path.name == name:
            raise PermissionError(EACCES, "it is open elsewhere")
        unlink(path, missing_ok)

    monkeypatch.setattr(Path, "unlink", barred)


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputNotWritable), Outbox(tmp_path / "file" / "out"):
        pass


@pytest.mark.skipif(sys.platform == "win32", reason="Windows tells that there is no such folder")
def test_a_folder_of_too_long_a_name_is_told_so(tmp_path: Path) -> None:
    with pytest.raises(OutputNotWritable, match="too long"), Outbox(tmp_path / ("x" * 300) / "out"):
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
        outbox.claim(["sheet.png", "film.mp4"])
    assert [path.name for path in tmp_path.iterdir()] == ["unfinished-symphony.txt"]


def test_a_folder_into_which_another_run_writes_is_refused_and_its_files_stay(
    tmp_path: Path,
) -> None:
    folder = tmp_path / "out"
    with Outbox(folder) as first:
        first.claim(["report.txt"])
        first.write_text("report.txt", "of the first")
        with pytest.raises(OutputFolderBusy), Outbox(folder) as second:
            second.claim(["report.txt"])
        first.deliver()
    assert [path.name for path in folder.iterdir()] == ["report.txt"]
    assert (folder / "report.txt").read_text() == "of the first"


def test_the_lock_of_a_run_that_was_killed_holds_nobody_up(tmp_path: Path) -> None:
    lock = Path(locking.__file__)
    run = f"import runpy, os, pathlib; at = pathlib.Path({str(tmp_path / OWN_LOCK)!r})\n"
    run += f"kept = runpy.run_path({str(lock)!r})['take'](at, wait=False)\nos._exit(9)"
    assert subprocess.run([sys.executable, "-c", run]).returncode == 9
    assert (tmp_path / OWN_LOCK).exists()
    with Outbox(tmp_path) as outbox:
        outbox.claim([])
    assert not list(tmp_path.iterdir())


def claim(folder: Path) -> None:
    with Outbox(folder) as outbox:
        outbox.claim([])


def test_a_batch_that_runs_in_the_folder_is_seen_and_keeps_its_lock(tmp_path: Path) -> None:
    with locking.take(tmp_path / LOCK, wait=False):
        with pytest.raises(OutputFolderBusy):
            claim(tmp_path)
        assert [path.name for path in tmp_path.iterdir()] == [LOCK]
    claim(tmp_path)  # a batch leaves it
    assert [path.name for path in tmp_path.iterdir()] == [LOCK]


@pytest.mark.parametrize("name", [LOCK, OWN_LOCK])
def test_an_artists_file_with_a_locks_name_stays(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("the artist's")
    claim(tmp_path)
    assert (tmp_path / name).read_text() == "the artist's"


@pytest.mark.parametrize("number", sorted(locking.WITHOUT))
def test_where_the_file_system_has_no_locks_one_goes_on_without(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lockless(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(locking, "_lock", lockless)
    claim(tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_lock_that_another_user_has_left_holds_nobody_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / OWN_LOCK).touch()
    opened = Path.open

    def barred(path: Path, mode: str = "r", **more: Any) -> IO[Any]:
        if mode == "ab" and path.exists():
            raise PermissionError(EACCES, os.strerror(EACCES))
        return opened(path, mode, **more)

    monkeypatch.setattr(Path, "open", barred)
    claim(tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_lock_whose_file_is_never_known_again_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on file systems that number their files anew at each look."""
    monkeypatch.setattr(locking, "_is_at", lambda *_: False)
    claim(tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("number", "told"), [(EACCES, BlockingIOError), (EDEADLK, BlockingIOError), (EIO, OSError)]
)
def test_on_windows_only_what_another_holds_is_busy(
    number: int, told: type[OSError], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def locked(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    windows = SimpleNamespace(locking=locked, LK_LOCK=1, LK_NBLCK=2)
    monkeypatch.setitem(sys.modules, "msvcrt", windows)
    monkeypatch.setattr(locking, "sys", SimpleNamespace(platform="win32"))
    with pytest.raises(OSError, match=os.strerror(number)) as raised:
        locking.take(tmp_path / LOCK, wait=False)
    assert raised.type is told


def end_halfway(folder: Path) -> None:
    with Outbox(folder) as outbox:
        outbox.claim([])
        outbox.write_text("sheet.png", "half of it")
        outbox.write_text("report.txt", "half of it")
        raise ValueError("why it ended")


def test_an_unfinished_file_that_cannot_be_removed_hides_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept_open(monkeypatch, "unfinished-sheet.png")
    with pytest.raises(ValueError, match="why it ended"):
        end_halfway(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["unfinished-sheet.png"]


def end_after_delivery(folder: Path, *names: str) -> None:
    with Outbox(folder) as outbox:
        for name in names:
            outbox.write_text(name, "all of it")
        outbox.deliver()
        raise MemoryError


def test_what_ends_a_run_after_its_delivery_tells_what_is_written(tmp_path: Path) -> None:
    with pytest.raises(MemoryError) as raised:
        end_after_delivery(tmp_path, "a.txt", "b.txt")
    assert raised.value.__notes__ == [
        f"written by then: {tmp_path / 'a.txt'}, {tmp_path / 'b.txt'}"
    ]
    with pytest.raises(MemoryError) as raised:
        end_after_delivery(tmp_path)
    assert not hasattr(raised.value, "__notes__")


def test_a_new_file_is_never_written_over_an_old_one(tmp_path: Path) -> None:
    recipe = tmp_path / "my.toml"
    write_new(recipe, "mine")
    with pytest.raises(NotWrittenOver) as caught:
        write_new(recipe, "other")
    assert recipe.read_text(encoding="utf-8") == "mine"
    assert sentence(caught.value).startswith(f"“{recipe}” exists already")
    with pytest.raises(OutputNotWritable):
        write_new(tmp_path / "nowhere" / "my.toml", "mine")
