"""The doctor on the command line, and recipes that repair what it found."""

import json
import re
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.batch.cells.reading import read_clip
from hangtime.bridge.formats.bvh import read_bvh
from hangtime.bridge.recipe.problem import locate, parse_recipe
from hangtime.bridge.recipe.recording import FileReading
from hangtime.operators.headless.cli import main
from hangtime.operators.headless.clip import Clip, load
from hangtime.operators.terminal.stages import Stages
from hangtime.solver.data.faults import NotBetweenFrames, NothingLeft, OddScale, OutsideKeys
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.doctor.repairs import MissingFrames, Repairs, UpAxis
from hangtime.tests.helpers.clips import (
    begun_at_rest,
    joined_after,
    mocap_path,
    with_frames_repeated,
    without_frames,
)

CLIP = "forward_jump_116cm.bvh"
TOO_LARGE = 0.12  # m a unit, 2.13 times what is right
FRAMES = ("--first", "100", "--last", "290")


def test_what_is_wrong_is_told_with_its_remedy(tmp_path: Path, capsys) -> None:
    clip, recipe = begun_at_rest(mocap_path(CLIP), tmp_path), tmp_path / "mend.toml"
    options = ["--json", "--unit", str(TOO_LARGE), "--write-recipe", str(recipe)]
    assert main(["doctor", str(clip), *options]) == 0
    told = json.loads(capsys.readouterr().out)
    assert [finding["kind"] for finding in told["findings"]] == ["bind pose", "size"]
    assert told["recording"]["trim"] == 1
    repairs = parse_recipe(recipe.read_text(encoding="utf-8")).repairs
    assert repairs is not None
    assert repairs.scale == pytest.approx(0.470, rel=0.03)


def test_a_clean_clip_is_called_so(capsys) -> None:
    assert main(["doctor", str(mocap_path(CLIP)), *FRAMES]) == 0
    guess, said = capsys.readouterr().out.splitlines()
    assert "is 0.05644 m (else say --unit)" in guess
    assert "Y points up (else say --up)" in guess
    assert said == "Nothing is wrong with the recording."


def test_what_is_said_of_the_file_is_not_guessed(capsys) -> None:
    assert main(["doctor", str(mocap_path(CLIP)), *FRAMES, "--unit", "0.0564", "--up", "Y"]) == 0
    assert capsys.readouterr().out == "Nothing is wrong with the recording.\n"


def test_a_recipe_tells_how_a_clip_is_read_that_is_examined_as_recorded(
    tmp_path: Path, capsys
) -> None:
    recipe, mend = tmp_path / "jump.toml", tmp_path / "mend.toml"
    told = f'[bones]\nhead = "Head"\n[file]\nunit = {TOO_LARGE}\nup = "Y"\n'
    recipe.write_text(told + "[recording]\nscale = 0.47\n")
    options = ["--recipe", str(recipe), *FRAMES, "--write-recipe", str(mend)]
    assert main(["doctor", str(mocap_path(CLIP)), *options]) == 0
    said = capsys.readouterr().out
    assert "guessed" not in said
    assert "remedy: scale = 0.47" in said
    written = parse_recipe(mend.read_text(encoding="utf-8"))
    assert written.problem.bones == {"head": "Head"}
    assert written.file == FileReading(unit=TOO_LARGE, up="Y")


@pytest.mark.parametrize("missing", [0, 200])
def test_nothing_falls_while_a_contact_touches_that_the_recipe_states(
    missing: int, tmp_path: Path, capsys
) -> None:
    """Whose frames count with those that the recipe's repairs put in."""
    recipe, clip = tmp_path / "vault.toml", str(mocap_path(CLIP))
    slow = ["doctor", clip, "--rate", "60", "--json"]
    assert main(slow) == 0
    (told,) = json.loads(capsys.readouterr().out)["findings"]
    assert told["kind"] == "time scale"
    first, last = told["frames"][0]
    contact = f"start_frame = {first + missing + 10}\nend_frame = {last + missing - 10}\n"
    repairs = f"[recording]\nmissing = {{ 57 = {missing} }}\n" if missing else ""
    recipe.write_text(f'{repairs}[[add_contact]]\npoint = "Left hand"\n{contact}')
    assert main([*slow, "--recipe", str(recipe)]) == 0
    assert json.loads(capsys.readouterr().out)["findings"] == []


@pytest.mark.slow
def test_more_frames_than_the_file_announces_are_told(tmp_path: Path, capsys) -> None:
    text, clip = mocap_path(CLIP).read_text(), tmp_path / "longer.bvh"
    clip.write_text(re.sub(r"Frames:\s*\d+", "Frames: 300", text))
    assert main(["doctor", str(clip), *FRAMES]) == 0
    assert "announces 300 frames, but 336 lines" in capsys.readouterr().out
    assert main(["analyze", str(clip), *FRAMES, "--rate", "100"]) == 0
    told = capsys.readouterr()
    assert "announces 300 frames, but 336 lines" in told.err
    assert "at 100 frames a second" in told.out


@pytest.mark.slow
@pytest.mark.parametrize("command", ["doctor", "analyze"])
def test_a_recipe_has_what_was_stated(command: str, tmp_path: Path) -> None:
    """Its remedies are of the clip as it was read then: `adapt` guessed another unit."""
    recipe, options = tmp_path / "mend.toml", ["--unit", str(TOO_LARGE), "--up", "y"]
    stated = ["--rate", "100", "--mass", "61.5", "--height", "1.8", "--bone", "left foot=LeftFoot"]
    clip, write = str(mocap_path(CLIP)), ["--write-recipe", str(recipe)]
    assert main([command, clip, *FRAMES, *options, *stated, *write]) == 0
    written = parse_recipe(recipe.read_text(encoding="utf-8"))
    assert written.file == FileReading(TOO_LARGE, "Y", 100.0)
    problem = written.problem
    assert (problem.frames, problem.mass, problem.height) == ((100.0, 290.0), 61.5, 1.8)
    assert problem.bones == {"left foot": "LeftFoot"}


def read_by(recipe: Path, *options: str) -> str:
    """What `analyze` says of the figure."""
    out = StringIO()
    with redirect_stdout(out):
        assert main(["analyze", str(mocap_path(CLIP)), "--recipe", str(recipe), *options]) == 0
    (figure,) = (line for line in out.getvalue().splitlines() if line.startswith("figure"))
    return figure


@pytest.mark.slow
def test_a_clip_is_read_as_its_recipe_says_unless_an_option_does(tmp_path: Path) -> None:
    recipe = tmp_path / "mend.toml"
    file = f"[file]\nunit = {TOO_LARGE}\n"
    recipe.write_text(f"frames = [100, 290]\n{file}[recording]\nscale = 0.47\n")
    assert read_by(recipe) == read_by(recipe, "--unit", str(TOO_LARGE))
    assert read_by(recipe) != read_by(recipe, "--unit", "0.1")
    again = tmp_path / "again.toml"
    read_by(recipe, "--write-recipe", str(again))
    assert read_by(again) == read_by(recipe)


def test_a_key_that_would_go_unheard_is_refused_with_its_line(tmp_path: Path, capsys) -> None:
    recipe = tmp_path / "mend.toml"
    recipe.write_text("[file]\nunit = 0.01\nrate = 60\n")
    assert main(["analyze", "clip.fbx", "--recipe", str(recipe)]) == 2
    assert "line 3: “rate” does not count for clip.fbx" in capsys.readouterr().err


@pytest.mark.parametrize(("option", "value"), [("--rate", "60"), ("--up", "Z"), ("--asf", "a.asf")])
def test_an_option_that_would_go_unheard_is_refused(option, value, capsys) -> None:
    assert main(["analyze", "clip.fbx", option, value]) == 2
    assert f"“{option}” does not count for clip.fbx" in capsys.readouterr().err


@pytest.mark.slow
def test_a_recipe_is_not_overwritten(tmp_path: Path, capsys) -> None:
    recipe = tmp_path / "mine.toml"
    recipe.write_text("mass = 70\n")
    assert main(["doctor", str(mocap_path(CLIP)), *FRAMES, "--write-recipe", str(recipe)]) == 2
    assert recipe.read_text() == "mass = 70\n"
    assert "mine.toml" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(("read_as", "up"), [("Y", UpAxis.Z), ("Z", UpAxis.Y)])
def test_a_repaired_clip_is_read_upright_in_its_true_size_and_time(read_as, up) -> None:
    """2.13 times as large, 0.3 m up, 1.25 times too slow; one lies on its back."""
    problem, told = MotionProblem(frames=(100.0, 290.0)), Stages(StringIO())
    right = load(Clip(mocap_path(CLIP)), problem, told).subject
    repairs = Repairs(up, time_scale=0.8, scale=0.0254 / 0.45 / TOO_LARGE, floor=-0.3)
    mended = load(Clip(mocap_path(CLIP), TOO_LARGE, read_as), problem, told, repairs).subject
    assert mended.height == pytest.approx(right.height, rel=1e-3)
    assert mended.recording.rate == pytest.approx(right.recording.rate / 0.8)
    np.testing.assert_allclose(
        mended.recording.heads[..., 2], right.recording.heads[..., 2] + 0.3, atol=1e-3
    )


@pytest.mark.slow
def test_missing_frames_are_put_in_as_without_blender(tmp_path: Path, capsys) -> None:
    clip, recipe = without_frames(mocap_path(CLIP), 150, 4, tmp_path), tmp_path / "mend.toml"
    assert main(["doctor", str(clip), *FRAMES, "--write-recipe", str(recipe)]) == 0
    assert "remedy: missing = { 150 = 4 }" in capsys.readouterr().out
    repairs = parse_recipe(recipe.read_text(encoding="utf-8")).repairs
    problem = MotionProblem(frames=(100.0, 290.0))
    right = read_clip(mocap_path(CLIP), problem).recording
    plain = read_clip(clip, problem, repairs).recording
    in_blender = load(Clip(clip), problem, Stages(StringIO()), repairs).subject.recording
    for mended in (plain, in_blender.window(*problem.frames)):
        wanted = right.window(*problem.frames)
        np.testing.assert_array_equal(mended.window(*problem.frames).frames, wanted.frames)
        assert np.abs(mended.window(*problem.frames).heads - wanted.heads).max() < 2e-3


@pytest.mark.slow
def test_frames_that_are_too_many_are_taken_out_as_without_blender(tmp_path: Path, capsys) -> None:
    """A jump that is held in the air for 0.3 s: it was told as missing frames and a wrong clock."""
    clip, recipe = with_frames_repeated(mocap_path(CLIP), 195, 36, tmp_path), tmp_path / "m.toml"
    assert main(["doctor", str(clip), "--write-recipe", str(recipe)]) == 0
    assert "remedy: missing = { 195 = -36 }" in capsys.readouterr().out
    repairs = parse_recipe(recipe.read_text(encoding="utf-8")).repairs
    problem = MotionProblem(frames=(100.0, 290.0))
    wanted = read_clip(mocap_path(CLIP), problem).recording.window(*problem.frames)
    plain = read_clip(clip, problem, repairs).recording
    in_blender = load(Clip(clip), problem, Stages(StringIO()), repairs).subject.recording
    for mended in (plain.window(*problem.frames), in_blender.window(*problem.frames)):
        np.testing.assert_array_equal(mended.frames, wanted.frames)
        np.testing.assert_allclose(mended.heads, wanted.heads, atol=1e-4)


def test_frames_after_the_last_one_are_not_put_in_here_either() -> None:
    repairs = Repairs(missing=(MissingFrames(9999, 4),))
    with pytest.raises(NotBetweenFrames):
        load(Clip(mocap_path(CLIP)), MotionProblem(), Stages(StringIO()), repairs)


@pytest.mark.parametrize("frames", [None, (100.0, 290.0)])
def test_a_recording_of_which_nothing_is_left_is_refused_here_and_without_blender(frames) -> None:
    """Where frames are named, too."""
    repairs, problem = Repairs(trim=100_000), MotionProblem(frames=frames)
    with pytest.raises(NothingLeft) as told:
        load(Clip(mocap_path(CLIP)), problem, Stages(StringIO()), repairs)
    with pytest.raises(NothingLeft) as plain:
        read_clip(mocap_path(CLIP), problem, repairs)
    assert told.value == plain.value


@pytest.mark.slow
def test_frames_at_both_ends_are_left_out_as_without_blender(tmp_path: Path) -> None:
    """Those that hold the rest pose are among the first."""
    repairs, problem = Repairs(trim=5, trim_end=30), MotionProblem()
    for clip in (mocap_path(CLIP), begun_at_rest(mocap_path(CLIP), tmp_path)):
        count = len(read_bvh(clip).positions)
        plain = read_clip(clip, problem, repairs)
        here = load(Clip(clip), problem, Stages(StringIO()), repairs)
        for asked, recording in (
            (plain.problem.frames, plain.recording),
            (here.problem.frames, here.subject.recording),
        ):
            ends = asked or (recording.frames[0], recording.frames[-1])
            assert ends == (6.0, count - 30.0)


@pytest.mark.slow
def test_of_the_frames_that_are_named_those_count_that_are_left() -> None:
    """Of the whole clip, 336 frames, so many are left out; they tell nothing of the others."""
    repairs = Repairs(trim=120, trim_end=30)
    for asked, left in [((100.0, 290.0), (121.0, 290.0)), ((150.0, 400.0), (150.0, 306.0))]:
        problem = MotionProblem(frames=asked)
        plain = read_clip(mocap_path(CLIP), problem, repairs)
        here = load(Clip(mocap_path(CLIP)), problem, Stages(StringIO()), repairs)
        assert plain.problem.frames == here.problem.frames == left
        assert plain.recording.frames[0] >= 121.0
        assert plain.recording.frames[-1] <= 306.0
    problem = MotionProblem(frames=(10.0, 100.0))
    with pytest.raises(OutsideKeys, check=lambda fault: (fault.first, fault.last) == (121, 306)):
        read_clip(mocap_path(CLIP), problem, repairs)
    with pytest.raises(OutsideKeys, check=lambda fault: (fault.first, fault.last) == (121, 306)):
        load(Clip(mocap_path(CLIP)), problem, Stages(StringIO()), repairs)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chosen", "remedy", "left"),
    [
        (("--last", "290"), "trim_end = 96", (1.0, 240.0)),
        (("--first", "200"), "trim = 240", (241.0, 336.0)),
    ],
)
def test_what_is_left_out_of_a_range_is_counted_in_the_whole_clip(
    chosen, remedy, left, tmp_path: Path, capsys
) -> None:
    """As a recipe counts it; the leap at frame 240 stayed in."""
    clip, recipe = joined_after(mocap_path(CLIP), 240, 7.0, tmp_path), tmp_path / "mend.toml"
    options = ("--unit", "0.0564", "--write-recipe", str(recipe))
    assert main(["doctor", str(clip), *chosen, *options]) == 0
    assert f"remedy: {remedy}\n" in capsys.readouterr().out
    written = parse_recipe(recipe.read_text(encoding="utf-8"))
    assert written.problem.frames == left
    read = read_clip(clip, MotionProblem(), written.repairs, unit=0.0564).recording
    assert read.ends == left


@pytest.mark.slow
@pytest.mark.parametrize("scale", [0.01, 1000.0])
def test_a_scale_that_makes_nobody_is_refused_here_and_without_blender(scale) -> None:
    repairs, problem = Repairs(scale=scale), MotionProblem(frames=(100.0, 290.0))
    with pytest.raises(OddScale) as told:
        load(Clip(mocap_path(CLIP)), problem, Stages(StringIO()), repairs)
    with pytest.raises(OddScale) as plain:
        read_clip(mocap_path(CLIP), problem, repairs)
    assert told.value.metres == pytest.approx(plain.value.metres, rel=1e-3)
    recipe = "\n".join(["[recording]", "trim = 1", f"scale = {scale}"])
    assert locate(recipe, told.value) == 3


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (("--first", "abc"), "'abc' is not a finite number"),
        (("--unit", "nan"), "'nan' is not a finite number"),
        (("--height", "0.001"), "0.001 is not from 0.3 to 3 m"),
        (("--height", "500"), "500 is not from 0.3 to 3 m"),
    ],
)
def test_an_option_that_cannot_be_is_refused_in_words(option, words, capsys) -> None:
    assert main(["doctor", str(mocap_path(CLIP)), *option]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.slow
def test_gaps_side_by_side_are_filled_as_without_blender() -> None:
    """Each is filled by the poses around both."""
    repairs = Repairs(missing=(MissingFrames(150, 4), MissingFrames(151, 2)))
    problem = MotionProblem(frames=(100.0, 290.0))
    plain = read_clip(mocap_path(CLIP), problem, repairs).recording.window(*problem.frames)
    here = load(Clip(mocap_path(CLIP)), problem, Stages(StringIO()), repairs).subject.recording
    assert np.abs(here.window(*problem.frames).heads - plain.heads).max() < 2e-3
