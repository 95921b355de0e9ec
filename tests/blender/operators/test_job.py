"""The main job without a window, through the command line, in the bpy module."""

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
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.picture.render import draw_sheet
from hangtime.bridge.properties.attached_groups import ensure_groups
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.operators.headless import commands, picture
from hangtime.operators.headless.cli import main
from hangtime.solver.data.recording import BEYOND
from hangtime.solver.worker import service
from hangtime.solver.worker.pipeline import solve
from hangtime.solver.worker.protocol import Adapted, Request, RequestKind
from hangtime.tests.helpers.clips import begun_at_rest, mocap_path
from hangtime.tests.helpers.kept_fits import KeptFits

CLIP = "forward_jump_116cm.bvh"
WINDOW = (110.0, 260.0)
FILES = {
    *("adapted.blend", "adapted.fbx", "sheet.png"),
    *("report.json", "report.txt", "trajectory.npz"),
}
EDIT = """
frames = [110, 260]
[[pin]]
name = "Landing"
phase = "ground 2"
forward = 0.3
up = 0.2
"""

# Physics and pins alone: quicker, and sooner given up.
PLAIN = "[solution]\nsolid = false\nhuman = false\nkeep_times = true\n"


@pytest.fixture(scope="module")
def clip() -> Path:
    return mocap_path(CLIP)


@pytest.fixture(autouse=True, scope="module")
def _quick_jobs(_enabled):
    """A picture as large as the artist's takes half a minute on a slow machine, a fit seconds:
    what is to be fitted is fitted by the first job that needs it, and remembered."""
    fits = KeptFits()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(picture, "draw_sheet", lambda *a: draw_sheet(*a, width=160))
        patch.setattr(commands, "solve", lambda *a: solve(*a, fits))
        patch.setattr(service, "fit_subject", fits)
        yield


@pytest.fixture(scope="module")
def done(clip: Path, tmp_path_factory) -> Path:
    """The folder of a job that went well."""
    folder = tmp_path_factory.mktemp("job")
    recipe = folder / "edit.toml"
    recipe.write_text(EDIT)
    out = folder / "deep" / "out"
    assert main(["adapt", str(clip), "--recipe", str(recipe), "--out", str(out)]) == 0
    return out


def run(tmp_path: Path, clip: Path, recipe: str, *options: str) -> int:
    """The exit code of a job whose results would go to tmp_path / "out"."""
    path = tmp_path / "edit.toml"
    path.write_text(recipe)
    out = ["--out", str(tmp_path / "out")]
    return main(["adapt", str(clip), "--recipe", str(path), *out, *options])


# ---------------------------------------------------------------- a job that goes well


def test_all_files_are_there_and_no_others(done: Path) -> None:
    assert {path.name for path in done.iterdir()} == FILES
    assert all(path.stat().st_size > 500 for path in done.iterdir())


def test_the_report_says_solved(done: Path) -> None:
    report = json.loads((done / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "solved"
    assert report["recording"]["clip"] == "forward_jump_116cm.bvh"
    assert [stage["seconds"] > 0.0 for stage in report["stages"]].count(False) == 0
    landing = [c for c in report["contacts"] if c["pin"] == "Landing"]
    assert len(landing) == 4
    assert max(c["worst_violation_mm"] for c in report["contacts"]) < 1.0


def test_the_blend_holds_both_side_by_side(done: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(done / "adapted.blend"))
    armatures = {o.name: o for o in bpy.data.objects if o.type == "ARMATURE"}
    assert len(armatures) == 2
    (copy,) = (o for name, o in armatures.items() if name.endswith("recording"))
    (figure,) = (o for o in armatures.values() if o is not copy)
    assert figure.animation_data.action.name == "forward_jump_116cm adapted"
    recorded = copy.animation_data.action
    assert recorded.name == "forward_jump_116cm"
    assert recorded.use_fake_user
    assert tuple(recorded.frame_range) == (1.0, 336.0)  # whole, not cut to the recipe's frames
    scene, last = bpy.context.scene, figure.animation_data.action.frame_range[1]
    assert (scene.frame_start, scene.frame_end) == (1.0, pytest.approx(last, abs=1.0))
    assert last > 336.0  # further, so longer, and the rest of the take later


def test_the_report_tells_what_was_done_to_the_take(done: Path) -> None:
    report = json.loads((done / "report.json").read_text(encoding="utf-8"))
    take = report["take"]
    assert take["adapted_frames"][0] == WINDOW[0]
    assert take["blend_in_frames"] == 30
    assert take["carried_with"] == "ground 2"
    assert np.hypot(*take["carried_m"][:2]) == pytest.approx(0.3, abs=1e-6)
    assert take["take_frames"] == [1.0, 336.0 + take["later_frames"]]
    text = (done / "report.txt").read_text(encoding="utf-8")
    assert "  0.300 m along the ground, 0.200 m up\n" in text


def test_pinned_points_stay_where_they_were_sent(done: Path) -> None:
    """By the written keys, as Blender evaluates them, in .blend and FBX alike."""
    report = json.loads((done / "report.json").read_text(encoding="utf-8"))
    bpy.ops.wm.open_mainfile(filepath=str(done / "adapted.blend"))
    first, last = report["take"]["adapted_frames"]
    written = read_recording(bpy.data.objects["forward_jump_116cm"], first=first, last=last)
    exported = reimport(done / "adapted.fbx", written.frames)
    with np.load(done / "trajectory.npz") as trajectory:
        names = list(trajectory["contact_names"])
        for contact in report["contacts"]:
            track = trajectory["contact_point"][:, names.index(contact["point"])]
            for recording in (written, exported):
                bone = recording.index(contact["bone"])
                # Between the 30 ms in which the sole sinks and rises, by up to 8 mm.
                held = (recording.times > contact["start_s"] + 0.03) & (
                    recording.times < contact["end_s"] - 0.03
                )
                if not held.any():
                    continue
                start = np.argmax(held)
                at = track[np.searchsorted(trajectory["time"], recording.times[start])]
                local = recording.rotations[start, bone].T @ (at - recording.heads[start, bone])
                points = recording.heads[held, bone] + recording.rotations[held, bone] @ local
                off = np.linalg.norm(points - np.array(contact["place_m"]), axis=1)
                assert off.max() < 2e-3, contact["name"]


def test_the_recording_is_untouched(done: Path, clip: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(done / "adapted.blend"))
    kept = fcurves.holder(bpy.data.objects["forward_jump_116cm recording"]).fcurves
    keys = {(c.data_path, c.array_index): fcurves.keys(c) for c in kept}
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    fresh = fcurves.holder(import_clip(clip).armature).fcurves
    assert len(keys) == len(fresh)
    for curve in fresh:
        assert np.array_equal(keys[curve.data_path, curve.array_index], fcurves.keys(curve))


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
    path = tmp_path / "played.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    text = 'frames = [150, 340]\n[result]\nwritten_as = "combine"\n[keys]\non = "as the take"\n'
    assert strip.frame_start == 51.0
    assert run(tmp_path, path, text, "--no-picture") == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / "adapted.blend"))
    figure = bpy.data.objects[clip.stem]
    assert len(figure.animation_data.nla_tracks) == 2
    frames = np.array([80.0, 160.0, 240.0, 300.0, 360.0])
    shown = sample(figure, frames).matrices[:, 0, 2, 3]
    copy = sample(bpy.data.objects[f"{clip.stem} recording"], frames).matrices[:, 0, 2, 3]
    recorded = sample(import_clip(clip).armature, frames - 50.0).matrices[:, 0, 2, 3]
    np.testing.assert_allclose(copy, recorded, atol=1e-4)
    np.testing.assert_allclose(shown, recorded, atol=0.05)


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


def test_a_rest_pose_on_the_first_frame_is_left_out(clip: Path, tmp_path: Path, capsys) -> None:
    target = tmp_path / "jump.toml"
    command = ["analyze", str(begun_at_rest(clip, tmp_path)), "--write-recipe", str(target)]
    assert main(command) == 0
    assert "left out: the first frame, which holds the rest pose" in capsys.readouterr().out
    assert parse_recipe(target.read_text(encoding="utf-8")).problem.frames[0] == 2.0
    assert main([*command[:2], "--first", "1"]) == 0  # frames that are asked for are taken
    assert "left out" not in capsys.readouterr().out


# ---------------------------------------------------------------- jobs that do not


def one_line(capsys) -> str:
    """What was said on the standard error: one line, no traceback."""
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "Traceback" not in said
    return said


@pytest.mark.parametrize(
    ("recipe", "line"),
    [
        (EDIT.replace("ground 2", "ground 7"), "line 5"),
        (EDIT + 'points = ["Left nose"]\n', "line 8"),
        (EDIT + "offset = [1, 2, 3]\n", "line 8"),
        (EDIT.replace("forward", "foward"), "line 6"),
        (EDIT + '[bones]\n"left foot" = "Fuss.L"\n', "line 9"),
        (EDIT + '[[contact]]\nname = "Left nose 1"\nremove = true\n', "line 9"),
        (EDIT + '[[pin]]\nphase = "ground 2"\npoints = ["Left toe"]\nup = -0.4\n', "line 8"),
    ],
)
def test_what_is_wrong_in_a_recipe_is_said_with_its_line(
    recipe: str, line: str, clip: Path, tmp_path: Path, capsys
) -> None:
    assert run(tmp_path, clip, recipe) == 2
    assert f"edit.toml, {line}:" in one_line(capsys)
    assert not (tmp_path / "out").exists()


def test_frames_beyond_the_recording_are_too_short(clip: Path, tmp_path: Path, capsys) -> None:
    assert run(tmp_path, clip, "frames = [400, 700]\n") == 2
    assert "0.00 s" in one_line(capsys)


def test_a_truncated_clip_is_said_with_its_line(clip: Path, tmp_path: Path, capsys) -> None:
    short = tmp_path / "short.bvh"
    short.write_bytes(clip.read_bytes()[:20_000])
    assert run(tmp_path, short, EDIT) == 2
    assert "short.bvh, line " in one_line(capsys)
    assert not (tmp_path / "out").exists()


def test_a_clip_that_is_no_clip(tmp_path: Path, capsys) -> None:
    for name in ("none.fbx", "none.blend", "none.txt"):
        assert run(tmp_path, tmp_path / name, EDIT) == 2
        assert name in one_line(capsys)
    (tmp_path / "bad.blend").write_bytes(b"not a blend")
    assert run(tmp_path, tmp_path / "bad.blend", EDIT) == 2
    assert "bad.blend" in one_line(capsys)


@pytest.mark.slow
def test_no_solution_leaves_a_report(clip: Path, tmp_path: Path, capsys) -> None:
    assert run(tmp_path, clip, EDIT.replace("up = 0.2", "up = 8.0") + PLAIN) == 3
    assert "“Landing: " in one_line(capsys)
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written - {"best_found.blend"} == {"report.json", "report.txt"}
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] in ("stalled", "too many steps")


def test_bones_that_a_usd_could_not_tell_apart_are_told_before_the_solve(
    clip: Path, tmp_path: Path, monkeypatch, capsys
) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bones = import_clip(clip).armature.data.bones
    bones["LeftToeBase"].name, bones["RightToeBase"].name = "toe!", "toe?"
    path = tmp_path / "named.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    monkeypatch.setattr(commands, "solve", lambda *_: pytest.fail("it was solved"))
    text = EDIT + '[export]\nformat = "usd"\n[bones]\n"left toe" = "toe!"\n"right toe" = "toe?"\n'
    assert run(tmp_path, path, text) == 2
    assert "would be one name in a USD file" in capsys.readouterr().err


def test_a_wrong_option_is_wrong_input(capsys) -> None:
    assert main(["adapt", "x.bvh", "--recipe", "x.toml", "--mass", "-3"]) == 2
    assert main(["adapt", "x.bvh"]) == 2
    assert main(["fly"]) == 2
    assert "Traceback" not in capsys.readouterr().err
    assert main(["--help"]) == 0


def test_a_job_without_a_clip(tmp_path: Path, capsys) -> None:
    (tmp_path / "edit.toml").write_text(EDIT)
    assert main(["adapt", "--recipe", str(tmp_path / "edit.toml")]) == 2
    assert "no recording" in one_line(capsys)
