"""Batches on a real scheduler with real workers, processes of this machine on its loopback."""

import gc
import shutil
import sys
import threading
from pathlib import Path
from random import Random

import pytest
from hangtime.batch.cluster.connection import FarmGone, connected
from hangtime.batch.cluster.dispatch import run_on_dask
from hangtime.batch.cluster.worker_side import Reach, look_around
from hangtime.batch.planning.plan import Asked, plan
from hangtime.batch.records.faults import FolderGone, WrongPlan
from hangtime.batch.records.manifest import BatchSettings, Manifest, Output, write_manifest
from hangtime.batch.records.result import CELLS, RESULT, CellResult, State
from hangtime.devtools.farm.cluster import running_cluster
from hangtime.devtools.farm.kills import with_workers_killed
from hangtime.devtools.farm.plans import CLIP, contents, plan_hops


@pytest.mark.parametrize("share", [True, False], ids=["shared folder", "through the scheduler"])
def test_two_of_four_workers_are_killed_and_no_cell_is_lost_doubled_or_different(
    tmp_path: Path, package: Path, solved: dict[str, str], share: bool
) -> None:
    found = with_workers_killed(tmp_path, package, solved, Random(7 + share), share=share)
    assert (found.lost, found.doubled, found.differing, found.half_written) == ([], [], [], [])
    assert found.cells == len(solved) == 12
    assert found.killed == 2


def test_another_version_is_left_out_and_workers_join_in_the_middle(
    tmp_path: Path, package: Path
) -> None:
    other = tmp_path / "other"
    shutil.copytree(package, other)
    manifest_file = other / "hangtime" / "blender_manifest.toml"
    manifest_file.write_text(manifest_file.read_text().replace('version = "0', 'version = "7'))
    manifest = plan_hops(tmp_path / "batch", 4, check=True)
    told: list[str] = []
    ended: list[CellResult] = []
    with running_cluster(tmp_path / "cluster", package, 0) as cluster:
        cluster.add_worker(other)
        cluster.add_worker(tmp_path / "nothing")
        cluster.add_worker(variables={"OMP_NUM_THREADS": "4"})

        def tell(words: str) -> None:
            told.append(words)
            if sum("is left out" in each for each in told) == 3 and len(cluster.workers) == 3:
                cluster.add_worker()

        def note(result: CellResult) -> None:
            ended.append(result)
            if len(ended) == 1:
                cluster.add_worker()

        run_on_dask(tmp_path / "batch", str(cluster.file), tell, note)
    assert sorted(result.cell for result in ended) == [plan.cell for plan in manifest.cells]
    assert {result.state for result in ended} == {State.DONE}
    assert sum("has Hangtime 7.1.0 and this is 0.1.0; install the wheel" in t for t in told) == 1
    assert sum("cannot load Hangtime" in words for words in told) == 1
    assert sum("takes several threads" in words for words in told) == 1
    assert sum("waits for one" in words for words in told) == 1


def test_a_scheduler_that_goes_is_told_and_the_same_command_goes_on(
    tmp_path: Path, package: Path
) -> None:
    folder = tmp_path / "batch"
    manifest = plan_hops(folder, 4, check=True)
    with (
        running_cluster(tmp_path / "first", package, 1) as cluster,
        pytest.raises(FarmGone, match=r"is gone.*What has ended is kept"),
    ):
        run_on_dask(folder, str(cluster.file), lambda _: None, lambda _: cluster.scheduler.kill())
    kept = {path: path.stat().st_mtime_ns for path in folder.glob(f"{CELLS}/*/{RESULT}")}
    assert 0 < len(kept) < 4
    ended: list[CellResult] = []
    with running_cluster(tmp_path / "second", package, 1) as cluster:
        run_on_dask(folder, str(cluster.file), lambda _: None, ended.append)
    assert len(contents(folder, manifest)) == 4
    assert len(ended) == 4 - len(kept)
    assert {path: path.stat().st_mtime_ns for path in kept} == kept


def test_a_clip_that_goes_meanwhile_fails_its_own_cells_alone(
    tmp_path: Path, package: Path
) -> None:
    clips = [tmp_path / f"{name}.bvh" for name in "ab"]
    for clip in clips:
        shutil.copy(CLIP, clip)
    asked = Asked(BatchSettings(check=True), [str(clip) for clip in clips])
    plan(asked, tmp_path / "batch")
    ended: list[CellResult] = []
    told: list[str] = []

    def note(result: CellResult) -> None:
        ended.append(result)
        clips[1].unlink(missing_ok=True)

    with running_cluster(tmp_path / "cluster", package, 1) as cluster:
        run_on_dask(tmp_path / "batch", str(cluster.file), told.append, note)
    assert {result.clip: result.state for result in ended} == {
        "a.bvh": State.DONE,
        "b.bvh": State.FAILED,
    }
    assert "b.bvh has changed since the batch was planned, or is gone" in ended[1].sentence
    assert not any("share" in words for words in told)


def test_no_scheduler_is_told_in_a_sentence_and_nothing_is_left_of_it(tmp_path: Path) -> None:
    plan_hops(tmp_path / "batch", 2)
    before = threading.enumerate()
    for address in ("tcp://127.0.0.1:9", str(tmp_path / "no file.json")):
        with pytest.raises(FarmGone, match=r"^No scheduler answers at .* check the address"):
            run_on_dask(tmp_path / "batch", address, lambda _: None)
    left = [thread.name for thread in threading.enumerate() if thread not in before]
    assert [name for name in left if "Offload" not in name] == []  # Dask keeps that pool of threads


def test_a_connection_does_not_wait_for_one_that_failed_before(
    tmp_path: Path, package: Path
) -> None:
    gc.disable()  # what is left is collected in the next connection's own thread
    try:
        with pytest.raises(FarmGone), connected(str(tmp_path / "no file.json")):
            pass
        threading.setprofile(collect)
        with (
            running_cluster(tmp_path / "cluster", package, 0) as cluster,
            connected(str(cluster.file)) as client,
        ):
            assert client.status == "running"
    finally:
        threading.setprofile(None)
        gc.enable()


def collect(*_of_call: object) -> None:
    """A profiler that collects garbage as its thread begins, and then takes itself out."""
    sys.setprofile(None)
    gc.collect()


def test_a_folder_that_goes_ends_the_run_in_a_sentence(tmp_path: Path, package: Path) -> None:
    folder = tmp_path / "batch"
    plan_hops(folder, 3, check=True)
    with (
        running_cluster(tmp_path / "cluster", package, 1) as cluster,
        pytest.raises(FolderGone, match=r"batch"),
    ):
        run_on_dask(
            *(folder, str(cluster.file), lambda _: None),
            lambda _: replace_by_file(folder),
            share=False,
        )


def replace_by_file(folder: Path) -> None:
    shutil.rmtree(folder)
    folder.touch()


def test_what_needs_blender_is_refused_before_anything_runs(tmp_path: Path) -> None:
    manifest = plan_hops(tmp_path / "batch", 2)
    settings = BatchSettings(outputs=(Output.FBX,))
    cells = tuple(plan.named(k, settings) for k, plan in enumerate(manifest.cells))
    write_manifest(tmp_path / "batch", Manifest(settings, cells))
    with pytest.raises(WrongPlan, match="workers have no Blender"):
        run_on_dask(tmp_path / "batch", "tcp://127.0.0.1:9", lambda _: None)


def test_a_worker_knows_how_it_reaches_the_folder(tmp_path: Path) -> None:
    (tmp_path / "token").touch()
    assert look_around(str(tmp_path), "token").reach is Reach.SHARED
    assert look_around(str(tmp_path), "other").reach is Reach.NONE
    assert look_around("", "token").reach is Reach.NONE
    shutil.rmtree(tmp_path / CELLS)
    (tmp_path / CELLS).touch()  # cannot be written into, whoever one is
    assert look_around(str(tmp_path), "token").reach is Reach.READ_ONLY
