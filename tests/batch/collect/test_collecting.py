"""What a batch's folder is collected into: table, contact sheet, and the page's data."""

import csv
import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
from hangtime.batch.collect.collecting import collect
from hangtime.batch.collect.contact_sheet import MOST
from hangtime.batch.collect.gathering import columns, gather, short_keys
from hangtime.batch.collect.letters import BOX, HIGH, LETTERS, WIDE, write
from hangtime.batch.collect.page_file import as_embedded, page_data
from hangtime.batch.collect.png import read_png
from hangtime.batch.records.faults import FolderGone, WrongManifest
from hangtime.batch.records.names import short_names
from hangtime.batch.records.result import CELLS, RESULT, State, read_result
from hangtime.devtools.batch_page.made_up import HARD_NAMES, make_batch

CELLS_MADE = 40
TILE = 240 + 2 * HIGH + 20  # pixels from one line of the contact sheet to the next


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A collected batch of 40 cells, of which the last four are not run."""
    made = tmp_path_factory.mktemp("batches") / "ночь 3"
    make_batch(made, CELLS_MADE, clips=10, unfinished=4)
    collect(made)
    return made


def table(folder: Path) -> list[dict[str, str]]:
    with (folder / "table.csv").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_the_table_has_every_cell_with_values_and_figures_in_full(folder: Path) -> None:
    rows, batch = table(folder), gather(folder)
    assert [row["cell"] for row in rows] == [plan.cell for plan in batch.plans]
    for row, plan in zip(rows, batch.plans, strict=True):
        result = read_result(folder, plan.cell)
        assert row["clip"] == Path(plan.clip).name
        assert float(row["pin.Landing.up"]) == plan.values["pin.Landing.up"]
        assert row["state"] == (State.PLANNED if result is None else result.state).value
        figures = {} if result is None else result.figures
        for name, value in figures.items():
            assert float(row[name]) == value
    assert rows[-1]["exit_code"] == rows[-1]["total_s"] == rows[-1]["steps"] == ""
    assert {Path(row["clip"]).name for row in rows} >= set(HARD_NAMES)


def test_the_page_holds_the_data_that_was_collected(folder: Path) -> None:
    text = (folder / "index.html").read_text(encoding="utf-8")
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    assert found is not None
    data = json.loads(found[1])
    batch = gather(folder)
    assert data["cells"] == [plan.cell for plan in batch.plans]
    assert [data["states"][k] for k in data["state"]] == [state.value for state in batch.states]
    assert [data["clips"][k] for k in data["clip"]] == [Path(p.clip).name for p in batch.plans]
    assert "4 of 40 are not run yet" in " ".join(data["notes"])
    assert "gravity 9.81" in " ".join(data["notes"])
    assert "{{" not in text.replace(found[1], "")


def test_data_cannot_end_its_element_and_holds_no_number_that_json_lacks() -> None:
    assert "<" not in as_embedded({"clip": "</script><!--"})
    assert json.loads(as_embedded({"clip": "</script>"})) == {"clip": "</script>"}


@pytest.mark.slow
def test_the_contact_sheet_shows_the_pictures_of_the_cells(folder: Path) -> None:
    sheet = read_png(folder / "sheet.png")
    done = next(k for k, state in enumerate(gather(folder).states) if state is State.DONE)
    y, x = 40 + TILE * (done // 5), 12 + 352 * (done % 5)
    tile = sheet[y : y + 240, x : x + 340].astype(int)
    arc = (tile[..., 2] - tile[..., 0] > 60).any(axis=0)
    assert arc.mean() > 0.7  # the made-up picture's arc goes from edge to edge
    empty = sheet[40 + TILE * 7 : 40 + TILE * 7 + 60, 12 + 352 * 4 : 340 + 352 * 4]
    assert np.ptp(empty) < 12  # the last cell was not run


@pytest.mark.slow  # draws all that a sheet may have
def test_a_large_batchs_sheet_takes_every_so_manieth(tmp_path: Path) -> None:
    make_batch(tmp_path / "many", 3 * MOST, clips=10)
    collect(tmp_path / "many")
    assert read_png(tmp_path / "many" / "sheet.png").shape[0] == 40 + MOST // 5 * TILE


def test_without_pictures_there_is_no_sheet_and_the_page_says_so(tmp_path: Path) -> None:
    make_batch(tmp_path, 5, clips=2, pictures=False)
    (tmp_path / "sheet.png").write_bytes(b"of a batch before")
    collect(tmp_path)
    assert not (tmp_path / "sheet.png").exists()
    assert "No pictures were asked for" in " ".join(page_data(gather(tmp_path))["notes"])


def test_a_damaged_picture_leaves_its_place_and_the_others(tmp_path: Path) -> None:
    manifest = make_batch(tmp_path, 5, clips=2)
    damaged = next(tmp_path.glob(f"{CELLS}/*/sheet.png"))
    damaged.unlink()
    damaged.write_bytes(b"\x89PNG, and then nothing")
    collect(tmp_path)
    assert read_png(tmp_path / "sheet.png").shape[1] == 12 + 5 * 352
    assert len(manifest.cells) == len(table(tmp_path))


def test_a_result_that_is_not_whole_counts_as_not_run(tmp_path: Path) -> None:
    manifest = make_batch(tmp_path, 4, clips=2)
    half = tmp_path / CELLS / manifest.cells[1].cell / RESULT
    half.write_text(half.read_text(encoding="utf-8")[:100], encoding="utf-8")
    collect(tmp_path)
    assert table(tmp_path)[1]["state"] == "planned"


@pytest.mark.slow
def test_collecting_again_makes_the_same_files_and_leaves_none_aside(tmp_path: Path) -> None:
    make_batch(tmp_path, 12, clips=4)
    collect(tmp_path)
    names = ("table.csv", "sheet.png")
    before = [(tmp_path / name).read_bytes() for name in names]
    collect(tmp_path)
    assert [(tmp_path / name).read_bytes() for name in names] == before
    assert list(tmp_path.glob(".*")) == []


def test_a_folder_without_a_batch_is_told(tmp_path: Path) -> None:
    with pytest.raises(WrongManifest):
        collect(tmp_path)


def test_a_file_that_cannot_be_replaced_is_told(tmp_path: Path) -> None:
    make_batch(tmp_path, 2, clips=1)
    (tmp_path / "table.csv").mkdir()
    with pytest.raises(FolderGone, match=re.escape("table.csv")):
        collect(tmp_path)
    assert list(tmp_path.glob(".*")) == []


def test_rows_with_other_keys_make_columns_with_gaps() -> None:
    assert columns([{"a": 1}, {"b": 2}, {}, {"a": 3}]) == {
        "a": [1, None, None, 3],
        "b": [None, 2, None, None],
    }


def test_names_are_short_and_never_the_same() -> None:
    here = [os.path.join("lib", *parts) for parts in (("a", "run.bvh"), ("b", "run.bvh"))]
    assert list(short_names(here).values()) == ["a/run.bvh", "b/run.bvh"]
    assert list(short_names([here[0]]).values()) == ["run.bvh"]
    keys = ("pin.Start.up", "pin.Landing.up", "pin.Landing.forward", "gravity")
    assert list(short_keys(keys).values()) == ["Start.up", "Landing.up", "forward", "gravity"]


def test_letters_of_several_alphabets_are_drawn_and_others_are_boxes() -> None:
    def drawn(text: str) -> np.ndarray:
        picture = np.zeros((HIGH, 12 * WIDE, 3), np.uint8)
        write(picture, 0, 0, text, (255, 255, 255), 12 * WIDE)
        return picture

    inked = [drawn(letter).sum() > 0 for letter in LETTERS if not letter.isspace()]
    assert all(inked)
    assert np.array_equal(drawn("走"), drawn(BOX))
    assert not np.array_equal(drawn("ж"), drawn(BOX))
    assert np.array_equal(drawn("e\u0301"), drawn("é"))
    assert np.array_equal(drawn("a" * 13), drawn("a" * 11 + "…"))
