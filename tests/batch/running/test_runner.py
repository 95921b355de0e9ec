"""The local runner, with cells that are cheap: order, deaths, memory, kills and resuming."""

import csv
import errno
import os
import random
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

import pytest
from hangtime.batch import commands
from hangtime.batch.records.faults import BatchFault, FolderBusy, FolderGone
from hangtime.batch.records.locks import batch_lock
from hangtime.batch.records.manifest import read_manifest
from hangtime.batch.records.result import CELLS, State, read_result
from hangtime.batch.running.memory import MemoryWatch
from hangtime.batch.running.progress import Progress
from hangtime.batch.running.runner import LocalRun
from hangtime.tests.helpers import fake_batches
from hangtime.tests.helpers.fake_batches import lines, planned, run


def states(folder: Path) -> dict[str, State]:
    """Of the clips, by their names."""
    cells = read_manifest(folder).cells
    results = {Path(c.clip).name: read_result(folder, c.cell) for c in cells}
    return {name: State.PLANNED if r is None else r.state for name, r in results.items()}


def test_every_cell_gets_a_result_and_the_same_command_solves_none_again(tmp_path: Path) -> None:
    texts = {f"clip {i} ü.bvh": f"sleep 0.0{i}" for i in range(6)} | {"impossible.bvh": "fault"}
    planned(tmp_path, texts)
    folder = tmp_path / "out"
    told = run(folder)
    assert Counter(states(folder).values()) == {State.DONE: 6, State.NO_SOLUTION: 1}
    assert "no solution: 00007 impossible.bvh + recipe.toml: No motion was found" in told
    assert "7 of 7 cells" in told
    assert len(set(lines(folder, "begin"))) == len(lines(folder, "begin")) == 7
    run(folder)
    assert len(lines(folder, "begin")) == 7
    assert not [p.name for p in (folder / CELLS).iterdir() if p.name.startswith(".")]


def test_temporary_files_of_workers_are_gone_with_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Workers are killed in the end, and cannot remove them."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    planned(tmp_path, {"a.bvh": "temporary"})
    run(tmp_path / "out")
    (used,) = lines(tmp_path / "out", "temporary")
    assert Path(used).is_relative_to(temporary)
    assert not list(temporary.iterdir())


@pytest.mark.slow
def test_a_cell_whose_output_is_emptied_is_told_and_solved_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(commands, "worker_command", lambda **_: fake_batches.command())
    folder, recipe = tmp_path / "out", tmp_path / "recipe.toml"
    planned(tmp_path, {"a.bvh": "sleep 0", "b.bvh": "sleep 0.01"})
    command = [str(tmp_path), "--recipes", str(recipe), "--out", str(folder), "--jobs", "1"]
    assert commands.run(command) == 0
    cell = read_manifest(folder).cells[1].cell
    answer = folder / CELLS / cell / "answer.txt"
    before = answer.read_text()
    answer.write_text("")
    capsys.readouterr()
    assert commands.run(command) == 0
    said = f"1 cell whose files are missing or changed is solved again: {cell} (answer.txt)."
    assert said in capsys.readouterr().out
    assert answer.read_text() == before
    assert lines(folder, "begin")[2:] == [cell]


@pytest.mark.slow
def test_the_end_tells_how_many_the_certificate_has_nothing_new_against(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(commands, "worker_command", lambda **_: fake_batches.command())
    planned(tmp_path, {"a.bvh": "worse", "b.bvh": "sleep 0", "c.bvh": "fault"})
    words = ["--recipes", str(tmp_path / "recipe.toml"), "--out", str(tmp_path / "out")]
    assert commands.run([str(tmp_path), *words, "--jobs", "1"]) == 3
    told = capsys.readouterr().out
    assert "In 1 of the 2 done no line of the certificate fails, or only as in the" in told
    assert commands.run([str(tmp_path), *words, "--jobs", "1"]) == 3
    again = capsys.readouterr().out
    assert again.startswith("3 cells: 3 clips, 1 recipe; before: 2 done, 1 no solution.")
    table = (tmp_path / "out" / "table.csv").read_text(encoding="utf-8-sig")
    rows = {row["clip"]: row for row in csv.DictReader(table.splitlines())}
    worse = {clip: row["certificate_worse_than_recorded"] for clip, row in rows.items()}
    assert worse == {"a.bvh": "1.0", "b.bvh": "0.0", "c.bvh": ""}


@pytest.mark.slow
def test_cells_of_clips_with_the_same_name_are_told_apart_and_alike_ones_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(commands, "worker_command", lambda **_: fake_batches.command())
    for day in ("mon", "tue"):
        (tmp_path / day).mkdir()
    recipe = '[[pin]]\nname = "L"\nphase = "ground 2"\nforward = [0.1, 0.2]\n'
    planned(tmp_path, {"mon/walk.bvh": "crash", "tue/walk.bvh": "fault"}, recipe)
    words = ["--recipes", str(tmp_path / "recipe.toml"), "--out", str(tmp_path / "out")]
    assert commands.run([str(tmp_path), *words, "--jobs", "1"]) == 1
    told = capsys.readouterr().out
    assert "failed: 00002 mon/walk.bvh + recipe.toml (pin.L.forward = 0.2): A fault" in told
    closing = told.partition("index.html")[2]
    assert "\n  failed: mon/walk.bvh (2 cells, such as 00001): A fault of Hangtime's" in closing
    assert "\n  no solution: tue/walk.bvh (2 cells, such as 00003): No motion" in closing
    assert len(closing.strip().splitlines()) == 3
    results = [read_result(tmp_path / "out", c.cell) for c in read_manifest(tmp_path / "out").cells]
    assert {r.clip for r in results if r is not None} == {"mon/walk.bvh", "tue/walk.bvh"}


@pytest.mark.slow
def test_a_cell_whose_worker_dies_is_done_again_and_one_that_kills_them_is_told(
    tmp_path: Path,
) -> None:
    planned(tmp_path, {"a.bvh": "dies once", "b.bvh": "dies", "c.bvh": "crash", "d.bvh": "sleep 0"})
    folder = tmp_path / "out"
    told = run(folder)
    expected = {
        "a.bvh": State.DONE,
        "b.bvh": State.FAILED,
        "c.bvh": State.FAILED,
        "d.bvh": State.DONE,
    }
    assert states(folder) == expected
    assert "A worker ended with code 9" in told
    by_clip = {Path(c.clip).name: c.cell for c in read_manifest(folder).cells}
    assert Counter(lines(folder, "begin"))[by_clip["b.bvh"]] == 2
    died = read_result(folder, by_clip["b.bvh"])
    assert died is not None
    assert "ended 2 times" in died.sentence
    assert "ZeroDivisionError" in (folder / CELLS / by_clip["c.bvh"] / "log.txt").read_text()


@pytest.mark.slow
def test_what_failed_by_no_fault_of_the_input_is_tried_again_by_the_next_run(
    tmp_path: Path,
) -> None:
    planned(tmp_path, {"a.bvh": "crash", "b.bvh": "sleep 0"})
    folder = tmp_path / "out"
    run(folder)
    run(folder)
    assert sorted(Counter(lines(folder, "begin")).values()) == [1, 2]
    assert states(folder) == {"a.bvh": State.FAILED, "b.bvh": State.DONE}


@pytest.mark.slow
def test_a_cell_that_takes_too_long_is_ended_and_told_and_the_others_go_on(tmp_path: Path) -> None:
    planned(tmp_path, {"a.bvh": "sleep 600", "b.bvh": "sleep 0", "c.bvh": "sleep 0.01"})
    folder = tmp_path / "out"
    told = run(folder, jobs=1, cell_limit=0.5)
    assert states(folder) == {"a.bvh": State.FAILED, "b.bvh": State.DONE, "c.bvh": State.DONE}
    assert "It took longer than 0.5 s and was ended" in told
    assert "3 of 3 cells" in told
    assert len(lines(folder, "begin")) == 3  # each once


@pytest.mark.slow
def test_a_cell_that_would_not_fit_into_memory_waits_for_the_other(tmp_path: Path) -> None:
    planned(tmp_path, {f"{i}.bvh": "sleep 0.05" for i in range(4)})
    folder = tmp_path / "out"
    run(folder, jobs=4, memory=MemoryWatch(lambda: 0))
    log = (folder / fake_batches.WORK_LOG).read_text().split("\n")
    words = [line.split()[0] for line in log if line]
    assert words == ["begin", "end"] * 4  # one at a time
    assert len({line.split()[2] for line in log if line.startswith("begin")}) == 1


def test_workers_that_cannot_start_are_told_in_a_sentence(tmp_path: Path) -> None:
    planned(tmp_path, {"a.bvh": "sleep 0"})
    folder = tmp_path / "out"
    manifest = read_manifest(folder)
    progress = Progress(sys.stdout, 1, Counter())
    command = [sys.executable, "-c", "import sys; sys.exit('no numpy')"]
    with pytest.raises(BatchFault, match=r"No worker process can be started: .*no numpy"):
        LocalRun(folder, manifest, 1, command, progress).run()


def test_a_second_batch_in_the_folder_is_refused_while_one_runs(tmp_path: Path) -> None:
    with batch_lock(tmp_path), pytest.raises(FolderBusy, match="running"), batch_lock(tmp_path):
        pass
    with batch_lock(tmp_path):
        pass


def test_what_passes_ends_with_another_code_than_wrong_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    planned(tmp_path, {"a.bvh": "sleep 0"})
    command = ["plan", str(tmp_path), "--check", "--out", str(tmp_path / "out")]
    with batch_lock(tmp_path / "out"):
        assert commands.run(command) == 1
    assert "Another batch is running" in capsys.readouterr().err

    def fill(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "replace", fill)
    assert commands.run(command) == 1
    assert "No space left on device" in capsys.readouterr().err
    assert commands.run(["plan", str(tmp_path / "none"), *command[2:]]) == 2


def test_a_folder_that_knows_no_locks_is_told_as_that(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def flock(_file: int, _how: int) -> None:
        raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS))

    monkeypatch.setattr("fcntl.flock", flock)
    with pytest.raises(FolderGone, match="not implemented"), batch_lock(tmp_path):
        pass


def kill_and_resume(command: list[str], kills: int, longest: float, seed: int) -> int:
    """SIGKILLs the run of a batch at random moments, then lets it end; how often it was killed."""
    drawn, killed = random.Random(seed), 0
    for _ in range(kills):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        time.sleep(drawn.uniform(0.0, longest))
        killed += process.poll() is None
        process.kill()
        process.wait()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=600)
    return killed


def assert_nothing_lost_or_solved_twice(folder: Path, killed: int, jobs: int) -> None:
    cells = [cell.cell for cell in read_manifest(folder).cells]
    assert {p.name for p in (folder / CELLS).iterdir() if not p.name.startswith(".")} == set(cells)
    for cell in cells:
        result = read_result(folder, cell)
        assert result is not None
        assert result.state is State.DONE
        assert all((folder / CELLS / cell / name).stat().st_size for name in result.files)
    begun = Counter(lines(folder, "begin"))
    assert set(begun) == set(cells)
    assert sum(begun.values()) - len(cells) <= killed * jobs  # only those that were running


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_batch_that_is_killed_twenty_times_loses_nothing(tmp_path: Path) -> None:
    planned(tmp_path, {f"{i}.bvh": f"sleep 0.{i % 7}" for i in range(60)})
    folder = tmp_path / "out"
    command = [*fake_batches.command(), str(folder), "2"]
    killed = kill_and_resume(command, 20, 3.0, seed=0)
    assert_nothing_lost_or_solved_twice(folder, killed, 2)


@pytest.mark.slow
def test_results_that_vanish_are_told(tmp_path: Path) -> None:
    """Such as on a shared folder that is gone."""
    planned(tmp_path, {"a.bvh": "sleep 0.5"})
    folder = tmp_path / "out"

    def remove() -> None:
        while not lines(folder, "begin"):
            time.sleep(0.02)
        shutil.rmtree(folder)

    thread = threading.Thread(target=remove)
    thread.start()
    with pytest.raises(BatchFault, match="same command"):
        run(folder, jobs=1)
    thread.join()
