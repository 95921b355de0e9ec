"""Batches here, on Dask and in OpenJD's sessions: python3 dev.py farm [--quick] [--out DIR].

Ends with 1 where a figure misses what it must reach; with `--tell` figures of time are only told.
`--tests` runs tests/farm instead.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from random import Random
from statistics import median

import pytest

from ...batch.cluster.dispatch import run_on_dask
from ...batch.records.manifest import Manifest
from ...batch.records.result import RESULT, cell_folder, read_result
from ..batch_page.browser import ensure_browser
from ..batch_page.made_up import make_batch
from ..batch_page.measure import measure_collecting, measure_page
from ..environment.virtual_environment import ROOT
from ..figures.limits import Figure, figure, table, write
from ..reports import report_options
from .cluster import running_cluster
from .installed import unpacked_wheel
from .kills import with_workers_killed
from .limits import DASK_KILLED, EQUAL, LIMITS, OVERHEAD, SPEED_UP, timed
from .plans import contents, differing, plan_hops
from .runs import killed_and_resumed, run_local
from .sessions import run_session

SEED = 13
PAIRS = 5  # of runs, of whose speed-ups the median is told: a phase of the machine spoils a run
Found = Iterator[tuple[str, float]]


def main(argv: list[str]) -> int:
    if "--tests" in argv:
        rest = [word for word in argv if word != "--tests"]
        if not any(Path(word.partition("::")[0]).exists() for word in rest):
            rest.append(str(ROOT / "tests" / "farm"))
        return int(pytest.main(["-q", *rest]))
    parser = argparse.ArgumentParser(prog="dev.py farm", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR")
    parser.add_argument("--quick", action="store_true", help="fewer cells, runs and kills")
    parser.add_argument("--tell", action="store_true", help="fail for no figure of time")
    options = report_options(parser, argv)
    found: list[Figure] = []
    with tempfile.TemporaryDirectory() as scratch:
        for name, value in measured(Path(scratch), quick=options.quick):
            found.append(figure(name, value, "hops", "landing further", LIMITS))
            print(f"{name}: {value:.4g} {LIMITS[name].unit}", flush=True)
    write(found, options.out / "figures.json")
    (options.out / "farm.md").write_text(markdown(found), encoding="utf-8")
    print(table(found, LIMITS))
    return int(any(not each.ok and not (options.tell and timed(each)) for each in found))


def measured(scratch: Path, *, quick: bool) -> Found:
    """Every figure by name, with its value."""
    package = unpacked_wheel(scratch)
    cells = 12 if quick else 60
    one = run_local(scratch / "one", package, cells, 1)
    two = run_local(scratch / "two", package, cells, 2)
    expected = contents(scratch / "one", one.manifest)
    yield EQUAL + "2 workers", apart(scratch / "two", expected)
    if not quick:  # the start of a run would be a great part of it
        ratios = [one.seconds / two.seconds]
        for again in range(1, PAIRS):
            folder, other_way = scratch / f"again {again}", again % 2 == 1
            ratios.append(speed_up(folder, package, cells, two_first=other_way))
        yield SPEED_UP, median(ratios)
    yield from told_times(scratch / "one", one.manifest)
    for share, how in ((True, "shared folder"), (False, "through the scheduler")):
        plan_hops(scratch / how, cells)
        with running_cluster(scratch / f"cluster, {how}", package, 4) as cluster:
            run_on_dask(scratch / how, str(cluster.file), print, share=share)
        yield EQUAL + f"4 Dask workers, {how}", apart(scratch / how, expected)
    plan_hops(scratch / "openjd", cells)
    run_session(scratch / "openjd", package, cells_per_task=7)
    yield EQUAL + "OpenJD's session", apart(scratch / "openjd", expected)
    yield from killed(scratch, package, quick=quick)
    yield from sized(scratch)


def speed_up(folder: Path, package: Path, cells: int, *, two_first: bool) -> float:
    """How much sooner two workers are done than one. two_first: every other time they go first, so
    that a machine that grows slower meanwhile counts for both alike."""
    seconds = {
        jobs: run_local(folder / str(jobs), package, cells, jobs).seconds
        for jobs in ((2, 1) if two_first else (1, 2))
    }
    return seconds[1] / seconds[2]


def apart(folder: Path, expected: dict[str, str]) -> float:
    """Cells of a batch that another run has not alike, or that one of them lacks."""
    manifest = plan_hops(folder, len(expected))
    return len(differing(contents(folder, manifest), expected))


def told_times(folder: Path, manifest: Manifest) -> Found:
    """What one worker's cells took: from one result to the next on the wall's clock, so that
    handing over and the way onto the disk count, less what each tells of its fit and solve."""
    cells = sorted((cell_folder(folder, plan.cell) for plan in manifest.cells), key=written_at)
    results = [read_result(folder, cell.name) for cell in cells]
    seconds = [result.seconds for result in results if result is not None]
    took = [written_at(later) - written_at(one) for one, later in pairwise(cells)]
    later_ones = zip(took, seconds[1:], strict=True)
    beside = [wall - told["fit"] - told["solve"] for wall, told in later_ones]
    yield OVERHEAD, 1000.0 * median(beside)
    yield "solve of a cell", median(each["solve"] for each in seconds[1:])
    yield "seconds a cell, one core", median(took)
    yield "seconds a fit", max(each["fit"] for each in seconds)
    yield "megabytes a cell", median(map(size, cells))
    fits = [size(path) for path in (folder / "fits").glob("[!.]*")]
    yield "megabytes a fit", max(fits)


def written_at(cell: Path) -> float:
    """When a cell's result was written, s."""
    return (cell / RESULT).stat().st_mtime


def size(folder: Path) -> float:
    """MB of a folder's files."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def killed(scratch: Path, package: Path, *, quick: bool) -> Found:
    """Runs in which workers, or the batch itself, are killed."""
    chance = Random(SEED)
    hops = 12
    run = run_local(scratch / "in peace", package, hops, 2)
    expected = contents(scratch / "in peace", run.manifest)
    bad, workers = 0, 0
    for k in range(2 if quick else 10):
        folder = scratch / f"killed workers {k}"
        outcome = with_workers_killed(folder, package, expected, chance, share=k % 2 == 0)
        bad += outcome.bad
        workers += outcome.killed
    yield DASK_KILLED, workers
    yield "Dask, 2 of 4 workers killed: cells lost, doubled or different", bad
    bad = killed_and_resumed(scratch, package, expected, chance, 8 if quick else 20)
    yield "batch killed and resumed: cells lost, half-written or solved again", bad


def sized(scratch: Path) -> Found:
    """Batches that are large, with nothing solved."""
    began = time.perf_counter()
    plan_hops(scratch / "planned", 10_000)
    yield "10,000 cells planned", time.perf_counter() - began
    make_batch(scratch / "many", 10_000)
    collecting = measure_collecting(scratch / "many")
    yield "10,000 cells collected", collecting.seconds
    yield "10,000 cells collected, memory", collecting.megabytes
    make_batch(scratch / "page", 1_000)
    measure_collecting(scratch / "page")
    ensure_browser(scratch / "browser.log")
    page = measure_page(scratch / "page" / "index.html")
    yield "page of 1,000 cells: first paint", page.first_paint
    yield "page of 1,000 cells: filter", page.filter


def markdown(found: list[Figure]) -> str:
    """The figures as the table of docs/farm.md."""
    lines = ["| figure | value | unit | must | aim |", "|---|---|---|---|---|"]
    for each in found:
        must, aim = ("–" if x is None else f"{x:g}" for x in (each.must, each.aim))
        value = f"{each.value:.3g}" + ("" if each.ok else " **missed**")
        lines.append(f"| {each.name} | {value} | {each.unit} | {must} | {aim} |")
    return "\n".join(lines) + "\n"
