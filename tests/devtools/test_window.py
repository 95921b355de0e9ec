"""The window's tools as far as they need no window."""

import itertools
import json
import math
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hangtime.devtools.checks import summary
from hangtime.devtools.environment.problem import SetUpError
from hangtime.devtools.window import results, sandbox
from hangtime.devtools.window.driving.input_device import duration, quoted, smooth_path
from hangtime.devtools.window.results import RunRecord

PICTURES = ["01_adapts.png"]


def scenario(name: str, failure: str | None = None, skipped: bool = False) -> dict[str, object]:
    record = {"name": name, "seconds": 1.5, "failure": failure, "skipped": skipped}
    return {**record, "pictures": PICTURES}


@pytest.mark.parametrize(
    ("release", "place"), [("bookworm", "http://m.example/debian/"), ("forky", None)]
)
def test_the_mirror_is_where_the_own_release_comes_from(
    monkeypatch: pytest.MonkeyPatch, release: str, place: str | None
) -> None:
    told = """stable main http://shop.example/apt/
bookworm-security main http://m.example/debian-security/
bookworm contrib http://other.example/debian/
bookworm main http://m.example/debian/
"""
    answer = subprocess.CompletedProcess([], 0, stdout=told)
    monkeypatch.setattr(sandbox.subprocess, "run", lambda *_, **__: answer)
    own = {"VERSION_CODENAME": release}
    monkeypatch.setattr(sandbox.platform, "freedesktop_os_release", lambda: own)
    assert sandbox.mirror() == place


def test_a_sandbox_with_something_mounted_in_it_is_not_removed() -> None:
    with pytest.raises(SetUpError, match=r"^/\S* is mounted"):
        sandbox.remove(Path("/proc"))


def test_who_is_not_root_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sandbox.Path, "is_file", lambda _: True)
    monkeypatch.setattr(sandbox.os, "geteuid", lambda: 1000)
    with pytest.raises(SetUpError, match=r"Only root .* run this with sudo\.$"):
        sandbox.check_rights()


def test_a_sandbox_is_ready_once_all_its_packages_are_in_it(tmp_path: Path) -> None:
    place = sandbox.Sandbox(tmp_path / "trixie")
    place.folder.mkdir()
    assert not place.ready
    place.stamp.write_text(json.dumps(sandbox.PACKAGES[1:]))
    assert not place.ready
    place.stamp.write_text(json.dumps(sandbox.PACKAGES))
    assert place.ready


def test_the_sandbox_sees_folders_read_only_unless_told_otherwise(tmp_path: Path) -> None:
    mounts = [
        sandbox.Mount(tmp_path / "a b", "/mnt/a"),
        sandbox.Mount(tmp_path / "out", "/mnt/out", writable=True),
    ]
    lines = sandbox.Sandbox(tmp_path).entry_script("true", mounts, {"DISPLAY": ":84"}).splitlines()
    assert f"mount --bind '{tmp_path}/a b' {tmp_path}/mnt/a" in lines
    assert [line for line in lines if "remount" in line] == [
        f"mount -o remount,bind,ro {tmp_path}/mnt/a"
    ]
    assert lines[-1].startswith(f"exec chroot {tmp_path} env -i ")
    assert "DISPLAY=:84" in lines[-1]


def test_a_move_is_smooth_and_ends_where_it_shall() -> None:
    lines = smooth_path((0.0, 0.0), (300.0, 400.0), 0.5)
    places = [tuple(map(int, line.split()[1:])) for line in lines if line.startswith("mousemove")]
    assert places[-1] == (300, 400)
    far = [math.dist(a, b) for a, b in itertools.pairwise(places)]
    assert max(far) < 500 / len(places) * 2
    assert math.dist((0, 0), places[0]) < min(far[5:-5])
    assert sum(map(duration, lines)) == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize("text", ['say "a"', "two\nlines"])
def test_what_xdotool_could_not_be_given_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="cannot be given"):
        quoted(text)


def test_scenarios_become_a_report_that_is_added_up(tmp_path: Path) -> None:
    scenarios = [
        scenario("imports"),
        scenario("adapts", "it <hung>"),
        scenario("saves", "needs it", True),
    ]
    found = results.scenario_verdicts(RunRecord(0, "", scenarios))
    (tmp_path / "window.xml").write_text(results.junit(found))
    # the run's end is one more
    assert str(summary.read_all(tmp_path)) == "2 passed, 1 failed, 1 skipped"
    failure = ElementTree.parse(tmp_path / "window.xml").find(".//failure")
    assert failure is not None
    assert failure.get("message") == "it <hung> (see 01_adapts.png)"


@pytest.mark.parametrize(
    ("scenarios", "code", "log", "words"),
    [
        ([], 1, "", "did not begin"),
        ([scenario("imports")], 139, "", "code 139"),
        ([scenario("imports")], 124, "", "took too long"),
        ([scenario("imports")], 0, "Blender quit\nLEFT a process\n", "such lines"),
        ([scenario("imports")], 0, "Traceback (most recent call last):\n  File", "such lines"),
    ],
)
def test_a_bad_ending_is_a_failure_whatever_the_scenes_say(
    scenarios: list[dict[str, object]], code: int, log: str, words: str
) -> None:
    run = RunRecord(code, log, scenarios)
    assert words in (run.ending or "")
    assert results.scenario_verdicts(run)[-1].failure == run.ending


def test_a_run_without_fault_ends_well() -> None:
    assert RunRecord(0, "Blender quit", [scenario("imports")]).ending is None


def profile(gap: float, busy: float, calls: dict[str, float]) -> dict[str, object]:
    spans = {name: {"longest": seconds} for name, seconds in calls.items()}
    return {"gaps": {"longest": gap, "busy_longest": busy}, "calls": spans}


def test_blocking_is_our_longest_call_or_the_busiest_gap_but_no_waiting_for_a_picture() -> None:
    profiles = {
        "rest": profile(0.05, 0.01, {}),
        "fit": profile(0.9, 0.02, {"Overlay.draw_view": 0.4, "Operator.modal": 0.03}),
        "solve": profile(0.9, 0.04, {"Operator.modal": 0.03}),
    }
    found = results.blocking(profiles)
    assert found[results.BLOCKED + "fit"] == pytest.approx(30.0)
    assert found[results.BLOCKED + "solve"] == pytest.approx(40.0)
    assert found[results.BETWEEN + "solve"] == pytest.approx(900.0)
    assert results.BLOCKED + "analyse" not in found


def test_clicks_count_only_on_the_way_to_an_adapted_landing() -> None:
    scenarios = [scenario(name) for name in results.QUICKEST]
    tasks = ["imports", "analyses", "drags_landing", "drags_landing", "saves"]
    counted = results.clicks(RunRecord(0, "", scenarios, clicks=[{"task": t} for t in tasks]))
    assert counted == {results.CLICKS: 3}
    assert results.clicks(RunRecord(0, "", scenarios[:-1])) == {}


def test_a_promise_is_kept_missed_or_not_measured() -> None:
    name = "Esc to idle"
    for value, sentence in ((0.05, None), (0.5, "0.5 s, must 0.3")):
        figures = results.figures_of(RunRecord(0, "", figures={name: value}))
        found = {v.name: v.failure for v in results.figure_verdicts(figures)}
        assert found[name] == sentence
        assert found[results.CLICKS] == "was not measured"
