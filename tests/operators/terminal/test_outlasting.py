"""Commands go on where nobody reads what they print, and end with a code that tells."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hangtime.operators.terminal import outlasting

RUN = """
import runpy, sys
outlasting = runpy.run_path(sys.argv[1])["outlasting"]

@outlasting
def command(argv):
    for number in range(3):
        print("stage", number, flush=True)
    print("a line" * 5000)
    with open(argv[0], "w") as file:
        file.write("the result")
    return int(argv[1])

sys.exit(command(sys.argv[2:]))
"""


def run(result: Path, shell: str, code: int = 0) -> tuple[int, str]:
    """The exit code and what was said on the standard error."""
    program = [sys.executable, "-c", RUN, outlasting.__file__, str(result), str(code)]
    words = ["bash", "-c", f'"$@" {shell}', "bash", *program]
    done = subprocess.run(words, stderr=subprocess.PIPE, text=True, timeout=60)
    assert result.read_text() == "the result"
    return done.returncode, done.stderr


linux = pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs Linux")


@linux
def test_work_goes_on_where_the_disk_of_its_log_is_full(tmp_path: Path) -> None:
    code, said = run(tmp_path / "result", "> /dev/full")
    assert code == 1
    assert said.splitlines() == [
        "Not all could be printed (No space left on device); files that were asked for are written."
    ]


@linux
def test_a_worse_end_counts(tmp_path: Path) -> None:
    assert run(tmp_path / "result", "> /dev/full", code=3) == (3, "")


@linux
def test_work_goes_on_where_nobody_reads(tmp_path: Path) -> None:
    assert run(tmp_path / "result", "| true; exit ${PIPESTATUS[0]}") == (141, "")


@linux
def test_work_goes_on_where_the_output_is_closed(tmp_path: Path) -> None:
    code, said = run(tmp_path / "result", ">&-")
    assert (code, said.count("\n")) == (1, 1)
    assert "Bad file descriptor" in said


@linux
def test_work_goes_on_where_all_is_closed(tmp_path: Path) -> None:
    assert run(tmp_path / "result", "<&- >&- 2>&-") == (1, "")


def test_a_closed_pipe_is_one_on_windows_too() -> None:
    """Which calls it an invalid argument."""
    as_there = "import sys; sys.platform = 'win32'; import runpy, errno\n"
    told = f"unread = runpy.run_path({outlasting.__file__!r})['_UNREAD']\n"
    told += "assert unread == {errno.EPIPE, errno.EINVAL}"
    assert subprocess.run([sys.executable, "-c", as_there + told]).returncode == 0


def test_what_can_be_printed_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    def command(argv: object) -> int:
        print("done")
        print(f"of {argv}", file=sys.stderr)
        return 0

    assert outlasting.outlasting(command)(["it"]) == 0
    said = capsys.readouterr()
    assert (said.out, said.err) == ("done\n", "of ['it']\n")
    assert os.fstat(1)
