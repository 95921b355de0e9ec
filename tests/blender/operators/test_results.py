"""What becomes of an adapted motion: fit, compare, accept, discard, report, export, best so far."""

from __future__ import annotations

from math import ceil
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.fcurves import curves_of
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_adapted_incrementally
from hangtime.operators.solve.common import BUSY
from hangtime.operators.solve.results import result_of
from hangtime.operators.solve.session import session
from hangtime.operators.solve.solving import Solving
from hangtime.operators.words.warning_text import NOT_MET
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import JUMP, JUMP_FRAMES, mocap_path

pytestmark = pytest.mark.usefixtures("_enabled")


def test_the_parts_of_the_body_are_listed_with_what_is_missing() -> None:
    rigs.reset()
    armature = import_clip(mocap_path(JUMP)).armature
    without(armature, "LeftFoot", "LeftToeBase")
    with pytest.raises(RuntimeError, match="left foot"):
        bpy.ops.hangtime.analyze()
    parts = armature.hangtime.parts
    assert [p.name for p in parts if p.needed and not p.bone] == ["left foot"]
    assert parts["right foot"].bone == "RightFoot"


@pytest.mark.slow
def test_a_foot_of_any_name_is_found_by_its_place() -> None:
    rigs.reset()
    armature = import_clip(mocap_path(JUMP)).armature
    armature.data.bones["LeftFoot"].name = "Gubbins"
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert armature.hangtime.parts["left foot"].bone == "Gubbins"
    assert {c.bone for c in armature.hangtime.contacts} >= {"LeftToeBase", "RightFoot"}


def without(armature: bpy.types.Object, *bones: str) -> None:
    """Deletes bones."""
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in bones:
        armature.data.edit_bones.remove(armature.data.edit_bones[bone])
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.slow
def test_the_fit_says_in_words_how_near_it_is(analysed: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.fit() == {"FINISHED"}
    first, second, third = analysed.hangtime.fit_quality.splitlines()
    assert first == "Very close to the recording"
    assert " cm apart" in second
    assert third.startswith("At worst ")
    assert current_action(analysed).hangtime.recording is None


def test_a_result_is_neither_accepted_nor_discarded_while_something_is_at_work(
    adapted: bpy.types.Object,
) -> None:
    assert bpy.ops.hangtime.accept.poll()
    assert bpy.ops.hangtime.discard.poll()
    session().solving = Solving()
    try:
        for name in ("accept", "discard"):
            with pytest.raises(RuntimeError, match=BUSY):
                getattr(bpy.ops.hangtime, name)()
    finally:
        session().solving = None
    assert current_action(adapted) == adapted.hangtime.adapted


def test_traces_are_kept_and_survive_saving(adapted: bpy.types.Object, tmp_path: Path) -> None:
    name = adapted.name
    was = kept(adapted.hangtime.adapted).traces
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    again = bpy.data.objects[name]
    now, recorded = kept(again.hangtime.adapted), kept(again)
    assert now is not None
    assert recorded is not None
    np.testing.assert_allclose(now.traces.heads, was.heads)
    assert now.traces.flights[0].name == "flight 1"
    assert recorded.traces.forces.size == 0
    assert again.hangtime.stances["ground 2"].up == pytest.approx(0.05)


def test_what_is_drawn_follows_the_armature(adapted: bpy.types.Object) -> None:
    stored = kept(adapted.hangtime.adapted)
    adapted.location.x += 2.0
    bpy.context.view_layer.update()
    moved = stored.moved(adapted)
    np.testing.assert_allclose(np.array(moved)[:3, 3], (2.0, 0.0, 0.0), atol=1e-6)


def test_compare_goes_to_and_fro(adapted: bpy.types.Object) -> None:
    result = current_action(adapted)
    assert bpy.ops.hangtime.compare() == {"FINISHED"}
    assert current_action(adapted) == result.hangtime.recording
    assert bpy.ops.hangtime.compare() == {"FINISHED"}
    assert current_action(adapted) == result


def test_a_result_is_discarded_and_the_edit_stays(adapted: bpy.types.Object) -> None:
    recorded = current_action(adapted).hangtime.recording
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(adapted) == recorded
    assert [a.name for a in bpy.data.actions] == [recorded.name]
    assert adapted.hangtime.adapted is None
    assert adapted.hangtime.stances["ground 2"].up == pytest.approx(0.05)
    assert not bpy.ops.hangtime.discard.poll()


@pytest.mark.slow
@pytest.mark.parametrize("kept", [False, True])
def test_the_last_discard_leaves_fake_user_and_end_of_the_scene_as_they_were(
    analysed: bpy.types.Object, kept: bool
) -> None:
    recorded = current_action(analysed)
    recorded.use_fake_user, scene = kept, bpy.context.scene
    end = scene.frame_end = round(recorded.frame_range[1])
    analysed.hangtime.stances["ground 2"].forward = 0.3  # which takes longer
    for _ in range(2):
        assert bpy.ops.hangtime.adapt() == {"FINISHED"}
        assert recorded.use_fake_user
        assert bpy.ops.hangtime.show_recording() == {"FINISHED"}
    for left in (True, kept):
        bpy.ops.hangtime.show_adapted()
        assert scene.frame_end > end
        assert bpy.ops.hangtime.discard() == {"FINISHED"}
        assert recorded.use_fake_user == left
    assert scene.frame_end == end
    assert "hangtime_guarded" not in recorded


@pytest.mark.slow
@pytest.mark.parametrize("newest_first", [True, False])
@pytest.mark.parametrize("longer_last", [True, False])
def test_discarding_results_of_two_lengths_leaves_the_end_of_the_scene_as_it_was(
    analysed: bpy.types.Object, newest_first: bool, longer_last: bool
) -> None:
    recorded, scene = current_action(analysed), bpy.context.scene
    end = scene.frame_end = round(recorded.frame_range[1])
    lasts: dict[str, int] = {}
    for forward in (0.1, 0.4) if longer_last else (0.4, 0.1):
        analysed.hangtime.stances["ground 2"].forward = forward
        assert bpy.ops.hangtime.adapt() == {"FINISHED"}
        made = current_action(analysed)
        lasts[made.name] = ceil(made.frame_range[1])
        assert bpy.ops.hangtime.show_recording() == {"FINISHED"}
    assert (list(lasts.values()) == sorted(lasts.values())) == longer_last
    assert end < min(lasts.values()) < max(lasts.values()) == scene.frame_end
    names = reversed(lasts) if newest_first else iter(lasts)
    first, second = names
    assert bpy.ops.hangtime.show_take(action=first) == {"FINISHED"}
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert scene.frame_end == lasts[second]
    assert bpy.ops.hangtime.show_take(action=second) == {"FINISHED"}
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert scene.frame_end == end


@pytest.mark.slow
def test_discard_leaves_fake_user_and_end_of_the_scene_also_after_loading(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    name, recorded, scene = analysed.name, current_action(analysed).name, bpy.context.scene
    bpy.data.actions[recorded].use_fake_user = False
    end = scene.frame_end = round(current_action(analysed).frame_range[1])
    analysed.hangtime.stances["ground 2"].forward = 0.3
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    assert bpy.data.actions[recorded].use_fake_user
    assert bpy.context.scene.frame_end > end
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(bpy.data.objects[name]).name == recorded
    assert not bpy.data.actions[recorded].use_fake_user
    assert bpy.context.scene.frame_end == end


def test_a_linked_copy_that_discards_leaves_the_figure(adapted: bpy.types.Object) -> None:
    result = current_action(adapted)
    recording = result.hangtime.recording
    adapted.select_set(True)
    assert bpy.ops.object.duplicate(linked=True) == {"FINISHED"}
    copy = bpy.context.view_layer.objects.active
    bpy.context.scene.hangtime.armature = copy
    assert current_action(copy) == result
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(copy) == recording
    assert current_action(adapted) == recording


@pytest.mark.slow
def test_reduced_keys_are_fewer_and_told_with_their_largest_error(
    analysed: bpy.types.Object,
) -> None:
    analysed.hangtime.result_keys.on = "REDUCED"
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    action = analysed.hangtime.adapted
    assert "a second and channel; joints at most" in analysed.hangtime.status
    assert "Keys: " in action.hangtime.report
    first, last = JUMP_FRAMES
    counts = [
        sum(first < point.co.x < last for point in curve.keyframe_points)
        for curve in curves_of(analysed)
    ]
    assert counts[0] < 0.5 * max(counts)  # of the hips; fingers keep a key on every frame


def test_the_report_becomes_a_text(adapted: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.show_report() == {"FINISHED"}
    text = bpy.data.texts[f"{adapted.hangtime.adapted.name} report"].as_string()
    assert "Solved" in text
    assert "the pelvis rises to" in text


def test_the_report_of_a_long_name_is_one_text(adapted: bpy.types.Object) -> None:
    for name in (f"{'ü' * 26} adapted", f"{'ü' * 26} adapted 2"):
        adapted.hangtime.adapted.name = name
        for _ in range(2):
            assert bpy.ops.hangtime.show_report() == {"FINISHED"}
    assert sorted(text.name[-18:] for text in bpy.data.texts) == [
        "ü adapted 2 report"[-18:],
        "üüü adapted report"[-18:],
    ]


@pytest.mark.slow
def test_the_best_of_a_solve_that_failed_can_be_used(analysed: bpy.types.Object) -> None:
    stance = analysed.hangtime.stances["ground 2"]
    stance.forward = 8.0
    settings = analysed.hangtime  # physics and pins alone are given up sooner
    settings.keep_times, settings.keep_out, settings.human_ranges = True, False, False
    with pytest.raises(RuntimeError, match="No motion was found"):
        bpy.ops.hangtime.adapt()
    assert len(bpy.data.actions) == 1
    assert session().best is not None
    other = bpy.data.objects.new("Other", bpy.data.armatures.new("Other"))
    bpy.context.scene.collection.objects.link(other)
    bpy.context.view_layer.objects.active = other
    assert not bpy.ops.hangtime.use_best.poll()
    bpy.context.view_layer.objects.active = analysed
    assert bpy.ops.hangtime.use_best() == {"FINISHED"}
    assert current_action(analysed).hangtime.recording is not None
    assert "not all is met" in analysed.hangtime.status
    assert NOT_MET in current_action(analysed).hangtime.warning
    assert not bpy.ops.hangtime.use_best.poll()


@pytest.mark.slow
def test_refining_lessens_what_is_chosen(adapted: bpy.types.Object) -> None:
    adapted.hangtime.objective = "TORQUE_OUTPUT"
    assert bpy.ops.hangtime.refine() == {"FINISHED"}
    assert "objective" in adapted.hangtime.adapted.hangtime.report.lower()


@pytest.mark.slow
def test_a_contact_that_was_not_seen_is_added(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    gone = settings.contacts["Left heel 2"]
    gone.used = False
    found, end = np.array(gone.found_at), gone.end_frame  # adding moves the rows in memory
    bpy.context.scene.frame_set(round(gone.start_frame) + 4)
    assert bpy.ops.hangtime.add_contact(point="Left heel") == {"FINISHED"}
    row = settings.contacts[settings.active_contact]
    assert row.added
    row.end_frame = end
    place, count = np.array(row.at), len(settings.contacts)
    assert np.linalg.norm(place - found) < 0.03
    settings.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert bpy.ops.hangtime.compare() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}  # what was added outlives an analysis
    assert len(settings.contacts) == count
    settings.active_contact = settings.contacts.find("Left heel added")
    assert bpy.ops.hangtime.remove_contact() == {"FINISHED"}
    assert "Left heel added" not in settings.contacts


@pytest.mark.slow
def test_longer_legs_perform_and_are_exported_on_their_own_armature(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    first, actions, bones = analysed.hangtime.adapted, list(bpy.data.actions), analysed.data
    assert bpy.ops.hangtime.add_body_change(kind="LIMB") == {"FINISHED"}
    row = analysed.hangtime.body_changes[-1]
    row.bones.clear()
    for bone in ("LeftLeg", "RightLeg"):
        row.bones.add().name = bone
    row.length = 1.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    result = analysed.hangtime.adapted
    assert result != first
    other = result.hangtime.performer
    assert other != analysed
    assert current_action(other) == result
    assert set(bpy.data.actions) == {*actions, result}
    assert f"rest of the take is left out: {other.name} has other limbs" in analysed.hangtime.status
    assert not bpy.ops.hangtime.compare.poll()
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    fbx = tmp_path / "long.fbx"
    assert bpy.ops.hangtime.export(filepath=str(fbx)) == {"FINISHED"}
    assert other.name.encode() in fbx.read_bytes()
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert "changed" not in "".join(o.name for o in bpy.data.objects)
    assert list(bpy.data.actions) == actions
    assert list(bpy.data.armatures) == [bones]
    assert bpy.context.view_layer.objects.active == analysed
    assert result_of(analysed) == first


@pytest.mark.slow
def test_a_stated_height_mends_a_wrong_scale() -> None:
    rigs.reset()
    armature = import_clip(mocap_path(JUMP)).armature
    settings = armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = JUMP_FRAMES
    armature.scale = (20.0, 20.0, 20.0)
    bpy.context.view_layer.update()
    settings.use_height, settings.height = True, 1.7
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert settings.measured_height == pytest.approx(20.0 * 1.69, rel=0.02)
    assert "Left heel 2" in settings.contacts


@pytest.mark.slow
def test_a_result_that_is_not_accepted_goes_with_the_file(
    adapted: bpy.types.Object, tmp_path: Path
) -> None:
    first = adapted.hangtime.adapted.name
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    second = adapted.hangtime.adapted.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    assert second in bpy.data.actions
    assert first not in bpy.data.actions


def test_writing_that_is_cancelled_leaves_nothing_behind(analysed: bpy.types.Object) -> None:
    recorded = current_action(analysed)
    recorded.use_fake_user = False
    recording = read_recorded(analysed, *JUMP_FRAMES)
    bones = [recording.index(name) for name in ("Hips", "LeftUpLeg", "LeftLeg")]
    track = PoseTrack(
        recording.frames,
        tuple(recording.bones[b].name for b in bones),
        recording.rotations[:, bones],
        recording.heads[:, bones[0]],
    )
    times = TimeMap(JUMP_FRAMES, JUMP_FRAMES)
    writing = write_adapted_incrementally(
        analysed, AdaptedMotion(track, times, None, ResultOptions())
    )
    while len(bpy.data.actions) == 1:
        next(writing)
    writing.close()
    assert list(bpy.data.actions) == [recorded]
    assert not recorded.use_fake_user
    assert current_action(analysed) == recorded


def test_a_result_whose_recording_was_deleted_is_not_made_from_itself(
    adapted: bpy.types.Object,
) -> None:
    result = current_action(adapted)
    bpy.data.actions.remove(result.hangtime.recording)
    with pytest.raises(RuntimeError, match=r"Nothing that .* was made from is there"):
        bpy.ops.hangtime.compare()
    with pytest.raises(RuntimeError, match=r"is not there any more.* press Analyze"):
        bpy.ops.hangtime.update()
    assert current_action(adapted) == result
