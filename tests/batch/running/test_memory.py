"""Memory that a container leaves, as control groups of both versions tell it."""

from pathlib import Path

import pytest
from hangtime.batch.running import memory
from hangtime.batch.running.cgroups import free_in_groups
from hangtime.batch.running.memory import MemoryWatch, available

GB = 1 << 30
ENDLESS_V1 = (1 << 63) - 4096  # what version 1 says where there is no limit


def group(folder: Path, files: dict[str, object]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_text(f"{content}\n")


def second(limit: object, used: int, cache: int = 0) -> dict[str, object]:
    stat = f"anon {used - cache}\nfile {cache}\ninactive_file {cache}"
    return {"memory.max": limit, "memory.current": used, "memory.stat": stat}


def first(limit: int, used: int, cache: int = 0) -> dict[str, object]:
    stat = f"inactive_file 0\ntotal_inactive_file {cache}"
    files = {"memory.limit_in_bytes": limit, "memory.usage_in_bytes": used, "memory.stat": stat}
    return dict(files)


@pytest.fixture
def own(tmp_path: Path) -> Path:
    return tmp_path / "own"


def test_the_tightest_of_nested_groups_counts(tmp_path: Path, own: Path) -> None:
    own.write_text("0::/job/step\n")
    group(tmp_path, {"cgroup.controllers": "memory"})  # the root has no limit
    group(tmp_path / "job", second(4 * GB, 3 * GB, cache=GB))
    group(tmp_path / "job" / "step", second("max", GB))
    assert free_in_groups(own, tmp_path) == 2 * GB


def test_a_container_sees_its_own_group_as_the_root(tmp_path: Path, own: Path) -> None:
    own.write_text("5:cpu,cpuacct:/docker/abc\n4:memory:/docker/abc\n")
    group(tmp_path / "memory", first(2 * GB, GB))
    assert free_in_groups(own, tmp_path) == GB


def test_groups_without_a_limit_leave_the_machine_s_memory(tmp_path: Path, own: Path) -> None:
    own.write_text("0::/\n")
    group(tmp_path, second("max", GB))
    assert free_in_groups(own, tmp_path) is None
    assert free_in_groups(tmp_path / "nowhere", tmp_path) is None
    own.write_text("4:memory:/\n")
    group(tmp_path / "memory", first(ENDLESS_V1, GB))
    free = free_in_groups(own, tmp_path)
    assert free is not None
    assert free > 1000 * GB


def test_no_cell_begins_beside_others_that_the_container_has_no_room_for(
    tmp_path: Path, own: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own.write_text("0::/\n")
    group(tmp_path, second(2 * GB, GB))
    monkeypatch.setattr(memory, "free_in_groups", lambda: free_in_groups(own, tmp_path))
    watch = MemoryWatch()
    assert available() <= GB
    watch.told(peak=GB)
    assert not watch.fits(rss=0)
    watch = MemoryWatch()
    watch.told(peak=GB // 2)
    assert watch.fits(rss=0)
