"""Keys of a written action: few, within the error that Blender itself shows, all else untouched."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.channels import EULER_ORDERS, channels, rotations_of
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import read_recording, record
from hangtime.bridge.armature.write import write_action
from hangtime.bridge.keys import choose
from hangtime.bridge.keys.bezier_keys import splice_bezier
from hangtime.bridge.keys.events import KeyEvents, PlantedPoint
from hangtime.bridge.keys.hermite import fitted
from hangtime.bridge.keys.written import KeyedAction, choose_keys
from hangtime.bridge.recipe.keys import KeyOptions
from hangtime.bridge.rows.choices import KeyChoice
from hangtime.operators.words.report_text import keys_line
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.keys import KeysReport
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.tests.blender.helpers import rigs

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)
REDUCED = KeyOptions(KeyChoice.REDUCED, 0.002, np.radians(0.2))


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


def swung(armature: bpy.types.Object) -> PoseTrack:
    """The recording's bones, turned smoothly by up to half a radian; the pelvis travels."""
    recording = read_recording(armature)
    phase = recording.frames / 6.0
    axes = np.random.default_rng(3).uniform(-0.3, 0.3, (2, len(rigs.MOVING), 3))
    turns = np.sin(phase)[:, None, None] * axes[0] + np.cos(0.7 * phase)[:, None, None] * axes[1]
    first = [recording.index(bone) for bone in rigs.MOVING]
    rotations = rotation_matrix(turns) @ recording.rotations[:1, first]
    head = recording.heads[:1, first[0]] + 0.2 * np.sin(phase)[:, None]
    return PoseTrack(recording.frames, rigs.MOVING, rotations, head)


def written(
    options: KeyOptions, mode: str = "QUATERNION", events: KeyEvents | None = None
) -> tuple[bpy.types.Object, PoseTrack, KeysReport]:
    armature = rigs.make_armature(rigs.BODY)
    rigs.animate(armature, mode)
    track, take = swung(armature), fcurves.holder(armature)
    action = write_action(armature, track, name="Adapted")
    slot = fcurves.slot_identifier(armature)
    keyed = KeyedAction(action, slot, track.bones, track.frames, take)
    return armature, track, complete(choose_keys(armature, keyed, options, events or KeyEvents()))


def off(armature: bpy.types.Object, track: PoseTrack) -> tuple[float, float]:
    """Largest distance of the pelvis, mm, and turn of a bone, degrees, as Blender shows them."""
    shown = record(armature, track.frames)
    moving = [shown.index(bone) for bone in track.bones]
    chords = np.linalg.norm(shown.rotations[:, moving] - track.rotations, axis=(2, 3)) / np.sqrt(
        8.0
    )
    apart = np.linalg.norm(shown.heads[:, moving[0]] - track.root_head, axis=1)
    return 1000.0 * float(apart.max()), float(np.degrees(2.0 * np.arcsin(chords.max())))


@pytest.mark.slow
@pytest.mark.parametrize("mode", MODES)
def test_blender_shows_the_error_that_is_reported_in_every_rotation_mode(mode: str) -> None:
    armature, track, report = written(REDUCED, mode)
    moved, turned = off(armature, track)
    assert moved <= report.largest_error_mm + 1e-3 <= 2.0 + 1e-3
    assert turned == pytest.approx(report.largest_turn_deg, abs=1e-3)
    assert turned <= 0.2 + 1e-3
    assert report.keys < 0.9 * report.channels * len(track.frames)


def test_curves_between_keys_are_those_that_were_fitted() -> None:
    armature = rigs.make_armature(rigs.BODY)
    rigs.animate(armature)
    curves = fcurves.holder(armature)
    frames = np.arange(1.0, 25.0)
    keys = fitted(np.sin(frames / 3.0)[:, None] + np.zeros(3), frames, np.array([1.0, 7, 12, 24]))
    splice_bezier(curves, 'pose.bones["hips"].location', keys, np.empty(0), "hips")
    dense = np.linspace(1.0, 24.0, 200)
    for index in range(3):
        curve = curves.fcurves.find('pose.bones["hips"].location', index=index)
        shown = [curve.evaluate(frame) for frame in dense]
        np.testing.assert_allclose(shown, keys.at(dense)[:, index], atol=2e-5)
        curve.update()  # as when an artist moves a key
        again = [curve.evaluate(frame) for frame in dense]
        np.testing.assert_allclose(again, shown, atol=2e-5)


def test_keys_outside_of_the_range_stay_bit_by_bit() -> None:
    armature = rigs.make_armature(rigs.BODY)
    rigs.animate(armature)
    curves, path = fcurves.holder(armature), 'pose.bones["hips"].location'
    before = {c.array_index: fcurves.keys(c) for c in curves.fcurves if c.data_path == path}
    keys = fitted(np.zeros((5, 3)), np.arange(8.0, 13.0), np.array([8.0, 12.0]))
    splice_bezier(curves, path, keys, np.empty(0), "hips")
    for index, old in before.items():
        new = fcurves.keys(curves.fcurves.find(path, index=index))
        outside = (old[:, 0] < 8.0) | (old[:, 0] > 12.0)
        kept = (new[:, 0] < 8.0) | (new[:, 0] > 12.0)
        np.testing.assert_array_equal(new[kept], old[outside])
        assert new[~kept].tolist() == [[8.0, 0.0], [12.0, 0.0]]


def test_contacts_and_take_offs_are_extremes_of_the_whole_body() -> None:
    foot = PlantedPoint("shin", np.zeros(3), 3.0, 9.4)
    events = KeyEvents((foot,), (9.4, 15.2))
    armature, track, _ = written(REDUCED, events=events)
    path = armature.pose.bones["hips"].path_from_id("location")
    for curve in fcurves.curves_of(armature):
        if curve.data_path == path or fcurves.bone_of(curve.data_path) in track.bones:
            kinds = {k.co[0]: k.type for k in curve.keyframe_points}
            assert kinds[9.0] == kinds[15.0] == "EXTREME"
            assert {k.handle_left_type for k in curve.keyframe_points} == {"ALIGNED"}


def test_a_key_on_every_frame_changes_nothing() -> None:
    armature, track, report = written(KeyOptions())
    assert report.keys == report.channels * len(track.frames)
    assert max(off(armature, track)) < 1e-2


def test_as_the_take_has_keys_where_the_take_has_them() -> None:
    armature = rigs.make_armature(rigs.BODY)
    rigs.animate(armature)
    track = swung(armature)
    for curve in fcurves.curves_of(armature):
        for key in reversed(curve.keyframe_points):
            if key.co[0] not in (1.0, 6.0, 13.0, 20.0, 24.0):
                curve.keyframe_points.remove(key)
    take, slot = fcurves.holder(armature), fcurves.slot_identifier(armature)
    action = write_action(armature, track, name="Adapted")
    keyed = KeyedAction(action, slot, track.bones, track.frames, take)
    complete(choose_keys(armature, keyed, KeyOptions(KeyChoice.TAKE), KeyEvents()))
    curve = next(c for c in fcurves.curves_of(armature) if "location" in c.data_path)
    assert fcurves.keys(curve)[:, 0].tolist() == [1.0, 6.0, 13.0, 20.0, 24.0]
    assert current_action(armature) == action


@pytest.mark.parametrize("mode", MODES)
def test_channels_are_read_as_they_are_made(mode: str) -> None:
    vectors = np.random.default_rng(1).uniform(-2.0, 2.0, (50, 3))
    rotations = rotation_matrix(np.cumsum(0.1 * vectors, axis=0))
    values = channels(rotations, mode)
    np.testing.assert_allclose(rotations_of(values, mode), rotations, atol=1e-9)


def test_it_is_told_where_no_fewer_keys_keep_the_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choose, "TIGHTENINGS", 0)
    armature, track, report = written(REDUCED)
    assert {len(c.keyframe_points) for c in fcurves.curves_of(armature)} == {len(track.frames)}
    assert report.choice == "every frame"
    assert keys_line(report).startswith("a key on every frame, as fewer do not keep the error: ")
    monkeypatch.undo()
    rigs.reset()
    assert keys_line(written(REDUCED)[2])[0].isdigit()
