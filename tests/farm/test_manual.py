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
