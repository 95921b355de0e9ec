"""Two folders of results are the same where every number is near and every word equal."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hangtime.devtools.gallery.compare import FILE, main

ARRAYS: dict[str, Any] = {
    "time": np.array([0.0, 0.001]),
    "body_names": np.array(["Hips", "Head"]),
    "com": np.zeros((2, 2, 3)),
    "contact_point": np.zeros((2, 0, 3)),
}


def result(folder: Path, name: str = "hop", **changes: Any) -> Path:
    """A folder with one result, its arrays as ARRAYS has them but for the changes; None: absent."""
    arrays = {k: v for k, v in (ARRAYS | changes).items() if v is not None}
    (folder / name).mkdir(parents=True)
    np.savez_compressed(folder / name / FILE, **arrays)
    return folder


def compared(tmp_path: Path, *options: str) -> int:
    return main([str(tmp_path / "before"), str(tmp_path / "after"), *options])


def test_what_rounding_does_is_no_difference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result(tmp_path / "before", "runs/wide", com=np.full((2, 2, 3), 1.0))
    result(tmp_path / "after", "runs/wide", com=np.full((2, 2, 3), 1.0 + 5e-7))
    assert compared(tmp_path) == 0
    line, last = capsys.readouterr().out.splitlines()
    assert line.split() == ["runs/wide", "same", "5e-07", "in", "com"]
    assert last.startswith("1 of 1 ")


def test_the_tolerance_can_be_chosen(tmp_path: Path) -> None:
    result(tmp_path / "before")
    result(tmp_path / "after", time=np.array([0.0, 0.002]))
    assert compared(tmp_path) == 1
    assert compared(tmp_path, "--within", "0.01") == 0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"com": np.full((2, 2, 3), 2e-6)}, "2e-06 in com"),
        ({"com": np.full((2, 2, 3), np.nan)}, "inf in com"),
        ({"com": np.zeros((2, 1, 3))}, "com: shape (2, 2, 3), then (2, 1, 3)"),
        ({"com": None}, "com is in one of them only"),
        ({"gravity": np.zeros(3)}, "gravity is in one of them only"),
        ({"body_names": np.array(["Hips", "Neck"])}, "body_names: other words"),
        ({"body_names": np.zeros(2)}, "body_names: other words"),
    ],
)
def test_a_difference_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Any], words: str
) -> None:
    result(tmp_path / "before", "a")
    result(tmp_path / "before", "b")
    result(tmp_path / "after", "a", **changes)
    result(tmp_path / "after", "b")
    assert compared(tmp_path) == 1
    one, other, last = capsys.readouterr().out.splitlines()
    assert one.startswith("a ")
    assert one.endswith(f"DIFFERS  {words}")
    assert "same" in other
    assert last.startswith("1 of 2 ")


def test_what_is_no_number_in_both_is_the_same(tmp_path: Path) -> None:
    for folder in ("before", "after"):
        result(tmp_path / folder, com=np.array([np.nan, np.inf, -np.inf]))
    assert compared(tmp_path) == 0


def test_a_missing_result_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result(tmp_path / "before", "a")
    result(tmp_path / "before", "b")
    result(tmp_path / "after", "a")
    assert compared(tmp_path) == 1
    assert "is missing" in capsys.readouterr().out.splitlines()[1]


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04cut off"])
def test_a_broken_file_fails(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: bytes
) -> None:
    result(tmp_path / "before")
    (result(tmp_path / "after") / "hop" / FILE).write_bytes(content)
    assert compared(tmp_path) == 1
    assert "cannot be read" in capsys.readouterr().out


def test_folders_that_are_not_there_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        compared(tmp_path)
    assert "cannot be read (No such file" in capsys.readouterr().err


def test_nothing_to_compare_is_no_success(tmp_path: Path) -> None:
    (tmp_path / "before").mkdir()
    (tmp_path / "after").mkdir()
    result(tmp_path / "after")
    assert compared(tmp_path) == 1
