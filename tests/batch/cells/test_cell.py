"""Cells that are truly solved: one short hop, whose fit the tests of this file share."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hangtime.batch.cells import work
from hangtime.batch.cells.cell import run_cell
from hangtime.batch.cells.fits import FILE, SharedFits
from hangtime.batch.cells.reading import ReadClip, read_clip
from hangtime.batch.cells.work import Done, cell_files
from hangtime.batch.commands import run
from hangtime.batch.planning import blender_need
from hangtime.batch.planning.plan import Asked, plan
from hangtime.batch.records.faults import FolderGone, WrongPlan
from hangtime.batch.records.manifest import BatchSettings, CellPlan, Output, read_manifest
from hangtime.batch.records.result import (
    CELLS,
    FITS,
    CellResult,
    State,
    cell_folder,
    read_result,
)
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.formats.bvh_writer import write_bvh
from hangtime.solver.data.faults import OutputNotWritable
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.worker.unpickling import Unreadable, unpickled
from hangtime.tests.helpers.clips import joined_after, mocap_path
from hangtime.tests.helpers.leaned import leaned

RECIPE = """
frames = [20, 190]
[[pin]]
name = "Landing"
phase = "{}"
forward = {}
"""
TRAJECTORY = "trajectory.npz"


@pytest.fixture(scope="module")
def batch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch of a short hop with two landings, and one on a phase that is not there."""
    folder = tmp_path_factory.mktemp("library ü")
    (folder / "hop 1.bvh").write_bytes(mocap_path("hop_01_01.bvh").read_bytes())
    (folder / "further.toml").write_text(RECIPE.format("ground 2", "[0.05, 0.1]"))
    (folder / "wrong.toml").write_text(RECIPE.format("ground 7", "0.1"))
    settings = BatchSettings((Output.NPZ, Output.BVH))
    recipes = [str(folder / name) for name in ("further.toml", "wrong.toml")]
    plan(Asked(settings, [str(folder / "hop 1.bvh")], recipes), folder / "out")
    return folder / "out"


def cells(batch: Path) -> tuple[CellPlan, ...]:
    return read_manifest(batch).cells


@pytest.mark.slow
def test_a_cell_leaves_what_was_asked_for_in_a_folder_of_its_own(batch: Path) -> None:
    cell = cells(batch)[0].cell
    result = run_cell(batch, cell)
    assert (result.state, result.exit_code, result.sentence) == (State.DONE, 0, "")
    assert result.headline[0].startswith("Solved")
    assert result.values == {"pin.Landing.forward": 0.05}
    assert result.seconds["fit"] > 0.0
    assert result.seconds["total"] > result.seconds["solve"] > 0.0
    wanted = {"log.txt", "report.json", "report.txt", TRAJECTORY, "motion.bvh"}
    assert set(result.files) == wanted
    assert {p.name for p in cell_folder(batch, cell).iterdir()} == {*wanted, "result.json"}
    assert read_result(batch, cell) == result
    assert all(name == name.lower() for name in result.figures)
    counts = {"certificate_failed", "certificate_worse_than_recorded"}  # may be the same
    others = [value for name, value in result.figures.items() if name not in counts]
    assert len(set(others)) == len(others)  # nothing is told twice
    assert_certificate(result, json.loads((cell_folder(batch, cell) / "report.json").read_text()))


def assert_certificate(result: CellResult, report: dict[str, Any]) -> None:
    """What a program filters by is as the report's lines have it."""
    lines, figures = report["certificate"], result.figures
    worst = max(line["value"] / line["limit"] for line in lines)
    assert figures["certificate_worst_times_limit"] == pytest.approx(worst)
    failed = [line for line in lines if not line["holds"]]
    assert figures["certificate_failed"] == len(failed)
    alike = [
        line for line in failed if line["limit"] < line.get("recorded", 0) >= line["value"] / 1.05
    ]
    assert figures["certificate_worse_than_recorded"] == len(failed) - len(alike)


@pytest.mark.slow
def test_a_cell_that_is_solved_is_not_solved_again(batch: Path) -> None:
    cell = cells(batch)[0].cell
    first = run_cell(batch, cell)
    written = (cell_folder(batch, cell) / TRAJECTORY).stat().st_mtime_ns
    assert run_cell(batch, cell) == first
    assert (cell_folder(batch, cell) / TRAJECTORY).stat().st_mtime_ns == written


@pytest.mark.slow
def test_cells_of_a_clip_share_its_fit_and_find_it_as_it_was_to_the_bit(
    batch: Path, tmp_path: Path
) -> None:
    first, second = (cell.cell for cell in cells(batch)[:2])
    run_cell(batch, first)
    shared = run_cell(batch, second)
    kept = [p for p in (batch / FITS).iterdir() if not p.name.startswith(".")]
    assert len(kept) == 1
    assert shared.seconds["fit"] < 0.1
    other = tmp_path / "out"
    clips, recipes = {c.clip for c in cells(batch)}, [cells(batch)[1].recipe]
    plan(Asked(BatchSettings((Output.NPZ,)), list(clips), recipes), other)
    alone = [c.cell for c in cells(other) if c.values == {"pin.Landing.forward": 0.1}]
    run_cell(other, alone[0])
    one = np.load(cell_folder(batch, second) / TRAJECTORY)
    two = np.load(cell_folder(other, alone[0]) / TRAJECTORY)
    assert all(np.array_equal(one[k], two[k], equal_nan=one[k].dtype.kind == "f") for k in one)


@pytest.mark.slow
def test_a_clip_is_analysed_once_wherever_copies_of_it_lie(
    batch: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reads = []

    def read(*args: Any, **kwargs: Any) -> ReadClip:
        reads.append(args)
        return read_clip(*args, **kwargs)

    monkeypatch.setattr(work, "read_clip", read)
    run_cell(batch, cells(batch)[0].cell)
    clip, fits = Path(cells(batch)[0].clip), SharedFits(batch)
    for name in ("one", "two"):  # as cells are sent to workers that do not share the folder
        copy = tmp_path / name / clip.name
        copy.parent.mkdir()
        copy.write_bytes(clip.read_bytes())
        (copy.parent / "r.toml").write_text(RECIPE.format("ground 2", "0.1"))
        asked = Asked(BatchSettings(), [str(copy)], [str(copy.parent / "r.toml")])
        cell = plan(asked, copy.parent / "out").manifest.cells[0]
        assert run_cell(copy.parent / "out", cell.cell, fits).state is State.DONE
    assert len([args for args in reads if args[0].is_relative_to(tmp_path)]) == 1


@pytest.mark.slow
def test_a_fit_that_is_damaged_or_names_a_program_is_none(batch: Path) -> None:
    def read(content: bytes) -> str:
        with pytest.raises(Unreadable) as caught:
            unpickled(content)
        return str(caught.value)

    run_cell(batch, cells(batch)[0].cell)
    fit = next((batch / FITS).glob(f"[!.]*/{FILE}")).read_bytes()
    assert isinstance(unpickled(fit), Fit)
    assert read(fit[: len(fit) // 2])
    assert "os.getcwd is not expected" in read(b"cos\ngetcwd\n(tR.")
    imported = b"changtime.solver.worker.main\nThread\n(tR."  # by the solver, and not its own
    assert "Thread is not expected" in read(imported)


@pytest.mark.slow
def test_the_bvh_plays_the_adapted_motion_on_the_clips_own_skeleton(batch: Path) -> None:
    cell = cells(batch)[1]
    run_cell(batch, cell.cell)
    made = read_bvh(cell_folder(batch, cell.cell) / "motion.bvh")
    clip = read_bvh(Path(cell.clip))
    assert {j.name for j in made.joints} == {j.name for j in clip.joints}
    assert made.frame_time == pytest.approx(clip.frame_time, rel=1e-6)
    unit = 0.0254 / 0.45
    ends = made.positions[[0, -1], 0] * unit
    recorded = clip.positions[[19, 189], 0] * unit
    moved = np.linalg.norm(ends - recorded, axis=1)
    assert moved[0] < 0.05
    assert 0.06 < moved[1] < 0.14  # it landed 0.1 m further


def test_wrong_input_is_told_with_the_recipes_line_and_its_folder_is_whole(batch: Path) -> None:
    cell = cells(batch)[2]
    result = run_cell(batch, cell.cell)
    assert (result.state, result.exit_code) == (State.WRONG_INPUT, 2)
    assert "wrong.toml, line 5" in result.sentence
    assert "“ground 7”" in result.sentence
    assert result.sentence in (cell_folder(batch, cell.cell) / "log.txt").read_text()


def test_every_file_that_a_cell_reads_is_told(batch: Path) -> None:
    cell = cells(batch)[0]
    assert cell_files(cell) == (Path(cell.clip), Path(cell.recipe))


@pytest.mark.parametrize("lost", [False, True])
@pytest.mark.parametrize("which", ["clip", "recipe"])
def test_what_changed_or_went_since_it_was_planned_is_not_solved_and_may_come_back(
    tmp_path: Path, which: str, lost: bool
) -> None:
    clip, recipe = tmp_path / "hop.bvh", tmp_path / "recipe.toml"
    clip.write_bytes(mocap_path("hop_01_01.bvh").read_bytes())
    recipe.write_text(RECIPE.format("ground 2", "[0.1]"))
    folder = tmp_path / "out"
    plan(Asked(BatchSettings(), [str(clip)], [str(recipe)]), folder)
    changed = clip if which == "clip" else recipe
    if lost:
        changed.unlink()
    else:
        changed.write_text(changed.read_text() + ("\n" if which == "clip" else "up = 0.1\n"))
    result = run_cell(folder, cells(folder)[0].cell)
    assert result.state is State.FAILED  # which the same command tries again
    assert f"{changed} has changed since" in result.sentence


def test_half_a_clip_is_not_taken_for_the_clips_end(tmp_path: Path) -> None:
    clip = tmp_path / "hop.bvh"
    clip.write_bytes(mocap_path("hop_01_01.bvh").read_bytes())
    plan(Asked(BatchSettings(check=True), [str(clip)]), tmp_path / "out")
    clip.write_bytes(clip.read_bytes()[:2000])
    result = run_cell(tmp_path / "out", cells(tmp_path / "out")[0].cell)
    assert result.state is State.FAILED
    assert "changed" in result.sentence


def test_without_blender_a_clip_that_needs_it_is_told_and_keeps_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "hop.fbx").write_text("")
    plan(Asked(BatchSettings(check=True), [str(tmp_path / "hop.fbx")]), tmp_path / "out")
    monkeypatch.setattr(blender_need, "find_spec", lambda _: None)
    cell = cells(tmp_path / "out")[0].cell
    with pytest.raises(WrongPlan, match=r"hop\.fbx .* needs Blender"):
        run_cell(tmp_path / "out", cell)
    assert read_result(tmp_path / "out", cell) is None


def test_without_blender_a_clip_that_needs_it_is_told_before_others_are_solved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "z.fbx").write_text("")
    monkeypatch.setattr(blender_need, "find_spec", lambda _: None)
    clips = [str(mocap_path("hop_01_01.bvh")), str(tmp_path / "z.fbx")]
    assert run([*clips, "--check", "--out", str(tmp_path / "out"), "--jobs", "1"]) == 2
    assert "z.fbx or an output that was asked for needs Blender" in capsys.readouterr().err
    assert not (tmp_path / "out" / CELLS).exists()


def test_a_full_disk_is_told_with_what_to_do(tmp_path: Path) -> None:
    clip = str(mocap_path("hop_01_01.bvh"))
    plan(Asked(BatchSettings(check=True), [clip]), tmp_path / "out")

    def fill(*_: object) -> Done:
        raise OutputNotWritable("trajectory.npz", "No space left on device")

    said = r"trajectory\.npz cannot be used \(No space left on device\); make room .* goes on where"
    with pytest.raises(FolderGone, match=said):
        run_cell(tmp_path / "out", cells(tmp_path / "out")[0].cell, work=fill)


@pytest.mark.slow
def test_the_command_line_runs_a_batch_and_goes_on_with_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recipe, clip = tmp_path / "recipe.toml", str(mocap_path("hop_01_01.bvh"))
    recipe.write_text(RECIPE.format("ground 2", "[0.1]"))
    command = [clip, "--recipes", str(recipe), "--out", str(tmp_path / "out"), "--jobs", "1"]
    assert run(command) == 0
    assert "1 cell: 1 done" in capsys.readouterr().out
    recipe.write_text(RECIPE.format("ground 7", "[0.1]"))
    assert run(command) == 2
    told = capsys.readouterr().out
    assert "wrong input: 00002 hop_01_01.bvh + recipe.toml" in told
    assert "of an earlier plan" in told
    assert run([*command, "--check"]) == 0
    results = [read_result(tmp_path / "out", c.cell) for c in cells(tmp_path / "out")]
    assert [r.figures["findings"] for r in results if r is not None] == [0.0]
    assert len(list((tmp_path / "out" / CELLS).iterdir())) == 3


@pytest.mark.slow
def test_what_a_check_leaves_out_is_counted_in_the_whole_clip(tmp_path: Path) -> None:
    recipe, clip = tmp_path / "recipe.toml", mocap_path("hop_01_01.bvh")
    recipe.write_text("frames = [60, 190]\n")
    clip = joined_after(clip, 90, 7.0, tmp_path)
    plan(Asked(BatchSettings(check=True), [str(clip)], [str(recipe)]), tmp_path / "out")
    cell = cells(tmp_path / "out")[0].cell
    run_cell(tmp_path / "out", cell)
    told = (cell_folder(tmp_path / "out", cell) / work.DIAGNOSIS).read_text(encoding="utf-8")
    assert "remedy: trim = 90\n" in told


@pytest.mark.slow
def test_a_check_that_is_refused_what_carries_unseen_tells_what_it_found(tmp_path: Path) -> None:
    recipe, clip = tmp_path / "recipe.toml", tmp_path / "leaned.bvh"
    recipe.write_text('unseen_support = "refuse"\n')
    write_bvh(leaned(20.0), clip, 1.0, "Z")
    plan(Asked(BatchSettings(check=True), [str(clip)], [str(recipe)]), tmp_path / "out")
    result = run_cell(tmp_path / "out", cells(tmp_path / "out")[0].cell)
    assert result.state is State.WRONG_INPUT
    assert "which the recipe refuses" in result.sentence
    assert result.headline
    assert result.figures["fit_joint_centres_rms_cm"] < 1.0


@pytest.mark.slow
def test_clips_are_read_as_the_recipe_says_unless_the_command_does(tmp_path: Path) -> None:
    recipe, clip = tmp_path / "recipe.toml", str(mocap_path("hop_01_01.bvh"))
    recipe.write_text("frames = [20, 190]\n[file]\nunit = 0.12\n")
    for unit, found in ((None, 1.0), (0.0254 / 0.45, 0.0)):
        out = tmp_path / f"out {unit}"
        plan(Asked(BatchSettings(check=True, unit=unit), [clip], [str(recipe)]), out)
        assert run_cell(out, cells(out)[0].cell).figures["findings"] == found


def test_a_skeleton_in_a_recipe_is_refused(tmp_path: Path, capsys) -> None:
    """Every clip of a batch has its own."""
    recipe = tmp_path / "recipe.toml"
    recipe.write_text('[file]\nasf = "01.asf"\n')
    clip = str(mocap_path("hop_01_01.bvh"))
    assert run([clip, "--recipes", str(recipe), "--out", str(tmp_path / "out")]) == 2
    assert "line 2: " in (said := capsys.readouterr().err)
    assert "put the skeleton beside" in said


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing.bvh", "--recipes", "r.toml", "--out", "o"], "No recipe"),
        (["cell", "nowhere", "00001-ab"], "There is no"),
        (["a.bvh", "--out", "o", "--outputs", "xyz"], "unknown output"),
        (["a.bvh", "--out", "o", "--outputs", "npz", "fbx"], "write --outputs npz,fbx"),
        (["a.bvh", "--out", "o", "--outputs", "npz,", "fbx"], "write --outputs npz,fbx"),
        (["a.bvh", "--out", "o", "else"], "unrecognized arguments: else"),
        (["a.bvh", "--out", "o", "--jobs", "0"], "1 or more"),
        (["job", "flamenco", "o", "--cells-per-task", "0"], "1 or more"),
        (["a.bvh", "--out", "o", "--unit", "cm"], "'cm' is no number"),
        (["a.bvh"], "--out"),
    ],
)
def test_wrong_commands_end_with_2_and_a_sentence(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    assert said in capsys.readouterr().err
