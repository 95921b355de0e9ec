"""A real batch, killed again and again: it ends with what one that was left alone ends with."""

import random
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hangtime.batch.records.manifest import read_manifest
from hangtime.batch.records.result import State, cell_folder, read_result
from hangtime.devtools.environment.virtual_environment import ROOT
from hangtime.tests.helpers.clips import mocap_path

RECIPE = """
frames = [20, 190]
[[pin]]
name = "Landing"
phase = "ground 2"
forward = { from = 0.05, to = 0.3, steps = 6 }
up = [0.0, 0.05]
"""
KILLS = 20

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL"),
]


def command(folder: Path, out: str, jobs: int) -> list[str]:
    launcher = str(Path(ROOT, "devtools", "package.py"))
    clip, recipe = str(mocap_path("hop_01_01.bvh")), str(folder / "recipe.toml")
    words = ["--recipes", recipe, "--out", str(folder / out), "--jobs", str(jobs)]
    return [sys.executable, launcher, "batch.cli", clip, *words]


def written(folder: Path) -> dict[str, int]:
    """When each cell's result was written; a result that is there must be whole."""
    found = {}
    for path in folder.glob("cells/[0-9]*"):
        result = read_result(folder, path.name)
        assert result is not None
        assert all((path / name).stat().st_size for name in result.files)
        found[path.name] = (path / "result.json").stat().st_mtime_ns
    return found


def test_nothing_is_lost_or_solved_twice_and_every_motion_is_the_same_to_the_bit(
    tmp_path: Path,
) -> None:
    (tmp_path / "recipe.toml").write_text(RECIPE)
    subprocess.run(command(tmp_path, "alone", 1), check=True, timeout=600)
    drawn, before, killed = random.Random(1), dict[str, int](), 0
    for _ in range(KILLS):
        process = subprocess.Popen(command(tmp_path, "killed", 2))
        time.sleep(drawn.uniform(0.3, 3.5))
        killed += process.poll() is None
        process.kill()
        process.wait()
        time.sleep(0.3)  # its workers end when they notice
        now = written(tmp_path / "killed")
        assert before.items() <= now.items()
        before = now
    assert killed
    subprocess.run(command(tmp_path, "killed", 2), check=True, timeout=600)
    assert before.items() <= written(tmp_path / "killed").items()
    one, two = (read_manifest(tmp_path / out) for out in ("alone", "killed"))
    assert [c.cell for c in one.cells] == [c.cell for c in two.cells]
    for cell in (c.cell for c in two.cells):
        result = read_result(tmp_path / "killed", cell)
        assert result is not None
        assert result.state is State.DONE
        pair = [
            np.load(cell_folder(tmp_path / out, cell) / "trajectory.npz")
            for out in ("alone", "killed")
        ]
        for name, values in pair[0].items():
            nan = values.dtype.kind == "f"
            assert np.array_equal(values, pair[1][name], equal_nan=nan), name
