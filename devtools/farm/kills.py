"""Batches whose workers, or which themselves, are killed at random moments."""

from __future__ import annotations

import subprocess
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from random import Random
from threading import Timer

from ...batch.cluster.dispatch import run_on_dask
from ...batch.cluster.worker_side import tidy
from ...batch.records.result import CellResult
from .cluster import running_cluster
from .plans import contents, differing, half_written, plan_hops


@dataclass(frozen=True)
class KilledBatch:
    """What became of a batch's cells. killed: workers, before it ended. differing: from another
    run's. doubled: that ended twice."""

    killed: int
    cells: int
    lost: list[str]
    doubled: list[str]
    differing: list[str]
    half_written: list[str]

    @property
    def bad(self) -> int:
        """Cells that are not as they should be."""
        return len({*self.lost, *self.doubled, *self.differing, *self.half_written})


def with_workers_killed(
    folder: Path,
    package: Path,
    expected: dict[str, str],
    chance: Random,
    *,
    share: bool = True,
    cells: int = 12,
) -> KilledBatch:
    """A batch on four workers, of which two are killed after some cell of the first half, each
    somewhat later; the scheduler stays. expected: contents of the same batch, run in peace."""
    manifest = plan_hops(folder / "batch", cells)
    ended: Counter[str] = Counter()
    killed: list[subprocess.Popen[bytes]] = []
    with running_cluster(folder / "cluster", package, 4) as cluster:
        moments = sorted(chance.randint(0, cells // 2) for _ in range(2))
        victims = chance.sample(cluster.workers, 2)

        def note(result: CellResult) -> None:
            ended[result.cell] += 1
            while moments and sum(ended.values()) > moments[0]:
                moments.pop(0)
                Timer(chance.uniform(0.0, 0.6), kill, [victims.pop(), killed]).start()

        run_on_dask(folder / "batch", str(cluster.file), lambda _: None, note, share=share)
        in_time = len(killed)
    tidy(str(folder / "batch"))  # what ended with the cluster: as each run does at its beginning
    found = contents(folder / "batch", manifest)
    names = [plan.cell for plan in manifest.cells]
    return KilledBatch(
        in_time,
        len(names),
        [name for name in names if name not in found],
        [name for name, count in ended.items() if count > 1],
        differing(found, expected),
        half_written(folder / "batch"),
    )


def kill(process: subprocess.Popen[bytes], killed: list[subprocess.Popen[bytes]]) -> None:
    """SIGKILL, and no zombie, which would count as alive."""
    process.kill()
    process.wait()
    killed.append(process)
