"""A Dask scheduler and workers as processes of this machine, on its loopback address alone."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from ...solver.one_thread import ONE_THREAD

LOOPBACK = "127.0.0.1"
LONGEST = 60.0  # s, until a scheduler has written its file


@dataclass
class Cluster:
    """The processes. package: a folder from which workers load Hangtime, as the wheel has it."""

    folder: Path
    package: Path
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    @property
    def file(self) -> Path:
        """The scheduler file, by which workers and batches find it."""
        return self.folder / "scheduler.json"

    def add_worker(
        self, package: Path | None = None, variables: Mapping[str, str] = ONE_THREAD
    ) -> subprocess.Popen[bytes]:
        """One more worker with one thread. package: another Hangtime than the cluster's."""
        name = f"worker{len(self.workers)}"
        command = ["dask_worker", "--scheduler-file", str(self.file), "--host", LOOPBACK]
        command += ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--name", name]
        command += ["--local-directory", str(self.folder / name)]
        worker = start(command, self.folder / f"{name}.log", package or self.package, variables)
        self.workers.append(worker)
        return worker


@contextmanager
def running_cluster(folder: Path, package: Path, workers: int) -> Iterator[Cluster]:
    """A scheduler and workers, which end with the block; their logs are in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    command = ["dask_scheduler", "--host", LOOPBACK, "--port", "0", "--no-dashboard"]
    command += ["--scheduler-file", str(folder / "scheduler.json")]
    bare = folder / "without Hangtime"  # as schedulers that a studio has
    cluster = Cluster(folder, package, start(command, folder / "scheduler.log", bare))
    try:
        await_file(cluster)
        for _ in range(workers):
            cluster.add_worker()
        yield cluster
    finally:
        for process in (*cluster.workers, cluster.scheduler):
            process.kill()
            process.wait()


def await_file(cluster: Cluster) -> None:
    """Raises RuntimeError with the scheduler's log where its file does not come."""
    end = time.monotonic() + LONGEST
    while not cluster.file.is_file():
        if cluster.scheduler.poll() is not None or time.monotonic() > end:
            log = (cluster.folder / "scheduler.log").read_text(errors="replace")
            raise RuntimeError(f"No scheduler came up:\n{log}")
        time.sleep(0.05)


def start(
    command: list[str], log: Path, package: Path, variables: Mapping[str, str] = ONE_THREAD
) -> subprocess.Popen[bytes]:
    """One of Dask's programs."""
    kept = {name: value for name, value in os.environ.items() if name not in ONE_THREAD}
    with log.open("wb") as output:
        return subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{command[0]}", *command[1:]],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env={**kept, "PYTHONPATH": str(package), **variables},
        )
