"""A peer's process ends when its time is up: before it begins, after, or by itself."""

import sys
import time
from pathlib import Path

import pytest
from hangtime.benchmarks.watched_process import Limits, run

HANG = "import time; time.sleep(60)"
BEGIN = "from pathlib import Path; Path('begun').touch()\n"


def ran(script: str, folder: Path, limits: Limits) -> bool:
    program = folder / "peer.py"
    program.write_text(f"import os; os.chdir({str(folder)!r})\n{script}")
    begun = (folder / "begun").exists
    return run([sys.executable, "-I", str(program)], folder / "said", limits, begun)


@pytest.mark.parametrize("script", [HANG, BEGIN + HANG])
def test_what_hangs_is_ended(script: str, tmp_path: Path) -> None:
    began = time.monotonic()
    longest = 0.4 if script == HANG else 30.0
    assert not ran(script, tmp_path, Limits(set_up=longest, solving=0.2))
    assert time.monotonic() - began < 10.0
    assert (tmp_path / "begun").exists() == (script != HANG)


def test_what_ends_by_itself_is_waited_for(tmp_path: Path) -> None:
    assert ran(BEGIN, tmp_path, Limits(set_up=30.0, solving=30.0))


def test_what_fails_says_why(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="no Hessian today"):
        ran("raise SystemExit('no Hessian today')", tmp_path, Limits(30.0, 30.0))
