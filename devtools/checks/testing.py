"""Runs pytest, each suite in a process of its own with a time limit: bpy may crash or hang."""

import argparse
import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import xml.sax.saxutils
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import IO

from ...solver.one_thread import SOLVER_THREADS
from ...solver.worker.program import STACKS_FOLDER
from ..environment.virtual_environment import ROOT
from .summary import read_all
from .watched_tests import Limits, test_at, wait

RUNNER = Path(__file__).with_name("run_pytest.py")
QUICK = ("-m", "not slow")
ELSEWHERE = [f"--ignore=tests/{name}" for name in ("blender", "solver", "installed")]
SUITES = {
    "solver": ["tests/solver", *QUICK],
    "rest": ["tests", *ELSEWHERE, *QUICK],
    "blender": ["tests/blender", *QUICK],
}


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="dev.py test",
        description="Without arguments: every test that is not slow. Others go to pytest.",
    )
    parser.add_argument("--reports", type=Path, metavar="DIR", help="keep the JUnit reports here")
    parser.add_argument("--limit", type=float, default=1800, metavar="S", help="seconds a suite")
    parser.add_argument("--test-limit", type=float, default=600, metavar="S", help="... a test")
    own, rest = parser.parse_known_args(argv)
    limits = Limits(own.limit, own.test_limit)
    suites = {"chosen": rest} if rest else SUITES
    with tempfile.TemporaryDirectory() as scratch:
        folder = (own.reports or Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        code = run_all(suites, folder, limits)
        print(read_all(folder), flush=True)
    return code


def run_all(suites: Mapping[str, list[str]], folder: Path, limits: Limits) -> int:
    """1 where a suite fails. They run side by side, and are told one after the other.

    Several keep the cores busy by themselves, beside which threads of one solve gain nothing.
    """
    variables = os.environ | ({SOLVER_THREADS: "1"} if len(suites) > 1 else {})
    with ThreadPoolExecutor() as pool, contextlib.ExitStack() as logs:
        waiting: list[tuple[Future[int], IO[bytes] | None]] = []
        for name, arguments in suites.items():
            log: IO[bytes] | None = None
            if waiting:
                log = logs.enter_context(tempfile.TemporaryFile())
            report = folder / f"{name}.xml"
            waiting.append((pool.submit(run, arguments, report, limits, variables, log), log))
        codes = []
        for pending, log in waiting:
            codes.append(pending.result())
            if log is not None:
                log.seek(0)
                print(log.read().decode(errors="replace"), flush=True)
    return int(any(codes))


def run(
    arguments: list[str],
    report: Path,
    limits: Limits,
    variables: Mapping[str, str] = os.environ,
    log: IO[bytes] | None = None,
) -> int:
    """Exit code of one pytest process; a report is left even where the process was lost.

    variables: of its environment. log: takes what it says; None lets it say so itself.
    """
    report.unlink(missing_ok=True)
    command = [sys.executable, str(RUNNER), f"--junitxml={report}", *arguments]
    with tempfile.TemporaryDirectory() as scratch:
        watched = Path(scratch)
        process = subprocess.Popen(
            command,
            cwd=ROOT,
            env={**variables, STACKS_FOLDER: scratch},
            start_new_session=True,
            stdout=log,
            stderr=subprocess.STDOUT if log else None,
        )
        try:
            lost = wait(process, watched, limits)
        finally:
            end(process)
        if lost is None and not report.exists():
            code, test = process.returncode, test_at(watched)
            lost = f"pytest's process ended with code {code} before it could report, at {test}"
    if lost is not None:
        write_loss(report, lost, log)
        return 1
    return process.returncode


def end(process: "subprocess.Popen[bytes]") -> None:
    """End the process and, where there are process groups, whatever it started and left."""
    if os.name == "posix":
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


def write_loss(report: Path, problem: str, log: IO[bytes] | None) -> None:
    """A report of one failure, so that a lost process is counted; told where its tests are, too."""
    if log is None:
        print(problem, file=sys.stderr, flush=True)
    else:
        log.write(f"\n{problem}\n".encode())
    words = xml.sax.saxutils.quoteattr(problem)
    report.write_text(
        '<testsuites><testsuite name="pytest" tests="1" failures="1" errors="0" skipped="0">'
        f'<testcase name="process"><failure message={words}/></testcase></testsuite></testsuites>'
    )
