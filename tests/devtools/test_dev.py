"""The set-up's own decisions; that it works as a whole is what every CI run shows."""

import subprocess
import sys
from pathlib import Path

import pytest
from hangtime.devtools import package
from hangtime.devtools.checks import summary
from hangtime.devtools.environment import libraries, pythons
from hangtime.devtools.environment.problem import SetUpError
from hangtime.devtools.environment.virtual_environment import VirtualEnvironment


def test_without_a_wish_the_running_python_decides() -> None:
    blender, path = pythons.choose(None)
    assert (blender.python, path) == (pythons.running(), sys.executable)


@pytest.mark.parametrize("wanted", ["4.2", "4.2.x", "4.2.23"])
def test_a_blender_is_named_by_the_beginning_of_its_version(wanted: str) -> None:
    assert [b.version for b in pythons.named(wanted)] == ["4.2.23"]


@pytest.mark.parametrize("wanted", ["4.5.1", "3.6", "", "new"])
def test_an_unknown_blender_is_refused(wanted: str) -> None:
    with pytest.raises(SetUpError, match=r"4\.5\.15"):
        pythons.named(wanted)


def test_a_missing_python_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pythons, "running", lambda: "3.14")
    monkeypatch.setattr(pythons, "minor_of", lambda _: None)
    with pytest.raises(SetUpError, match=r"needs Python 3\.11 or 3\.13.*this is 3\.14"):
        pythons.choose(None)


def test_a_shim_that_fails_is_no_python(tmp_path: Path) -> None:
    shim = tmp_path / "python3.13"
    shim.write_text("#!/bin/sh\nexit 127\n")
    shim.chmod(0o755)
    assert pythons.minor_of(str(shim)) is None


def test_who_is_not_root_is_told_the_line_to_run(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(libraries.shutil, "which", lambda _: "/usr/bin/apt-get")
    monkeypatch.setattr(libraries.os, "geteuid", lambda: 1000)
    with pytest.raises(SetUpError, match=r"sudo apt-get install -y \S+ libxi6$"):
        libraries.install("Blender needs libXi.so.6", ("libxi6",), tmp_path / "log")


def test_errors_count_as_failures(tmp_path: Path) -> None:
    counts = 'tests="9" failures="1" errors="2" skipped="3"'
    for name in ("a.xml", "b.xml"):
        (tmp_path / name).write_text(f"<testsuites><testsuite {counts}/></testsuites>")
    assert str(summary.read_all(tmp_path)) == "6 passed, 6 failed, 6 skipped"


def test_a_skip_for_want_of_data_is_no_allowed_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cases = "".join(
        f'<testcase classname="tests.t" name="{name}"><skipped message="{why}"/></testcase>'
        for name, why in (("peer", "no Drake"), ("clip", "the recordings are not here"))
    )
    suite = f'<testsuite tests="2" failures="0" errors="0" skipped="2">{cases}</testsuite>'
    (tmp_path / "a.xml").write_text(f"<testsuites>{suite}</testsuites>")
    assert summary.main(tmp_path) == 1
    told, total = capsys.readouterr().out.splitlines()
    assert told.endswith("a.xml: tests.t.clip: the recordings are not here")
    assert total == "0 passed, 0 failed, 2 skipped"


def test_what_no_command_expects_ends_in_a_code_as_well(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Left to Python, some versions of bpy never end after it."""

    def fail(_: list[str]) -> int:
        raise IndexError("no frame 0")

    monkeypatch.setattr(package, "main", fail)
    assert package.told([]) == 1
    assert "IndexError: no frame 0" in capsys.readouterr().err


def test_bytecode_is_kept_in_the_environment_whatever_the_user_prefers(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    (tmp_path / "module.py").write_text("")
    variables = VirtualEnvironment(tmp_path / "env").variables()
    subprocess.run([sys.executable, "-c", "import module"], cwd=tmp_path, env=variables, check=True)
    assert list((tmp_path / "env").rglob("module.*.pyc"))
    assert not (tmp_path / "__pycache__").exists()
