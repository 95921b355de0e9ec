"""The main job without a window, through the command line: its files and what they hold."""

import json
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.incremental import Incremental
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.constraints import standing
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.files.reimport import reimport
from hangtime.operators.headless.cli import main
from hangtime.solver.data.reports.keys import MissedContact
from hangtime.tests.blender.helpers.jobs import EDIT, FILES, WINDOW


@pytest.fixture(scope="module")
def done(clip: Path, tmp_path_factory) -> Path:
    """The folder of a job that went well."""
    folder = tmp_path_factory.mktemp("job")
    recipe = folder / "edit.toml"
    recipe.write_text(EDIT)
    out = folder / "deep" / "out"
    assert main(["adapt", str(clip), "--recipe", str(recipe), "--out", str(out)]) == 0
    return out


@pytest.mark.slow
def test_all_files_are_there_and_no_others(done: Path) -> None:
    assert {path.name for path in done.iterdir()} == FILES
    assert all(path.stat().st_size > 500 for path in done.iterdir())


@pytest.mark.slow
def test_the_report_says_solved(done: Path) -> None:
    report = json.loads((done / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "solved"
    assert report["recording"]["clip"] == "forward_jump_116cm.bvh"
    assert [stage["seconds"] > 0.0 for stage in report["stages"]].count(False) == 0
    assert report["missed_contacts"] == []
    landing = [c for c in report["contacts"] if c["pin"] == "Landing"]
    assert len(landing) == 4
    assert max(c["worst_violation_mm"] for c in report["contacts"]) < 1.0


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
def test_keys_that_miss_what_was_solved_are_told_first(
    clip: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    """As something may that poses bones beside their keys."""
    missed = MissedContact("Left toe 2", 9.0, 243.0)
    monkeypatch.setattr(standing, "missed_contacts", lambda *_: sliced((missed,)))
    recipe, out = tmp_path / "edit.toml", tmp_path / "out"
    recipe.write_text(EDIT)
    assert main(["adapt", str(clip), "--recipe", str(recipe), "--out", str(out)]) == 0
    told = "The keys do not show what was solved: Left toe 2 is up to 9.0 mm off (frame 243). "
    assert (out / "report.txt").read_text(encoding="utf-8").startswith(told)
    assert f"\n{told}" in capsys.readouterr().out.split("Solved")[0]
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    expected = {"name": "Left toe 2", "mm": 9.0, "frame": 243.0, "scaled": []}
    assert report["missed_contacts"] == [expected]


def sliced(found: tuple[MissedContact, ...]) -> Incremental[tuple[MissedContact, ...]]:
    """Slices that find this."""
    yield
    return found
