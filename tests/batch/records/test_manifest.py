"""Manifests: what is written is read again; what was edited or is of another version is refused."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hangtime.batch.records.faults import FolderGone, OtherVersion, WrongManifest
from hangtime.batch.records.manifest import (
    MANIFEST,
    BatchSettings,
    CellPlan,
    Manifest,
    Output,
    read_manifest,
    read_plan,
    write_manifest,
)
from hangtime.batch.records.result import CellResult, State
from hypothesis import given
from hypothesis import strategies as st

WORDS = st.text(st.characters(codec="utf-8"), max_size=12)
SETTINGS = BatchSettings((Output.NPZ, Output.BVH), unit=0.01, up="Y")


def manifest_of(names: list[str]) -> Manifest:
    cells = (
        CellPlan("", f"/clips/{n}.bvh", "ab", "/r.toml", str(i), {"pin.L.up": i / 7}).named(
            i, SETTINGS
        )
        for i, n in enumerate(names)
    )
    return Manifest(SETTINGS, tuple(cells))


@given(names=st.lists(WORDS, min_size=1, max_size=5))
@pytest.mark.slow
def test_a_manifest_is_read_as_it_was_written_whole_or_cell_by_cell(
    tmp_path_factory: pytest.TempPathFactory, names: list[str]
) -> None:
    folder, manifest = tmp_path_factory.getbasetemp(), manifest_of(names)
    write_manifest(folder, manifest)
    assert read_manifest(folder) == manifest
    for cell in manifest.cells:
        assert read_plan(folder, cell.cell) == (SETTINGS, cell)


@pytest.mark.parametrize(
    ("line", "change", "said"),
    [
        (1, lambda text: text.replace("/clips/a.bvh", "/clips/c.bvh"), "was changed after"),
        (1, lambda text: text.replace('"cell": "', '"cell": "../../'), "was changed after"),
        (1, lambda text: text.replace('"pin.L.up": 0.0', '"pin.L.up": 0.5'), "line 2 was changed"),
        (1, lambda text: text.replace('"planned"', '"done"'), "line 2 was changed"),
        (1, lambda text: text[:-9], "line 2: that is no cell"),
        (0, lambda text: text.replace("npz", "fbx"), "line 1 was changed"),
        (0, lambda text: text.replace('"format": 1', '"format": 2'), "line 1 was changed"),
        (0, lambda text: text[1:], "no batch's first line"),
        (2, str, "is empty"),
    ],
)
def test_a_manifest_that_was_edited_is_refused_with_its_place(
    tmp_path: Path, line: int, change: object, said: str
) -> None:
    write_manifest(tmp_path, manifest_of(["a", "b"]))
    path = tmp_path / MANIFEST
    lines = path.read_text(encoding="utf-8").splitlines()
    assert callable(change)
    if line < 2:
        lines[line] = change(lines[line])
        path.write_text("\n".join(lines), encoding="utf-8")
    else:
        path.write_text("", encoding="utf-8")
    with pytest.raises(WrongManifest, match=said):
        read_manifest(tmp_path)


def test_a_manifest_of_another_version_is_refused(tmp_path: Path) -> None:
    settings = replace(SETTINGS, version="9.9")
    write_manifest(tmp_path, Manifest(settings, ()))
    with pytest.raises(OtherVersion, match=r"Hangtime 9\.9"):
        read_manifest(tmp_path)
    (tmp_path / MANIFEST).write_text('{"version": "9.9", "told": "otherwise"}\n')
    with pytest.raises(OtherVersion, match=r"Hangtime 9\.9"):
        read_manifest(tmp_path)


def test_lines_of_two_manifests_are_not_mixed(tmp_path: Path) -> None:
    write_manifest(tmp_path, Manifest(replace(SETTINGS, check=True), ()))
    first = (tmp_path / MANIFEST).read_text(encoding="utf-8")
    write_manifest(tmp_path, manifest_of(["a"]))
    line = (tmp_path / MANIFEST).read_text(encoding="utf-8").partition("\n")[2]
    (tmp_path / MANIFEST).write_text(first + line, encoding="utf-8")
    with pytest.raises(WrongManifest, match="of another batch"):
        read_manifest(tmp_path)


def test_a_folder_that_is_gone_is_not_made_anew(tmp_path: Path) -> None:
    """It may come back, such as a shared one, and would then find another in its place."""
    with pytest.raises(FolderGone, match="gone cannot be used"):
        write_manifest(tmp_path / "gone", manifest_of(["a"]))
    assert not (tmp_path / "gone").exists()


def test_a_cell_that_is_not_there_is_told_and_so_is_a_folder_without_a_manifest(
    tmp_path: Path,
) -> None:
    with pytest.raises(WrongManifest, match="There is no"):
        read_plan(tmp_path, "00001-ab")
    write_manifest(tmp_path, manifest_of(["a"]))
    with pytest.raises(WrongManifest, match="no cell “00001-ab”"):
        read_plan(tmp_path, "00001-ab")


def test_the_key_goes_by_names_and_contents_and_not_by_folders() -> None:
    cell = manifest_of(["a"]).cells[0]
    assert replace(cell, clip="/elsewhere/a.bvh").key(SETTINGS) == cell.key(SETTINGS)
    others = [
        replace(cell, clip="/clips/b.bvh"),
        replace(cell, clip_sha256="cd"),
        replace(cell, recipe_sha256="1"),
    ]
    keys = {each.key(SETTINGS) for each in (cell, *others)}
    settings = [replace(SETTINGS, check=True), replace(SETTINGS, take="jump")]
    assert len(keys | {cell.key(each) for each in settings}) == 6


def test_settings_that_came_later_leave_the_cells_of_batches_without_them_as_they_are() -> None:
    assert not {"armature", "take"} & SETTINGS.as_record().keys()
    chosen = replace(SETTINGS, armature="Hero", take="jump")
    assert BatchSettings.of_record(chosen.as_record()) == chosen
    assert BatchSettings.of_record(SETTINGS.as_record()) == SETTINGS


def test_a_result_is_read_as_it_was_written() -> None:
    result = CellResult(
        "00001-ab", State.NO_SOLUTION, "a.bvh", "r.toml", "0.1.0", "Why.", ("One",), {"fit": 1.0}
    )
    assert CellResult.parsed(result.as_json()) == result
    assert json.loads(result.as_json())["exit_code"] == 3
    with pytest.raises(ValueError, match="not the result"):
        CellResult.parsed('{"cell": "a"}')
