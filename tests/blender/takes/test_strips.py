"""A result as a strip on top of the untouched take."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import recorded_action, show, showing_action
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.poses import Poses, sample
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.combined import bake_shown
from hangtime.bridge.results.look_again import look_again
from hangtime.bridge.results.made import note_made
from hangtime.bridge.rows.choices import WrittenAs
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import combine, write_adapted_incrementally
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(1.0, 25.0, 0.5)
OPTIONS = ResultOptions(blend_in=4.0, blend_out=4.0, written_as=WrittenAs.STRIP)

pytestmark = pytest.mark.usefixtures("_enabled")


COMBINED = replace(OPTIONS, written_as=WrittenAs.COMBINE)


def lifted(
    armature: bpy.types.Object, by: float, options: ResultOptions = OPTIONS
) -> bpy.types.Action:
    """Write the middle of the take anew, so much higher and turned, into a strip."""
    with showing_action(armature, recorded_action(armature)):
        part = read_recording(armature).window(10, 14)
    bones = [part.index(bone) for bone in rigs.MOVING]
    heads = part.heads[:, bones[0]] + [0.0, 0.0, by]
    rotations = axis_rotation(2, np.full(len(part.frames), 2.0 * by))[:, None]
    track = PoseTrack(part.frames, rigs.MOVING, rotations @ part.rotations[:, bones], heads)
    motion = AdaptedMotion(track, TimeMap((10.0, 14.0), (10.0, 14.0)), None, options)
    action, written = complete(write_adapted_incrementally(armature, motion))
    if options.written_as is WrittenAs.COMBINE:
        combine(armature, action, options.after)
    note_made(armature, action, written.span, written.later)
    return action


def same(one: Poses, other: Poses) -> bool:
    return one.matrices.tobytes() == other.matrices.tobytes()


def test_with_its_strip_muted_the_take_is_there_to_the_bit(armature: bpy.types.Object) -> None:
    take, before = current_action(armature), sample(armature, FRAMES)
    result = lifted(armature, 0.1)
    assert current_action(armature) == result
    assert armature.animation_data.action is None
    assert not same(sample(armature, FRAMES), before)
    track = armature.animation_data.nla_tracks[-1]
    track.mute = True
    assert same(sample(armature, FRAMES), before)
    assert current_action(armature) == take
    track.mute = False
    assert current_action(armature) == result
    show(armature, take)
    assert same(sample(armature, FRAMES), before)
    assert recorded_action(armature) == take


def test_where_the_nla_is_switched_off_no_strip_is_shown(armature: bpy.types.Object) -> None:
    take, result = current_action(armature), lifted(armature, 0.1)
    armature.animation_data.use_nla = False
    assert current_action(armature) is None
    armature.animation_data.use_nla = True
    assert current_action(armature) == result != take


def test_the_strip_shows_the_result_as_its_action_does(armature: bpy.types.Object) -> None:
    result = lifted(armature, 0.1)
    in_strip = sample(armature, FRAMES)
    with showing_action(armature, result):
        alone = sample(armature, FRAMES)
    np.testing.assert_allclose(in_strip.matrices, alone.matrices, atol=1e-6)


def test_a_second_result_is_made_from_the_take_and_the_first_is_muted(
    armature: bpy.types.Object,
) -> None:
    before = sample(armature, FRAMES)
    first, second = lifted(armature, 0.1), lifted(armature, 0.2)
    tracks = armature.animation_data.nla_tracks
    assert [track.mute for track in tracks] == [False, True, False]
    assert current_action(armature) == second
    hips = sample(armature, np.array([12.0])).matrices[0, 0, :3, 3]
    was = before.matrices[np.flatnonzero(FRAMES == 12.0)[0], 0, :3, 3]
    np.testing.assert_allclose(hips - was, (0.0, 0.0, 0.2), atol=1e-6)
    show(armature, first)
    assert [track.mute for track in tracks] == [False, False, True]


def test_while_a_strip_is_tweaked_what_assigns_actions_waits(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.armature = armature
    lifted(armature, 0.1)
    tracks = armature.animation_data.nla_tracks
    tracks.active = tracks[-1]
    for track in tracks:
        for strip in track.strips:
            track.select = strip.select = track == tracks[-1]
    ours = bpy.ops.hangtime
    waiting = (ours.analyze, ours.show_take, ours.compare, ours.show_recording, ours.discard)
    for tweaking in (True, False):
        armature.animation_data.use_tweak_mode = tweaking
        assert {each.poll() for each in waiting} == {not tweaking}


def test_a_result_that_another_tweaks_is_not_discarded(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.armature = armature
    result = lifted(armature, 0.1)
    other = armature.copy()
    bpy.context.scene.collection.objects.link(other)
    data = other.animation_data
    data.nla_tracks.active = data.nla_tracks[-1]
    for track in data.nla_tracks:
        for strip in track.strips:
            track.select = strip.select = track == data.nla_tracks[-1]
    data.use_tweak_mode = True
    assert data.use_tweak_mode
    with pytest.raises(RuntimeError, match=f"{other.name} plays this result, too"):
        bpy.ops.hangtime.discard()
    assert result in list(bpy.data.actions)
    assert current_action(armature) == result
    data.use_tweak_mode = False
    assert bpy.ops.hangtime.discard() == {"FINISHED"}


WHOLE = np.arange(1.0, 25.0)


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZYX", "AXIS_ANGLE"])
def test_a_difference_combined_with_the_take_is_the_result(mode: str) -> None:
    rigs.reset()
    armature = rigs.make_armature()
    rigs.animate(armature, mode)
    take, before = current_action(armature), sample(armature, FRAMES)
    keys = keys_digest(take)
    result = lifted(armature, 0.1, COMBINED)
    assert current_action(armature) == result
    strip = armature.animation_data.nla_tracks[-1].strips[0]
    assert (strip.blend_type, strip.action != result) == ("COMBINE", True)
    shown = sample(armature, WHOLE)
    with showing_action(armature, result):
        alone = sample(armature, WHOLE)
    np.testing.assert_allclose(shown.matrices, alone.matrices, atol=5e-5)
    assert not same(sample(armature, FRAMES), before)
    armature.animation_data.nla_tracks[-1].mute = True
    assert same(sample(armature, FRAMES), before)  # to the bit
    assert keys_digest(take) == keys


def test_the_take_below_a_difference_is_edited_and_the_result_follows(
    armature: bpy.types.Object,
) -> None:
    take = current_action(armature)
    result = lifted(armature, 0.1, COMBINED)
    was = sample(armature, WHOLE).matrices
    location = fcurves.holder_in(take, fcurves.slot_identifier(armature)).fcurves.find(
        armature.pose.bones["hips"].path_from_id("location"), index=1
    )
    fcurves.scale_keys(location, 1.0, 1.5)
    take.update_tag()
    now = sample(armature, WHOLE).matrices
    assert np.abs(now - was).max() > 0.01
    look_again(armature)
    assert result.hangtime.stale
    with showing_action(armature, result):
        kept = sample(armature, WHOLE).matrices
    assert np.abs(kept - now).max() > 0.01
    bake_shown(armature, result)
    with showing_action(armature, result):
        np.testing.assert_allclose(sample(armature, WHOLE).matrices, now, atol=5e-5)


def test_a_difference_goes_with_its_result(armature: bpy.types.Object) -> None:
    take = current_action(armature)
    first = lifted(armature, 0.1, COMBINED)
    second = lifted(armature, 0.2, COMBINED)
    assert [track.mute for track in armature.animation_data.nla_tracks] == [False, True, False]
    show(armature, first)
    assert [track.mute for track in armature.animation_data.nla_tracks] == [False, False, True]
    bpy.context.scene.hangtime.armature = armature
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(armature) == take
    assert {action.name for action in bpy.data.actions} == {
        take.name,
        second.name,
        f"{second.name} difference",
    }


def test_a_take_moves_beyond_its_manual_frame_range_and_blends_with_nothing(
    armature: bpy.types.Object,
) -> None:
    take, data = current_action(armature), armature.animation_data
    take.use_frame_range, take.frame_start, take.frame_end = True, 8.5, 16.0
    data.action_blend_type, data.action_influence = "COMBINE", 0.6
    before = sample(armature, FRAMES)
    lifted(armature, 0.1)
    show(armature, take)
    assert same(sample(armature, FRAMES), before)
