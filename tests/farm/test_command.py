"""The wheel's own program, as a user types it beside a scheduler."""

import subprocess
from pathlib import Path

from hangtime.devtools.farm.cluster import running_cluster
from hangtime.devtools.farm.installed import program_in
from hangtime.devtools.farm.plans import CLIP, plan_hops, recipe_of


def test_a_batch_is_run_on_dask_and_collected_by_one_command(tmp_path: Path, package: Path) -> None:
    folder = tmp_path / "hops"
    plan_hops(folder, 3)  # writes the recipe
    words = [program_in(package), CLIP, "--recipes", recipe_of(folder), "--out", folder, "--check"]
    with running_cluster(tmp_path / "cluster", package, 2) as cluster:
        done = subprocess.run([*words, "--dask", cluster.file], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "3 cells: 3 done." in done.stdout
    assert (folder / "index.html").is_file()
    again = subprocess.run([*words, "--dask", "tcp://127.0.0.1:9"], capture_output=True, text=True)
    assert again.returncode == 0  # nothing is left to be done, so nobody is asked
    assert "; before: 3 done." in again.stdout


def test_a_scheduler_that_is_not_there_is_wrong_input(tmp_path: Path, package: Path) -> None:
    folder = tmp_path / "hops"
    plan_hops(folder, 2)
    words = [program_in(package), CLIP, "--recipes", recipe_of(folder), "--out", folder]
    done = subprocess.run([*words, "--dask", tmp_path / "none"], capture_output=True, text=True)
    assert done.returncode == 2
    assert "No scheduler answers at" in done.stderr
    assert "Traceback" not in done.stderr
