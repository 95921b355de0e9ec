"""Everything that must hold before a change lands, from a clean machine: .ci/run.

Standard library only. Each check is a process of its own. Two run at once, one on each core, except
those that all others need. No figure that a neighbour would spoil is judged here. The last line
adds up all tests.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from ..environment import pythons
from ..environment.problem import SetUpError
from ..environment.virtual_environment import CACHE
from . import summary

ROOT = Path(__file__).resolve().parents[2]
CORES = 2
ONE_CORE = {"HANGTIME_THREADS": "1"}  # SOLVER_THREADS: a neighbour has the other core
RECALLED = 25  # last lines of a check that failed, told once more at the end
# Recordings that may not be redistributed; the trial held here is among them.
TRIALS = ROOT.parent / "shared" / "validation"


@dataclass(frozen=True)
class Check:
    """Calls of dev.py, one after the other, and all of them even where one fails.

    {reports} and {out} in an argument stand for the folder of reports and a new folder.
    """

    name: str
    calls: tuple[str, ...]
    root: Path = ROOT


@dataclass(frozen=True)
class CheckRun:
    """What a check said, how long it took (s), and whether all its calls ended with 0."""

    name: str
    text: str
    seconds: float
    passed: bool


def other_environments() -> Check:
    """Made before anything is run in them."""
    blenders = (each for each in ("5.2", "4.2", "5.0") if runs(each))
    calls = tuple(f"test --blender {each} --help" for each in blenders)
    return Check("environments of other Blenders", calls)


def tests(blender: str, report: str, chosen: str) -> str:
    return f"test --blender {blender} --reports {{reports}}/{report} {chosen}"


def suite(blender: str, *parts: str) -> Check:
    """The tests in Blender, each part in a process of its own."""
    calls = tuple(tests(blender, f"{blender}-{k}", part) for k, part in enumerate(parts))
    return Check(f"Blender {blender}", calls)


def shared_checks() -> Iterator[Check]:
    """Checks that leave a core to another; the longest first, so that both cores end together."""
    in_blender, zipped, quick = "tests/blender", "tests/installed", "-m 'not slow'"
    operators = f"{in_blender}/operators"
    without = f"tests --ignore=tests/solver --ignore={in_blender}"
    # Slow tests once: those in Blender in the newest, which is the least like that of the README's
    # tests.
    newest = "5.2" if runs("5.2") else "4.5"
    yield suite(newest, in_blender, zipped)
    # In several processes: late in one that has done all of it 4.2 ends with a segmentation fault,
    # in its glTF add-on.
    others = f"{in_blender} --ignore={operators}"
    yield suite("4.2", f"{operators} {quick}", f"{others} {quick}", zipped)
    # The first makes the sandbox of both.
    rig = "window --scenes rig_scrubs rig_exports --tell --reports {reports}/window-rig"
    window = "window --without-rig --blender 4.5 --tell --reports {reports}/window --out {out}"
    by_hand = (f"{rig} --blender 4.5 --out {{out}}", window)
    yield Check("the window, driven by mouse and keys", by_hand)
    for name, chosen in (("solver", "tests/solver"), ("rest", without)):
        yield Check(f"slow tests, {name}", (tests("4.5", f"slow-{name}", f"{chosen} -m slow"),))
    # What 5.0 changed 5.2 has, too: there the extension does its main job.
    yield suite("5.0", zipped)
    yield Check(
        "farms, and batches that are killed",
        (
            "farm --blender 4.5 --tests --junitxml={reports}/farm.xml",
            "farm --blender 4.5 --quick --tell --out {out}",
        ),
    )
    solved = "gallery --quick --once --no-pictures"
    yield measure("the gallery's results, solved and written", solved)
    yield measure("the hostile campaign", "campaign --cases 1000")
    yield measure("force plates", f"validate {plates()} --no-curves")
    yield measure("the benchmark", "benchmark --quick")
    yield measure("what is repaired is fitted", "doctor --fits --quick")
    yield measure("skeletons of all conventions", "rigs --quick")
    yield Check("lint", ("lint --blender 4.5",))
    yield measure("recordings damaged, diagnosed and repaired", "doctor --table --quick")
    yield measure("reduced keys", "keys")
    yield measure("every kind of edit on a jump", "survey --quick")
    yield measure("nothing goes through anything", "solid --quick")
    yield measure("seams of loops", "loop")
    yield measure("build", "build")


def measure(name: str, call: str) -> Check:
    return Check(name, (f"{call} --blender 4.5 --out {{out}}",))


def plates() -> str:
    """The folder of trials; nothing where only the one of the repository is there."""
    if TRIALS.is_dir():
        return str(TRIALS)
    print(f"force plates: only the trial of the repository, for {TRIALS} is not there")
    return ""


def runs(blender: str) -> bool:
    """Whether a Python for it is on this machine."""
    try:
        pythons.choose(blender)
    except SetUpError as problem:
        print(f"Blender {blender} is left out: {problem}")
        return False
    return True


def main() -> int:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        clone = folder / "clone"
        # Completed before several would do so at once.
        shared = Check("the environment", ("test --blender 4.5 --help",))
        # To fetch an environment leaves a core idle, as does the clone's own.
        with ThreadPoolExecutor(1) as pool:
            others = pool.submit(run, other_environments(), folder)
            outcomes = [told(run(standalone(clone), folder)), told(others.result())]
        take_over(clone)
        outcomes += run_all([shared], list(shared_checks()), folder)
        for failed in (outcome for outcome in outcomes if not outcome.passed):
            print(f"\nfailed: {failed.name}; it ended so:")
            print(*failed.text.splitlines()[-RECALLED:], sep="\n")
        skipped = summary.main(folder / "reports")
    return int(skipped or not all(outcome.passed for outcome in outcomes))


def run_all(first: list[Check], shared: list[Check], folder: Path) -> Iterator[CheckRun]:
    """Outcomes, told as they come: `first` one by one, then `shared` side by side."""
    for check in first:
        yield told(run(check, folder))
    with ThreadPoolExecutor(CORES) as pool:
        for pending in as_completed(
            [pool.submit(run, check, folder, ONE_CORE) for check in shared]
        ):
            yield told(pending.result())


def told(outcome: CheckRun) -> CheckRun:
    print(f"\n{outcome.text}=== {outcome.name}: {outcome.seconds:.0f} s", flush=True)
    return outcome


def standalone(clone: Path) -> Check:
    """The README's test command in a clone of HEAD that has nothing beside it.

    It makes its own environment: one that is shared would hide what a clone lacks, such as the
    fetched recording that is kept in it.
    """
    status = subprocess.check_output(["git", "status", "--porcelain"], cwd=ROOT, text=True)
    for line in status.splitlines():
        print(f"not committed, so not in the clone: {line}")
    subprocess.run(["git", "clone", "--quiet", ROOT, clone], check=True)
    return Check("the README's test command in a clone", ("test --reports {reports}/clone",), clone)


def take_over(clone: Path) -> None:
    """Moves what a clone has made for itself here, where it is missing: most of the others share
    it, and to make it once more takes a minute. What is in it is run by Python alone, which finds
    it wherever it lies."""
    CACHE.mkdir(exist_ok=True)
    for made in (clone / CACHE.name).glob("*"):
        if not (CACHE / made.name).exists():
            part = CACHE / f"{made.name}.part"  # which nobody takes for whole, if this is ended
            shutil.move(made, part)
            part.rename(CACHE / made.name)


def run(check: Check, folder: Path, variables: Mapping[str, str] | None = None) -> CheckRun:
    """Run a check's calls; what they print is kept.

    variables: of its environment, besides those of this process.
    """
    start = time.perf_counter()
    text, passed = "", True
    for call in check.calls:
        out = tempfile.mkdtemp(dir=folder)
        words = shlex.split(call.format(reports=folder / "reports", out=out))
        text += f"=== {check.name}: dev.py {' '.join(words)}\n"
        ended = subprocess.run(
            [sys.executable, "dev.py", *words],
            cwd=check.root,
            env=os.environ | (variables or {}),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        text += ended.stdout
        passed = passed and ended.returncode == 0
    return CheckRun(check.name, text, time.perf_counter() - start, passed)


if __name__ == "__main__":
    sys.exit(main())
