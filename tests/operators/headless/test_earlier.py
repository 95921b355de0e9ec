"""Of an earlier run's files those are removed that are as it wrote them; all else stays."""

import json
from dataclasses import asdict
from errno import EACCES
from pathlib import Path

import pytest
from hangtime.operators.files.outbox import Outbox
from hangtime.operators.headless.earlier import clear, listed_files


def run_once(folder: Path, *names: str) -> None:
    """Leaves files, and a report that lists them."""
    with Outbox(folder) as outbox:
        for name in names:
            outbox.write_text(name, f"{name} of a run")
        files = {name: asdict(record) for name, record in outbox.records().items()}
        outbox.write_text("report.json", json.dumps({"files": files}))
        outbox.deliver()


def cleared(folder: Path, *names: str) -> list[str]:
    return clear((folder / name for name in names), listed_files(folder))


def test_what_nobody_has_changed_is_removed(tmp_path: Path) -> None:
    run_once(tmp_path, "adapted.blend", "adapted.glb")
    lines = cleared(tmp_path, "adapted.blend", "adapted.glb", "film.mp4")
    paths = [f"  {tmp_path / name}" for name in ("adapted.blend", "adapted.glb")]
    assert lines == ["Removed, as of an earlier run:", *paths]
    assert [path.name for path in tmp_path.iterdir()] == ["report.json"]


def test_what_was_polished_by_hand_stays_and_is_told(tmp_path: Path) -> None:
    run_once(tmp_path, "adapted.blend")
    polished = tmp_path / "adapted.blend"
    same_size = polished.read_text()[::-1]
    polished.write_text(same_size)
    told = f"Left as it is, since it was changed after it was written: {polished}"
    assert cleared(tmp_path, "adapted.blend") == [told]
    assert polished.read_text() == same_size


@pytest.mark.parametrize(
    "report", [None, "{}", "no JSON", '{"files": 3}', '{"files": {"sheet.png": {"bytes": 5}}}']
)
def test_what_no_report_lists_stays(report: str | None, tmp_path: Path) -> None:
    """An artist's own, or of a version whose reports did not list files."""
    sheet = tmp_path / "sheet.png"
    sheet.write_text("drawn")
    (tmp_path / "film.mp4").mkdir()
    if report is not None:
        (tmp_path / "report.json").write_text(report)
    told = f"Left as it is, since no report in its folder lists it: {sheet}"
    assert cleared(tmp_path, "sheet.png", "film.mp4") == [told]
    assert sheet.read_text() == "drawn"


def test_what_cannot_be_removed_is_told_and_hides_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on Windows while a program shows it; the rest is removed."""
    run_once(tmp_path, "sheet.png", "trajectory.npz")
    unlink = Path.unlink

    def barred(path: Path, missing_ok: bool = False) -> None:
        if path.name == "sheet.png":
            raise PermissionError(EACCES, "it is open elsewhere")
        unlink(path, missing_ok)

    monkeypatch.setattr(Path, "unlink", barred)
    lines = cleared(tmp_path, "sheet.png", "trajectory.npz")
    place = tmp_path / "sheet.png"
    told = f"Of an earlier run, but it cannot be removed (it is open elsewhere): {place}"
    assert lines == ["Removed, as of an earlier run:", f"  {tmp_path / 'trajectory.npz'}", told]
