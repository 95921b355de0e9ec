"""Modules run in processes of their own: what is told of one that fails."""

from pathlib import Path

import pytest
from hangtime.devtools.processes import run_module


@pytest.mark.slow
def test_a_failure_is_told_by_its_last_line(tmp_path: Path) -> None:
    said = run_module("devtools.pairs.solve", [str(tmp_path / "none"), str(tmp_path / "found")])
    assert said is not None
    assert said.startswith("FileNotFoundError")


def test_a_process_that_takes_too_long_is_ended_and_told(tmp_path: Path) -> None:
    said = run_module("devtools.pairs.solve", [str(tmp_path / "none")], longest=0.01)
    assert said == "solve took longer than 0.01 s"
