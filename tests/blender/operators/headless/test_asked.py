"""What recipe and options ask of a job, and which clips it takes."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.properties.attached_groups import ensure_groups
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.operators.headless.cli import main
from hangtime.solver.data.recording import BEYOND
from hangtime.solver.worker import service
from hangtime.solver.worker.protocol import Adapted, Request, RequestKind
from hangtime.tests.blender.helpers.jobs import EDIT, FILES, PLAIN, WINDOW, run
from hangtime.tests.helpers.clips import begun_at_rest


@pytest.mark.slow
def test_the_command_line_wins_over_the_recipe(clip: Path, tmp_path: Path) -> None:
    options = ("--mass", "35", "--height", "1.2", "--last", "280")
    assert run(tmp_path, clip, "mass = 90\n" + EDIT + PLAIN, *options) == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["figure"]["mass_kg"] == pytest.approx(35.0)
    assert report["figure"]["height_m"] == pytest.approx(1.2)
    assert report["recording"]["first_frame"] == WINDOW[0]
    assert report["recording"]["last_frame"] == 280.0
    _assert_written_as_the_worker_answers(clip, tmp_path / "out" / "adapted.blend")


def _assert_written_as_the_worker_answers(clip: Path, written: Path) -> None:
    """A stated height scales for the solver alone: the recording's armature keeps its lengths."""
    asked = parse_recipe(EDIT + PLAIN).problem
    problem = replace(asked, frames=(WINDOW[0], 280.0), mass=35.0, height=1.2)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    recording = read_recording(
        import_clip(clip).armature, first=WINDOW[0], last=280.0, beyond=BEYOND
    )
    request = Request(1, RequestKind.ADAPT, recording, problem)
    answer = service.Service().answer(request, lambda _: None)
    assert isinstance(answer, Adapted)
    assert answer.fault is None
    bpy.ops.wm.open_mainfile(filepath=str(written))
    track = answer.track
    first, last = track.frames[[0, -1]]
    shown = read_recording(bpy.data.objects[clip.stem], first=first, last=last)
    bones = [shown.index(bone) for bone in track.bones]
    np.testing.assert_array_equal(shown.frames, track.frames)
    np.testing.assert_allclose(shown.heads[:, bones[0]], track.root_head, atol=1e-5)
    np.testing.assert_allclose(shown.rotations[:, bones], track.rotations, atol=1e-5)


@pytest.mark.slow
def test_a_result_may_be_a_strip_on_top_of_the_take(clip: Path, tmp_path: Path) -> None:
    text = EDIT + '[result]\nwritten_as = "strip"\nafter = "return"\nreturn_frame = 330\n'
    assert run(tmp_path, clip, text, "--no-picture") == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / "adapted.blend"))
    data = bpy.data.objects[clip.stem].animation_data
    assert data.action is None
    below, above = (track.strips[0].action.name for track in data.nla_tracks)
    assert (below, above) == (clip.stem, f"{clip.stem} adapted")
    copy = bpy.data.objects[f"{clip.stem} recording"].animation_data
    assert copy.action.name == clip.stem
    assert not copy.nla_tracks


@pytest.mark.slow
def test_a_take_that_a_strip_plays_later_stays_there(clip: Path, tmp_path: Path) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    data = import_clip(clip).armature.animation_data
    strip = data.nla_tracks.new().strips.new("Mine", 51, data.action)  # 50 frames later
    data.action = None
    bpy.context.scene.frame_end = 500  # for others that are in it
    path = tmp_path / "played.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    text = 'frames = [150, 340]\n[result]\nwritten_as = "combine"\n[keys]\non = "as the take"\n'
    assert strip.frame_start == 51.0
    assert run(tmp_path, path, text, "--no-picture") == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / "adapted.blend"))
    assert (bpy.context.scene.frame_start, bpy.context.scene.frame_end) == (1, 500)
    figure = bpy.data.objects[clip.stem]
    assert len(figure.animation_data.nla_tracks) == 2
    frames = np.array([80.0, 160.0, 240.0, 300.0, 360.0])
    shown = sample(figure, frames).matrices[:, 0, 2, 3]
    copy = sample(bpy.data.objects[f"{clip.stem} recording"], frames).matrices[:, 0, 2, 3]
    recorded = sample(import_clip(clip).armature, frames - 50.0).matrices[:, 0, 2, 3]
    np.testing.assert_allclose(copy, recorded, atol=1e-4)
    np.testing.assert_allclose(shown, recorded, atol=0.05)


@pytest.mark.slow
def test_a_recipe_without_a_request_gives_the_plain_fit(clip: Path, tmp_path: Path, capsys) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    ensure_groups()
    take = current_action(import_clip(clip).armature)
    take.hangtime.spans = "[[60.0, 98.0]]"  # an earlier adaptation, which no blend reaches into
    path = tmp_path / "adapted before.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert run(tmp_path, path, "frames = [110, 260]\n", "--no-picture") == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES - {"sheet.png"}
    said = capsys.readouterr().out
    assert "picture" not in said
    assert "Solved: " in said
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "solved"
    assert max(report["change"].values()) < 1e-3
    assert report["take"]["blend_in_frames"] == 12


@pytest.mark.slow
def test_a_recipe_asks_for_few_keys(clip: Path, tmp_path: Path) -> None:
    keys = '[keys]\non = "reduced"\n'
    options = ("--first", "140", "--last", "330", "--no-picture")
    assert run(tmp_path, clip, keys, *options) == 0
    told = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))["keys"]
    assert told["largest_error_mm"] <= 2.0
    assert told["largest_turn_deg"] <= 0.2
    assert told["keys"] < 0.25 * told["channels"] * 190
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / "adapted.blend"))
    adapted = next(a for a in bpy.data.actions if a.name.endswith("adapted"))
    owner = next(o for o in bpy.data.objects if current_action(o) == adapted)
    keys = [k for curve in fcurves.curves_of(owner) for k in curve.keyframe_points]
    assert sum(key.interpolation == "BEZIER" for key in keys) == told["keys"]


@pytest.mark.slow
def test_a_blend_is_a_clip_too(clip: Path, tmp_path: Path, capsys) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    import_clip(clip)
    path = tmp_path / "recorded.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    capsys.readouterr()
    assert main(["analyze", str(path), "--first", "120"]) == 0
    printed = capsys.readouterr().out
    assert "ground 2" in printed
    assert "Left toe 2" in printed


@pytest.mark.slow
def test_of_a_blend_with_two_characters_the_one_that_is_read_is_named_and_may_be_chosen(
    clip: Path, tmp_path: Path, capsys
) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    first = import_clip(clip).armature
    first.name = "Runner"
    second = import_clip(clip).armature  # which is active then
    second.name = "Jumper"
    path = tmp_path / "two.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    capsys.readouterr()
    assert main(["doctor", str(path)]) == 0
    assert "“Jumper” is read, and not “Runner”" in capsys.readouterr().out
    assert main(["doctor", str(path), "--armature", "Runner"]) == 0
    assert "is read" not in capsys.readouterr().out
    assert main(["doctor", str(path), "--armature", "Nobody"]) == 2
    assert "name one that it has: Jumper, Runner" in capsys.readouterr().err


@pytest.mark.slow
def test_the_starter_recipe_is_valid_and_names_the_landing(
    clip: Path, tmp_path: Path, capsys
) -> None:
    shutil.copy(clip, tmp_path / "jump.bvh")
    target = tmp_path / "recipes" / "jump.toml"
    target.parent.mkdir()
    command = ["analyze", str(tmp_path / "jump.bvh"), "--first", "110", "--last", "260"]
    command += ["--bone", "left foot=LeftFoot", "--write-recipe", str(target)]
    assert main(command) == 0
    recipe = parse_recipe(target.read_text(encoding="utf-8"))
    assert recipe.clip == "../jump.bvh"
    assert recipe.problem.frames == WINDOW
    assert recipe.problem.bones == {"left foot": "LeftFoot"}
    assert [pin.phase for pin in recipe.problem.pins] == ["ground 2"]
    assert main(command) == 2  # what an artist may have changed is not overwritten
    assert "jump.toml" in capsys.readouterr().err


@pytest.mark.slow
def test_a_rest_pose_on_the_first_frame_is_left_out(clip: Path, tmp_path: Path, capsys) -> None:
    target = tmp_path / "jump.toml"
    command = ["analyze", str(begun_at_rest(clip, tmp_path)), "--write-recipe", str(target)]
    assert main(command) == 0
    assert "left out: the first frame, which holds the rest pose" in capsys.readouterr().out
    assert parse_recipe(target.read_text(encoding="utf-8")).problem.frames[0] == 2.0
    assert main([*command[:2], "--first", "1"]) == 0  # frames that are asked for are taken
    assert "left out" not in capsys.readouterr().out
