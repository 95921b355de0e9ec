"""What lies at a path is told in words, whatever the system says of it."""

import os
import sys
from pathlib import Path

import pytest
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.paths import AtPath, are_one_file, kind_of, unreadable
from hangtime.solver.data.faults import ClipNotOpened

LONG = "x" * 300


def test_a_file_can_be_read_and_what_is_none_is_told(tmp_path: Path) -> None:
    (tmp_path / "walk.bvh").write_text("HIERARCHY")
    assert unreadable(tmp_path / "walk.bvh") is None
    assert unreadable(tmp_path) == "it is a folder"
    assert unreadable(tmp_path / "run.bvh") == "there is no such file"
    assert unreadable(tmp_path / "walk.bvh" / "run.bvh") == "there is no such file"
    assert unreadable("a\0b.bvh") == "there is no such file"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows knows no such pipes")
def test_a_pipe_that_has_a_clips_name_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "walk.bvh")
    with pytest.raises(ClipNotOpened, match="a pipe or a device"):
        read_bvh(tmp_path / "walk.bvh")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows tells no such file")
def test_a_name_that_is_too_long_is_told_so() -> None:
    assert unreadable(f"{LONG}.bvh") == "File name too long"
    assert not are_one_file(LONG, LONG)


def test_what_may_not_be_looked_at_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tests may run as root, who can look at all."""

    def refusing(path: str) -> object:
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr(os, "stat", refusing)
    assert unreadable("locked/walk.bvh") == "Permission denied"
    with pytest.raises(PermissionError):
        kind_of("locked/walk.bvh")


def test_a_pattern_names_nothing_itself(tmp_path: Path) -> None:
    assert kind_of(tmp_path / "*.bvh") is AtPath.NOTHING
