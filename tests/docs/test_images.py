"""Every picture that a page shows is there, and a command renews those of the manual."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hangtime.devtools.window.driving import manual_images as manual

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
SHOWN = re.compile(r"!\[[^]]*\]\(([^)\s]+)\)")
SCENARIOS = ROOT / "devtools/window/scenarios"
TAKEN = re.compile(r'keep\(driver, "(\w+)"')
NAMED = re.compile(r'Scenario\("(\w+)"')


def shown(page: Path) -> list[Path]:
    return [page.parent / place for place in SHOWN.findall(page.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_picture_that_a_page_shows_is_there(page: Path) -> None:
    assert [str(image) for image in shown(page) if not image.is_file()] == []


def test_the_windows_scenarios_take_all_pictures_of_the_manual() -> None:
    folder = manual.IMAGES.resolve()
    named = {
        image.stem for page in PAGES for image in shown(page) if image.resolve().parent == folder
    }
    assert named == set(manual.SCENARIOS)
    assert {image.stem for image in folder.iterdir()} == named


def test_each_picture_is_taken_once_by_a_scenario_of_that_name() -> None:
    sources = [file.read_text(encoding="utf-8") for file in SCENARIOS.glob("*.py")]
    taken = [name for source in sources for name in TAKEN.findall(source)]
    assert sorted(taken) == sorted(manual.SCENARIOS)
    scenarios = {name for source in sources for name in NAMED.findall(source)}
    assert set(manual.SCENARIOS.values()) <= scenarios


def test_what_a_run_did_not_take_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    images = tmp_path / "images"
    images.mkdir()
    monkeypatch.setattr(manual, "IMAGES", images)
    (tmp_path / manual.TAKEN).mkdir()
    (tmp_path / manual.TAKEN / "drag.png").write_bytes(b"new")
    missing = manual.renew(tmp_path)
    assert (images / "drag.png").read_bytes() == b"new"
    assert missing == [name for name in manual.SCENARIOS if name != "drag"]
