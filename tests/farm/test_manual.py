"""What docs/manual/farm.md tells to type is what the programs take."""

import re
from pathlib import Path

from dask_jobqueue import SLURMCluster

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "manual" / "farm.md").read_text(encoding="utf-8")


def test_slurms_jobs_have_a_worker_of_one_thread_for_each_core() -> None:
    block = re.search(r"SLURMCluster\((.*?)\n    \)\n", PAGE, re.DOTALL)
    assert block is not None
    asked = block[1].replace(
        "8786", '0, "host": "127.0.0.1", "dashboard_address": ":0"'
    )  # free ports
    with eval(f"SLURMCluster({asked})", {"SLURMCluster": SLURMCluster}) as cluster:
        script = cluster.job_script()
    assert "#SBATCH -p normal" in script
    assert "#SBATCH --cpus-per-task=16" in script
    assert "source /jobs/venv/bin/activate" in script
    for word in ("--nthreads 1", "--nworkers 16", "--nanny"):
        assert word in script


def test_the_container_has_the_versions_that_are_tested() -> None:
    container = (ROOT / "farm" / "Containerfile").read_text(encoding="utf-8")
    pins = (ROOT / "requirements" / "farm.txt").read_text(encoding="utf-8").splitlines()
    tested = {line.partition(";")[0].strip() for line in pins}
    named = re.findall(r"(?:numpy|distributed)==[\d.]+", container + PAGE)
    assert len(named) == 4
    assert set(named) <= tested
