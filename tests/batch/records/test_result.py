"""Results of cells that several processes bring at once."""

import errno
from dataclasses import replace
from pathlib import Path
from threading import Event, Thread

import pytest
from hangtime.batch.records.faults import FolderGone
from hangtime.batch.records.locks import held
from hangtime.batch.records.result import (
    CELLS,
    PLACING,
    RESULT,
    CellResult,
    State,
    cell_folder,
    lasting_result,
    read_result,
    spoilt_files,
    written_cell,
)

CELL = "00001-ab"


def put(folder: Path, state: State, sentence: str = "") -> None:
    with written_cell(folder, CELL) as aside:
        result = CellResult(CELL, state, "a.bvh", "r.toml", "1", sentence)
        (aside / RESULT).write_text(result.as_json())


def told(folder: Path) -> str:
    result = read_result(folder, CELL)
    assert result is not None
    return f"{result.state.value} {result.sentence}".strip()


def test_a_failure_makes_room_for_what_comes_and_a_result_stays(tmp_path: Path) -> None:
    put(tmp_path, State.FAILED)
    put(tmp_path, State.FAILED, "again")
    assert told(tmp_path) == "failed again"
    put(tmp_path, State.DONE)
    put(tmp_path, State.FAILED)
    put(tmp_path, State.DONE, "later")
    assert told(tmp_path) == "done"
    assert [path.name for path in (tmp_path / CELLS).iterdir()] == [CELL]


def test_a_folder_without_a_result_makes_room(tmp_path: Path) -> None:
    (cell_folder(tmp_path, CELL) / "rest").mkdir(parents=True)
    put(tmp_path, State.DONE)
    assert told(tmp_path) == "done"


def test_of_twins_that_end_at_once_none_removes_what_the_other_has_put_there(
    tmp_path: Path,
) -> None:
    """Failures and results in turn from eight sides: once there is a result it never goes."""
    over, seen = Event(), list[str]()

    def look() -> None:
        while not over.is_set():
            result = read_result(tmp_path, CELL)
            seen.append("" if result is None else result.state.value)

    def bring(side: int) -> None:
        for turn in range(12):
            put(tmp_path, State.DONE if turn >= 4 + side % 3 else State.FAILED)

    watcher, sides = Thread(target=look), [Thread(target=bring, args=(i,)) for i in range(8)]
    for thread in (watcher, *sides):
        thread.start()
    for thread in sides:
        thread.join()
    over.set()
    watcher.join()
    seen.append(told(tmp_path))
    assert set(seen[seen.index("done") :]) == {"done"}
    assert [path.name for path in (tmp_path / CELLS).iterdir()] == [CELL]


def test_a_cell_waits_for_its_turn(tmp_path: Path) -> None:
    with held(tmp_path / PLACING):
        thread = Thread(target=put, args=(tmp_path, State.DONE))
        thread.start()
        thread.join(0.3)
        assert read_result(tmp_path, CELL) is None
    thread.join()
    assert told(tmp_path) == "done"


def test_a_result_that_is_replaced_on_a_server_meanwhile_is_looked_at_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(tmp_path, State.DONE)
    read, stale = Path.read_text, [OSError(errno.ESTALE, "Stale file handle")]

    def once(path: Path, encoding: str | None = None) -> str:
        if stale:
            raise stale.pop()
        return read(path, encoding)

    monkeypatch.setattr(Path, "read_text", once)
    assert told(tmp_path) == "done"
    stale.extend(OSError(errno.ESTALE, "Stale file handle") for _ in range(9))
    with pytest.raises(FolderGone, match="Stale file handle"):
        told(tmp_path)


def test_a_result_without_one_of_its_files_makes_room(tmp_path: Path) -> None:
    for sizes in ({"motion.bvh": 6}, {}):  # older results do not tell them
        for spoil in (Path.unlink, lambda path: path.write_text("")):
            with written_cell(tmp_path, CELL) as aside:
                (aside / "motion.bvh").write_text("whole\n")
                result = CellResult(CELL, State.DONE, "", "", "", files=("motion.bvh",))
                (aside / RESULT).write_text(replace(result, sizes=sizes).as_json())
            assert lasting_result(tmp_path, CELL) is not None
            spoil(cell_folder(tmp_path, CELL) / "motion.bvh")
            assert lasting_result(tmp_path, CELL) is None


def test_a_file_of_another_size_makes_room_and_one_that_was_written_empty_does_not(
    tmp_path: Path,
) -> None:
    with written_cell(tmp_path, CELL) as aside:
        for name in ("log.txt", "motion.bvh"):
            (aside / name).touch()
        sizes = {"log.txt": 0, "motion.bvh": 6}
        result = CellResult(CELL, State.DONE, "", "", "", files=tuple(sizes), sizes=sizes)
        (aside / RESULT).write_text(result.as_json())
    assert spoilt_files(tmp_path, CELL, result) == ("motion.bvh",)


def test_a_folder_that_is_read_only_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> str:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr("tempfile.mkdtemp", refuse)
    with pytest.raises(FolderGone, match=r"Read-only file system.*same command again"):
        put(tmp_path, State.DONE)
