"""What a take leaves without keys is as it was, once a result that has keys there is left."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge import unkeyed as unkeyed_channels
from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import recorded_poses, showing_recorded
from hangtime.bridge.armature.incremental import complete, sample_incrementally
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.polish.samples import edited_action
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.made import note_made
from hangtime.bridge.results.start import start_from_result
from hangtime.bridge.rows.choices import WrittenAs
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.takes import show_take
from hangtime.bridge.takes.write_result import combine, write_adapted_incrementally
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(1.0, 61.0)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    """One whose foot is posed but has no keys, and whose hips have none for their height."""
    rigs.reset()
    made = rigs.make_armature()
    rigs.animate(made, frames=range(1, 61))
    curves = fcurves.holder(made)
    hips = made.pose.bones["hips"].path_from_id("location")
    for curve in list(curves.fcurves):
        if fcurves.bone_of(curve.data_path) == "foot" or (
            curve.data_path == hips and curve.array_index == 2
        ):
            curves.fcurves.remove(curve)
    made.pose.bones["hips"].location.z = 0.2
    made.pose.bones["foot"].rotation_quaternion = (0.8, 0.6, 0.0, 0.0)
    bpy.context.scene.hangtime.armature = made
    return made


def adapted(armature: bpy.types.Object, written_as: WrittenAs) -> bpy.types.Action:
    """A result in which frames 20 to 30 are higher and turned."""
    part = read_recording(armature).window(20, 30)
    bones = [part.index(bone) for bone in rigs.MOVING]
    angles = np.linspace(0.1, 0.4, len(bones))  # each bone turns against its parent
    rotations = axis_rotation(0, angles) @ part.rotations[:, bones]
    track = PoseTrack(part.frames, rigs.MOVING, rotations, part.heads[:, bones[0]] + [0, 0, 0.1])
    options = ResultOptions(blend_in=3.0, blend_out=3.0, written_as=written_as)
    motion = AdaptedMotion(track, TimeMap((20.0, 30.0), (20.0, 30.0)), None, options)
    action, written = complete(write_adapted_incrementally(armature, motion))
    if written_as is WrittenAs.COMBINE:
        combine(armature, action, options.after)
    note_made(armature, action, written.span, written.later)
    return action


@pytest.mark.parametrize("written_as", [WrittenAs.ACTION, WrittenAs.STRIP, WrittenAs.COMBINE])
def test_the_take_is_there_to_the_bit_where_it_has_no_keys(
    armature: bpy.types.Object, written_as: WrittenAs
) -> None:
    take, before = current_action(armature), sample(armature, FRAMES).matrices
    result = adapted(armature, written_as)
    bpy.context.scene.frame_set(25)
    for _ in range(2):
        show_take(armature, take)
        np.testing.assert_array_equal(sample(armature, FRAMES).matrices, before)
        show_take(armature, result)
        assert np.abs(sample(armature, [25.0]).matrices - before[24]).max() > 0.05


def test_a_result_of_a_result_gives_back_what_the_first_take_has_no_keys_for(
    armature: bpy.types.Object,
) -> None:
    take, before = current_action(armature), sample(armature, FRAMES).matrices
    start_from_result(armature, adapted(armature, WrittenAs.ACTION))
    adapted(armature, WrittenAs.ACTION)
    show_take(armature, take)
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, before)


POLISH = (
    ('pose.bones["finger"].location', 0, 0.3),
    ('pose.bones["finger"].constraints["Limit"].influence', 0, 1.0),
    ('pose.bones["twist"].scale', 1, 1.4),
    ('pose.bones["twist"]["bend"]', 0, 4.0),
)


def let_be_polished(armature: bpy.types.Object) -> None:
    """Give it what the take leaves alone, and only a result will have keys for: a scaled twist, a
    constraint, and a property that a driver bends the finger by."""
    finger, twist = (armature.pose.bones[each] for each in ("finger", "twist"))
    limit = finger.constraints.new("LIMIT_ROTATION")
    limit.name, limit.influence, twist.scale.y, twist["bend"] = "Limit", 0.5, 1.2, 2
    driver = finger.driver_add("scale", 0).driver
    variable = driver.variables.new()
    variable.targets[0].id = armature
    variable.targets[0].data_path = 'pose.bones["twist"]["bend"]'
    driver.expression = "1.0 + 0.1 * var"


def polish(armature: bpy.types.Object, result: bpy.types.Action) -> None:
    """Give a result keys by hand for what its take leaves alone, and show where these count."""
    curves = fcurves.holder_in(edited_action(result), fcurves.slot_identifier(armature))
    for path, index, value in POLISH:
        fcurves.ensured(curves, path, index, "").keyframe_points.insert(25.0, value)
    bpy.context.scene.frame_set(25)


def unkeyed(armature: bpy.types.Object) -> list[object]:
    """What the channels of the polish are now."""
    found = ((armature.path_resolve(path), index) for path, index, _ in POLISH)
    return [value[index] if hasattr(value, "__len__") else value for value, index in found]


@pytest.mark.parametrize("odd", [np.inf, np.nan])
def test_a_property_that_is_no_finite_number_leaves_the_others_as_they_were(
    armature: bpy.types.Object, odd: float
) -> None:
    let_be_polished(armature)
    armature.pose.bones["hips"]["odd"] = odd
    take, were = current_action(armature), unkeyed(armature)
    polish(armature, adapted(armature, WrittenAs.ACTION))
    show_take(armature, take)
    assert unkeyed(armature) == were


@pytest.mark.parametrize("written_as", [WrittenAs.ACTION, WrittenAs.STRIP, WrittenAs.COMBINE])
def test_polish_of_what_the_take_has_no_keys_for_is_not_on_the_take(
    armature: bpy.types.Object, written_as: WrittenAs
) -> None:
    let_be_polished(armature)
    take, before, were = current_action(armature), sample(armature, FRAMES), unkeyed(armature)
    result = adapted(armature, written_as)
    polish(armature, result)
    assert unkeyed(armature) != were
    read = recorded_poses(armature, FRAMES)  # while the result is shown, as Adapt reads it
    np.testing.assert_array_equal(read.matrices, before.matrices)
    bpy.context.scene.frame_set(25)
    show_take(armature, take)
    assert unkeyed(armature) == were
    assert type(armature.pose.bones["twist"]["bend"]) is int
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, before.matrices)
    show_take(armature, result)
    bpy.context.scene.frame_set(25)
    assert unkeyed(armature) != were


def test_what_a_result_has_keys_for_alone_is_looked_for_once_in_all_slices_of_a_reading(
    armature: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    let_be_polished(armature)
    before = sample(armature, FRAMES)
    polish(armature, adapted(armature, WrittenAs.ACTION))
    reading, looked = sample_incrementally(armature, FRAMES, showing_recorded(armature)), []

    def look(action: bpy.types.Action) -> list[bpy.types.FCurve]:
        looked.append(action.name)
        return all_curves(action)

    monkeypatch.setattr(unkeyed_channels, "all_curves", look)
    next(reading)
    once = list(looked)
    np.testing.assert_array_equal(complete(reading).matrices, before.matrices)
    assert once
    assert looked == once


def test_what_is_set_by_hand_where_nothing_has_keys_stays(armature: bpy.types.Object) -> None:
    let_be_polished(armature)
    take, result = current_action(armature), adapted(armature, WrittenAs.ACTION)
    finger, twist = (armature.pose.bones[each] for each in ("finger", "twist"))
    show_take(armature, take)
    finger.location.x = 0.05  # which the result will have keys for
    show_take(armature, result)
    twist.scale.z = 1.1
    polish(armature, result)
    show_take(armature, take)
    assert finger.location.x == pytest.approx(0.05)
    assert twist.scale.z == pytest.approx(1.1)
