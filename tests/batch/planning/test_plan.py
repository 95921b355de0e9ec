"""Planning: clips and recipes to cells, what is kept of an earlier plan, and what is refused."""

import errno
import json
import os
import shutil
import sys
from pathlib import Path

import pytest
from hangtime.batch.commands import run
from hangtime.batch.planning.clips import files_meant, find_clips
from hangtime.batch.planning.plan import MOST_CELLS, Asked, Planned, plan
from hangtime.batch.records.faults import FolderTaken, WrongManifest, WrongPlan
from hangtime.batch.records.manifest import MANIFEST, BatchSettings, read_manifest
from hangtime.batch.records.result import CELLS, RESULT, CellResult, State
from hangtime.solver.data.faults import BadRecipe

RECIPE = '[[pin]]\nname = "Landing"\nphase = "ground 2"\nforward = {}\n'


class Library:
    """Clips and a recipe in a folder, and the batch of them."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.out = folder, folder / "out"
        for name in ("a.bvh", "second take/b.bvh", "日本 ü.bvh", "notes.txt"):
            (folder / "clips" / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / "clips" / name).write_text(name, encoding="utf-8")
        self.recipe("[0.1, 0.2]")

    def recipe(self, forward: str) -> None:
        text = RECIPE.format(forward)
        (self.folder / "recipe.toml").write_text(text, encoding="utf-8")

    def plan(self, *clips: str, **settings: object) -> Planned:
        words = [str(self.folder / clip) for clip in clips or ("clips",)]
        asked = BatchSettings(**settings)  # type: ignore[arg-type]
        return plan(Asked(asked, words, [str(self.folder / "recipe.toml")]), self.out)

    def table(self, name: str, text: str, check: bool = False) -> Planned:
        (self.folder / name).write_text(text, encoding="utf-8")
        return plan(Asked(BatchSettings(check=check), table=self.folder / name), self.out)

    def solve(self, planned: Planned) -> None:
        """A result for every cell."""
        for cell in planned.manifest.cells:
            folder = self.out / CELLS / cell.cell
            folder.mkdir(parents=True, exist_ok=True)
            result = CellResult(cell.cell, State.DONE, "", "", "")
            (folder / RESULT).write_text(result.as_json())


@pytest.fixture
def library(tmp_path: Path) -> Library:
    return Library(tmp_path)


def test_every_clip_of_a_folder_goes_with_every_value(library: Library) -> None:
    cells = library.plan().manifest.cells
    assert [Path(c.clip).name for c in cells[::2]] == ["a.bvh", "b.bvh", "日本 ü.bvh"]
    assert [c.values["pin.Landing.forward"] for c in cells] == [0.1, 0.2] * 3
    assert read_manifest(library.out).cells == cells


def test_files_folders_and_patterns_mean_each_clip_once(library: Library) -> None:
    clips = library.folder / "clips"
    words = [str(clips / "a.bvh"), str(clips), str(clips / "**" / "*.bvh")]
    assert len(find_clips(words, library.out)) == 3


def test_a_folder_that_cannot_be_read_refuses_the_batch(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its clips would be missing, and the batch would end well. Tests may run as root, who can
    read all."""
    locked, scan = library.folder / "clips" / "second take", os.scandir

    def refusing(path: str) -> object:
        if Path(path) == locked:
            raise PermissionError(errno.EACCES, "Permission denied", path)
        return scan(path)

    monkeypatch.setattr(os, "scandir", refusing)
    with pytest.raises(WrongPlan, match=r"clips.second take cannot be read \(Permission denied\)"):
        library.plan()
    with pytest.raises(WrongPlan, match=r"second take cannot be read"):
        find_clips([str(library.folder / "clips" / "**" / "*.bvh")], library.out)
    assert not library.out.exists()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows tells no such file")
def test_a_name_that_is_too_long_and_a_pipe_are_told_and_not_read(library: Library) -> None:
    with pytest.raises(WrongPlan, match=r"cannot be read \(File name too long\)"):
        find_clips([f"{'x' * 300}.bvh"], library.out)
    pipe = library.folder / "pipe.bvh"
    os.mkfifo(pipe)
    with pytest.raises(WrongPlan, match=r"pipe.bvh is a pipe or a device"):
        find_clips([str(pipe)], library.out)


needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links need rights on Windows")


@needs_links
@pytest.mark.parametrize("word", ["clips", "clips/**/*.bvh", "cl*/**/*.bvh"])
def test_folders_behind_links_are_searched_once_and_links_in_a_circle_end(
    library: Library, word: str
) -> None:
    other, clips = library.folder / "archive", library.folder / "clips"
    other.mkdir()
    (other / "c.bvh").write_text("c")
    (clips / "session").symlink_to(other)
    (other / "back").symlink_to(clips)
    (clips / "again").symlink_to(clips)
    cells = library.plan(word).manifest.cells
    assert {Path(c.clip).name for c in cells} == {"a.bvh", "b.bvh", "c.bvh", "日本 ü.bvh"}
    assert len(cells) == 8


@needs_links
@pytest.mark.parametrize("name", ["k.bvh", "session"])
@pytest.mark.parametrize("word", ["clips", "clips/**/*.bvh", "clips/*"])
def test_a_link_to_nothing_refuses_the_batch_by_its_name(
    library: Library, word: str, name: str
) -> None:
    (library.folder / "clips" / name).symlink_to(library.folder / "lost")
    with pytest.raises(WrongPlan, match=rf"clips.{name} is a link to .*lost, which is not there"):
        library.plan(word)
    assert not library.out.exists()


@pytest.mark.parametrize("word", ["clips", "clips/**/*.bvh", "clips/**"])
def test_hidden_files_of_a_folder_are_no_clips(library: Library, word: str) -> None:
    for name in ("._a.bvh", ".trash/z.bvh"):
        (library.folder / "clips" / name).parent.mkdir(exist_ok=True)
        (library.folder / "clips" / name).write_text("")
    assert len(library.plan(word).manifest.cells) == 6
    assert len(library.plan("clips", "clips/._a.bvh").manifest.cells) == 8  # named itself


def test_a_pattern_means_what_lies_in_folders_of_its_names(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(library.folder)
    for word, count in (("**/second*/*.bvh", 1), ("**/clips/**/b.*", 1), ("clips/*/**/a.bvh", 0)):
        assert len(list(files_meant(word, [".bvh"], library.out))) == count


def test_a_plan_tells_how_many_clips_and_recipes_it_has(
    library: Library, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [str(library.folder / "clips"), "--out", str(library.out)]
    assert run(["plan", *words, "--recipes", str(library.folder / "recipe.toml")]) == 0
    assert "6 cells: 3 clips, 1 recipe.\n" in capsys.readouterr().out
    assert run(["plan", *words, "--check"]) == 0
    assert "3 cells: 3 clips.\n" in capsys.readouterr().out


def test_a_batchs_own_results_are_neither_its_clips_nor_its_recipes(library: Library) -> None:
    words = [str(library.folder)]
    first = plan(Asked(BatchSettings(), words, words), library.out)
    library.solve(first)  # a result.json in each cell's folder
    (library.out / "cells" / first.manifest.cells[0].cell / "motion.bvh").write_text("a result")
    again = plan(Asked(BatchSettings(), words, words), library.out)
    assert [c.cell for c in again.manifest.cells] == [c.cell for c in first.manifest.cells]


def test_planned_again_what_is_solved_keeps_its_name_and_state(library: Library) -> None:
    first = library.plan("clips/a.bvh")
    library.solve(first)
    library.recipe("[0.3, 0.2, 0.1]")  # one is new, and the others' order changed
    again = library.plan().manifest.cells
    names = {c.values["pin.Landing.forward"]: c for c in again if c.clip.endswith("a.bvh")}
    assert [names[v].cell for v in (0.1, 0.2)] == [c.cell for c in first.manifest.cells]
    assert [c.state for c in again].count(State.DONE) == 2
    assert len({c.cell.partition("-")[0] for c in again}) == 9


def test_a_changed_recipe_or_clip_redoes_its_own_cells_and_a_comment_none(
    library: Library,
) -> None:
    library.solve(library.plan())
    path = library.folder / "recipe.toml"
    path.write_text(f"# a comment\n{path.read_text()}")
    assert all(c.state is State.DONE for c in library.plan().manifest.cells)
    (library.folder / "clips" / "a.bvh").write_text("another take")
    planned = library.plan()
    redone = [c for c in planned.manifest.cells if c.state is State.PLANNED]
    assert {Path(c.clip).name for c in redone} == {"a.bvh"}
    assert len(planned.strays) == 2
    path.write_text(path.read_text() + "up = 0.1\n")
    assert all(c.state is State.PLANNED for c in library.plan().manifest.cells)


def test_a_mesh_that_a_recipe_names_counts_as_part_of_it(library: Library) -> None:
    mesh = library.folder / "box.obj"
    shutil.copy(Path(__file__).parents[3] / "examples" / "world" / "crate.obj", mesh)
    path = library.folder / "recipe.toml"
    path.write_text(f'{path.read_text()}[[object]]\nfile = "box.obj"\nplace = [0, 0, 0]\n')
    library.solve(library.plan())
    mesh.write_text(mesh.read_text() + "# changed\n")
    assert all(c.state is State.PLANNED for c in library.plan().manifest.cells)


def test_samples_are_the_same_points_for_every_clip(library: Library) -> None:
    drawn = "{ from = 0, to = 1 }\n[batch]\ncombine = 'sample'\ncount = 3"
    library.recipe(drawn)
    values = [c.values["pin.Landing.forward"] for c in library.plan().manifest.cells]
    assert values == values[:3] * 3
    assert len(set(values)) == 3


def test_a_table_names_the_pairs_and_gives_values_in_place_of_the_ranges(library: Library) -> None:
    text = "clip,recipe,pin.Landing.forward,pin.Landing.up\nclips/a.bvh,recipe.toml,0.5,0.1\n"
    planned = library.table("pairs.csv", text + '"clips/日本 ü.bvh",recipe.toml,,0.2\n')
    assert [dict(c.values) for c in planned.manifest.cells] == [
        {"pin.Landing.forward": 0.5, "pin.Landing.up": 0.1},
        {"pin.Landing.up": 0.2, "pin.Landing.forward": 0.1},
        {"pin.Landing.up": 0.2, "pin.Landing.forward": 0.2},
    ]
    rows = '[[pair]]\nclip = "clips/a.bvh"\nrecipe = "recipe.toml"\n"pin.Landing.forward" = 0.5\n'
    assert len(library.table("pairs.toml", rows).manifest.cells) == 1


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("t.csv", "", "begin with a line of column names"),
        ("t.csv", "clip;recipe\nclips/a.bvh;recipe.toml\n", "commas between"),
        ("t.csv", "clip,recipe\n", "no rows"),
        ("t.csv", "clip,recipe\nclips/a.bvh\n", "number of columns"),
        ("t.csv", "clip,recipe\nclips/none.bvh,recipe.toml\n", "line 2: there is no clip"),
        ("t.csv", "clip,recipe\nclips/a.bvh,\n", "line 2 has no recipe"),
        ("t.csv", "clip,recipe,pin.Take.up\nclips/a.bvh,recipe.toml,1\n", "no “pin.Take.up”"),
        (
            "t.csv",
            "clip,recipe,pin.Landing.up\nclips/a.bvh,recipe.toml,high\n",
            'table\'s pin.Landing.up = high: "up" must be a number, not "high"; correct the table',
        ),
        ("t.csv", f"clip\n{'x' * 200_000}\n", "line 2 cannot be read"),
        ("t.toml", "pair = 1", "must hold"),
        ("t.toml", "[[pair", "not TOML"),
    ],
)
def test_a_table_that_is_none_is_refused(library: Library, name: str, text: str, said: str) -> None:
    with pytest.raises(WrongPlan, match=said):
        library.table(name, text)
    assert not library.out.exists()


def test_pairs_that_are_the_same_are_done_once(library: Library) -> None:
    row = "clips/a.bvh,recipe.toml\n"
    planned = library.table("pairs.csv", f"clip,recipe\n{row}{row}")
    assert (len(planned.manifest.cells), planned.twice) == (2, 2)


def test_a_wrong_recipe_is_told_before_anything_is_written(library: Library) -> None:
    library.recipe('["a", "b"]')
    with pytest.raises(BadRecipe) as caught:
        library.plan()
    assert caught.value.line == 4
    assert not library.out.exists()


def test_more_cells_than_a_batch_holds_are_refused_before_they_are_made(library: Library) -> None:
    library.recipe("{ from = 0, to = 1, steps = 100_000 }")
    with pytest.raises(WrongPlan, match=f"300,000 cells.*{MOST_CELLS:,}"):
        library.plan()


def test_a_folder_with_another_batch_is_refused_and_its_manifest_stays(library: Library) -> None:
    library.plan("clips/a.bvh")
    before = (library.out / MANIFEST).read_text(encoding="utf-8")
    with pytest.raises(FolderTaken, match="another batch"):
        library.plan("clips/second take")
    assert (library.out / MANIFEST).read_text(encoding="utf-8") == before


def test_a_library_that_moved_goes_on_with_its_batch(library: Library) -> None:
    library.solve(library.plan())
    (library.folder / "clips").rename(library.folder / "moved")
    assert all(c.state is State.DONE for c in library.plan("moved").manifest.cells)


def test_an_edited_manifest_is_written_anew_and_what_is_solved_kept(library: Library) -> None:
    library.solve(library.plan())
    path = library.out / MANIFEST
    path.write_text(path.read_text(encoding="utf-8").replace(": 0.1}", ": 0.7}"), encoding="utf-8")
    assert all(c.state is State.DONE for c in library.plan().manifest.cells)
    first, *rest = path.read_text(encoding="utf-8").splitlines()
    other = json.dumps({**json.loads(first), "version": "9.9"})
    path.write_text("\n".join([other, *rest]), encoding="utf-8")
    with pytest.raises(WrongManifest, match=r"9\.9"):
        library.plan()


def test_without_a_recipe_clips_can_only_be_checked(library: Library) -> None:
    clips = [str(library.folder / "clips")]
    with pytest.raises(WrongPlan, match="No recipe"):
        plan(Asked(BatchSettings(), clips), library.out)
    planned = plan(Asked(BatchSettings(check=True), clips), library.out)
    assert [c.recipe for c in planned.manifest.cells] == [""] * 3
