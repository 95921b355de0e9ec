"""What .ci/run makes of its checks."""

from pathlib import Path

import pytest
from hangtime.devtools.checks import ci

FAKE = """
import sys
print("called:", *sys.argv[1:])
sys.exit("fail" in sys.argv)
"""


@pytest.fixture
def fake(tmp_path: Path) -> Path:
    root = tmp_path / "checkout"
    root.mkdir()
    (root / "dev.py").write_text(FAKE)
    return root


def run(fake: Path, *calls: str) -> ci.CheckRun:
    return ci.run(ci.Check("a check", calls, fake), fake)


def test_a_step_passes_where_all_its_calls_do(fake: Path) -> None:
    assert run(fake, "one", "two").passed


def test_a_call_that_fails_is_told_and_the_next_is_still_made(fake: Path) -> None:
    outcome = run(fake, "one", "fail", "three")
    assert not outcome.passed
    assert "called: fail" in outcome.text
    assert "called: three" in outcome.text


def test_reports_and_new_folders_are_named_in_calls(fake: Path) -> None:
    outcome = run(fake, "one --reports {reports} --out {out}")
    words = outcome.text.splitlines()[-1].split()
    assert words[-3] == str(fake / "reports")
    assert Path(words[-1]).is_dir()


def test_steps_side_by_side_are_all_told_as_they_end(
    fake: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad, good = (ci.Check(name, (name,), fake) for name in ("fail", "good"))
    outcomes = list(ci.run_all([good], [bad, good], fake))
    assert sorted(each.passed for each in outcomes) == [False, True, True]
    assert capsys.readouterr().out.count("called: good") == 2


def test_every_call_is_a_command_of_dev_py() -> None:
    help_text = (ci.ROOT / "dev.py").read_text()
    for check in ci.shared_checks():
        for call in check.calls:
            assert f"\n  {call.split()[0]} " in help_text
