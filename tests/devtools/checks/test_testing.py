"""What is told of tests that are lost: which, and what its processes were doing."""

import sys
from pathlib import Path

import pytest
from hangtime.devtools.checks import summary
from hangtime.devtools.checks.testing import run
from hangtime.devtools.checks.watched_tests import Limits

HANGS = """
import subprocess, sys, time
WORKER = '''
import runpy, sys, time
runpy.run_path(sys.argv[1])["tell_stacks"]()
def worker_waits_for_ever():
    time.sleep(600.0)
worker_waits_for_ever()
'''
def test_passes():
    assert True
def test_hangs():
    subprocess.run([sys.executable, "-c", WORKER, {program!r}])
"""
DIES = """
import os
def test_dies():
    os._exit(7)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signal")
def test_a_test_that_hangs_is_named_with_the_stacks_of_its_processes(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    from hangtime.solver.worker import program

    said = lost(tmp_path, HANGS.format(program=program.__file__), Limits(60.0, 2.0))
    assert "test_it.py::test_hangs took more than 2 s" in said
    assert "in worker_waits_for_ever" in said
    assert "in test_hangs" in said
    assert "test_hangs took more" in capfd.readouterr().err


@pytest.mark.slow
def test_a_suite_that_hangs_tells_its_test(tmp_path: Path) -> None:
    hangs = "import time\ndef test_hangs():\n    time.sleep(600.0)"
    said = lost(tmp_path, hangs, Limits(4.0, 99.0))
    assert "more than 4 s; it was at" in said
    assert "test_hangs" in said


@pytest.mark.slow
def test_a_test_that_ends_the_process_is_named(tmp_path: Path) -> None:
    said = lost(tmp_path, DIES, Limits(60.0, 60.0))
    assert "ended with code 7" in said
    assert "test_it.py::test_dies" in said


def lost(folder: Path, tests: str, limits: Limits) -> str:
    """The report of tests that are lost."""
    file, report = folder / "test_it.py", folder / "report.xml"
    file.write_text(tests)
    assert run([str(file)], report, limits) == 1
    assert summary.read(report) == summary.Count(failed=1)
    return report.read_text()
