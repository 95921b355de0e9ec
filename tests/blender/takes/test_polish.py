"""Hand polish of a result is on the next one, where the performance is the same, and only once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import read_recorded, showing_action
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.polish.pins import MovedPin
from hangtime.bridge.polish.renewal import Renewal
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.made import note_made
from hangtime.bridge.rows.choices import After, WrittenAs
from hangtime.bridge.takes.owned import owned_channels
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.take_time import TakeTime
from hangtime.bridge.takes.takes import show_take
from hangtime.bridge.takes.write_result import combine, write_adapted_incrementally
from hangtime.operators.words.take_text import polish_lines
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")

FIRST, LAST = 20, 40
HEAD = 'pose.bones["head"].'


def rig(mode: str = "QUATERNION") -> bpy.types.Object:
    rigs.reset()
    made = rigs.make_armature()
    rigs.animate(made, mode, frames=range(1, 61))
    bpy.context.scene.hangtime.armature = made
    return made


@dataclass(frozen=True)
class Made:
    action: bpy.types.Action
    told: list[str]
    moved: tuple[MovedPin, ...]


def adapt(
    armature: bpy.types.Object,
    up: float,
    *,
    first: int = FIRST,
    last: int = LAST,
    ends: int | None = None,
    **options: object,
) -> Made:
    """A result in which some frames are so much higher, with the polish of the one before it.

    ends: the frame at which the last of them is performed.
    """
    ends = last if ends is None else ends
    recorded = read_recorded(armature, first, last)
    bones = [recorded.index(bone) for bone in rigs.MOVING]
    frames = np.arange(first, ends + 1.0)
    at = np.round(np.linspace(0, len(recorded.frames) - 1, len(frames))).astype(int)
    heads = recorded.heads[at, bones[0]] + [0.0, 0.0, up]
    track = PoseTrack(frames, rigs.MOVING, recorded.rotations[at][:, bones], heads)
    times = TimeMap((float(first), float(last)), (float(first), float(ends)))
    chosen = ResultOptions(blend_in=3.0, blend_out=3.0, **options)
    renewal = Renewal.of(armature)
    motion = AdaptedMotion(track, times, None, chosen)
    action, written = complete(write_adapted_incrementally(armature, motion))
    time = written.time if written is not None else TakeTime.of(times, 1.0)
    own = {channel.path for channel in owned_channels(armature, rigs.MOVING)}
    owned = own if written is None else written.owned
    moved = complete(renewal.put_on(action, owned, time, ContactSchedule((), 1.0, 0.0), 24.0))
    if chosen.written_as is WrittenAs.COMBINE:
        combine(armature, action, chosen.after)
    note_made(armature, action, written.span if written is not None else None, time.later)
    renewal.note(action, time, (float(first), float(last)))
    return Made(action, polish_lines(renewal.put), moved)


def curve_of(armature: bpy.types.Object, path: str, index: int = 0) -> bpy.types.FCurve:
    return fcurves.holder(armature).fcurves.find(path, index=index)


def turn_head(armature: bpy.types.Object, frames: range, by: float = 0.4) -> None:
    """Turn the head about its own Z by keys."""
    bone = armature.pose.bones["head"]
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        more = rigs.turn_by(np.array([0.0, 0.0, by]))
        basis = np.array(bone.matrix_basis.to_3x3()) @ more
        rigs.set_rotation(bone, rigs.Matrix(basis.tolist()).to_quaternion())
        bone.keyframe_insert(rigs.rotation_path(bone), frame=frame)


def head_bases(armature: bpy.types.Object, action: bpy.types.Action | None = None) -> np.ndarray:
    """(60, 3, 3) what the head's channels are on frames 1 to 60 of a take."""
    with showing_action(armature, action or current_action(armature)):
        found = []
        for frame in range(1, 61):
            bpy.context.scene.frame_set(frame)
            found.append(np.array(armature.pose.bones["head"].matrix_basis.to_3x3()))
    return np.array(found)


def turned(bases: np.ndarray, others: np.ndarray) -> np.ndarray:
    """(T,) rad from one to the other."""
    trace = np.einsum("tij,tij->t", bases, others)
    return np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "AXIS_ANGLE"])
def test_polish_stays_through_many_renewals_and_never_grows(mode: str) -> None:
    armature = rig(mode)
    adapt(armature, 0.1)
    clean = head_bases(armature)
    turn_head(armature, range(25, 31))
    for up in (0.2, 0.3, 0.4):
        made = adapt(armature, up)
        by = turned(clean, head_bases(armature))
        np.testing.assert_allclose(by[24:30], 0.4, atol=2e-3)
        assert by[:24].max() < 2e-3
        assert by[30:].max() < 2e-3
        assert made.action.hangtime.polished
        assert made.told[0].endswith("1 channel, between frames 25 and 30")


def test_polish_comes_later_where_the_performance_does() -> None:
    armature = rig()
    adapt(armature, 0.1)
    turn_head(armature, range(46, 51))  # after the range
    adapt(armature, 0.1, ends=LAST + 4)
    again = head_bases(armature)
    armature.hangtime.result.keep_polish = False
    adapt(armature, 0.1, ends=LAST + 4)
    by = turned(head_bases(armature), again)
    assert np.flatnonzero(by > 0.2).tolist() == list(range(49, 54))  # frames 50 to 54


def test_polish_for_which_there_is_no_frame_is_told() -> None:
    armature = rig()
    first = adapt(armature, 0.1).action
    turn_head(armature, range(35, 51))
    told = adapt(armature, 0.1, after=After.CUT).told
    assert f"polish of {first.name} on frames 41 to 50 stays behind" in told[1]
    assert told[0].endswith("between frames 35 and 40")


def test_a_finger_keyed_by_hand_keeps_its_few_keys_bit_by_bit() -> None:
    armature = rig()
    adapt(armature, 0.1)
    finger = armature.pose.bones["finger"]
    for frame, x in ((12, 0.0), (30, 0.7), (50, 0.1)):
        finger.location = (x, 0.0, 0.0)
        finger.keyframe_insert("location", index=0, frame=frame)
    path = finger.path_from_id("location")
    before = fcurves.table(curve_of(armature, path))
    adapt(armature, 0.2)
    after = fcurves.table(curve_of(armature, path))
    assert all(after[name].tobytes() == column.tobytes() for name, column in before.items())
    adapt(armature, 0.2, ends=LAST + 4)  # what follows comes later, and the last key with it
    np.testing.assert_allclose(
        fcurves.keys(curve_of(armature, path)), [[12.0, 0.0], [32.0, 0.7], [54.0, 0.1]], atol=1e-6
    )
    adapt(armature, 0.2)  # and earlier again
    np.testing.assert_allclose(fcurves.keys(curve_of(armature, path)), before["co"], atol=1e-5)


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_polish_of_a_difference_is_kept_and_edits_of_the_take_count_once(mode: str) -> None:
    armature = rig(mode)
    take, slot = current_action(armature), fcurves.slot_identifier(armature)
    result = adapt(armature, 0.1, written_as=WrittenAs.COMBINE).action
    strip = armature.animation_data.nla_tracks[-1].strips[0]
    path = armature.pose.bones["hips"].path_from_id("location")
    more = fcurves.holder_in(strip.action, slot).fcurves.find(path, index=2)
    for key in more.keyframe_points:
        if 24 < key.co.x < 31:
            key.co.y += 0.5
    below = fcurves.holder_in(take, slot).fcurves.find(path, index=2)
    fcurves.scale_keys(below, 1.0, 1.5)
    again = adapt(armature, 0.1, written_as=WrittenAs.COMBINE).action
    assert again != result

    def height(frame: int) -> float:
        return curve_of(armature, path, 2).evaluate(frame)

    polished = [height(frame) for frame in range(1, 61)]
    armature.hangtime.result.keep_polish = False
    adapt(armature, 0.1)
    lifted = np.array(polished) - [height(frame) for frame in range(1, 61)]
    np.testing.assert_allclose(lifted[24:30], 0.5, atol=1e-5)
    np.testing.assert_allclose(np.delete(lifted, range(24, 30)), 0.0, atol=1e-5)


def test_polished_sizes_of_a_difference_stay_as_many_times_as_large() -> None:
    armature = rig()
    bone, slot = armature.pose.bones["head"], fcurves.slot_identifier(armature)
    bone.scale = (2.0, 2.0, 2.0)
    bone.keyframe_insert("scale", frame=1)
    adapt(armature, 0.1, written_as=WrittenAs.COMBINE)
    strip, path = armature.animation_data.nla_tracks[-1].strips[0], bone.path_from_id("scale")
    more = fcurves.ensured(fcurves.holder_in(strip.action, slot), path, 0, "head")
    for frame, value in ((20.0, 1.0), (28.0, 1.5), (36.0, 1.0)):
        more.keyframe_points.insert(frame, value)
    result = adapt(armature, 0.2, written_as=WrittenAs.COMBINE).action
    wide = fcurves.holder_in(result, slot).fcurves.find(path, index=0)
    assert [wide.evaluate(frame) for frame in (10, 28, 50)] == pytest.approx([2.0, 3.0, 2.0])


def test_polish_that_moves_a_point_which_the_artist_pinned_is_told() -> None:
    armature = rig()
    adapt(armature, 0.1)
    turn_head(armature, range(25, 31))
    for name, bone in (("Crown", "head"), ("Ankle", "foot")):
        row = armature.hangtime.constraints.add()
        row.name, row.kind, row.span = name, "POINT", "FRAMES"
        row.first_frame, row.last_frame = 28, 35
        row.bones.add().name = bone
        row.use_offset, row.offset = True, (0.1, 0.0, 0.0)
    (moved,) = adapt(armature, 0.1).moved
    assert moved.name == "Crown"
    assert 28 <= moved.frame <= 30
    assert moved.distance == pytest.approx(2.0 * 0.1 * np.sin(0.2), rel=1e-2)


def test_another_jump_of_the_take_does_not_get_the_polish_of_the_first() -> None:
    armature = rig()
    adapt(armature, 0.1)
    turn_head(armature, range(25, 31))
    settings = armature.hangtime
    settings.use_range, settings.first_frame, settings.last_frame = True, 45, 55
    assert adapt(armature, 0.1, first=45, last=55).told == []


def test_curves_that_were_deleted_by_hand_are_told_to_be_back() -> None:
    armature = rig()
    adapt(armature, 0.1)
    curve_of(armature, f"{HEAD}rotation_quaternion", 1).mute = True
    (told,) = adapt(armature, 0.1).told
    assert told == "Curves that were removed or muted by hand are back: head"


def test_a_renewal_is_undone_with_the_polish_still_in_the_result_before() -> None:
    armature = rig()
    first = adapt(armature, 0.1).action
    turn_head(armature, range(25, 31))
    polished = head_bases(armature)
    name, shown = armature.name, first.name
    bpy.ops.ed.undo_push(message="before")
    adapt(armature, 0.2)
    bpy.ops.ed.undo_push(message="adapted")
    assert bpy.ops.ed.undo() == {"FINISHED"}
    armature = bpy.data.objects[name]
    assert current_action(armature).name == shown
    assert len([a for a in bpy.data.actions if a.hangtime.recording]) == 1
    np.testing.assert_allclose(head_bases(armature), polished, atol=1e-6)
    adapt(armature, 0.2)
    assert turned(head_bases(armature), polished).max() < 2e-3


def test_a_result_chosen_in_the_list_hands_on_its_own_polish() -> None:
    armature = rig()
    first = adapt(armature, 0.1).action
    turn_head(armature, range(25, 31))
    armature.hangtime.result.keep_polish = False
    adapt(armature, 0.2)
    armature.hangtime.result.keep_polish = True
    show_take(armature, first)
    polished = head_bases(armature)
    armature.hangtime.result.keep_polish = True
    adapt(armature, 0.3)
    assert turned(head_bases(armature), polished).max() < 2e-3


def test_a_broken_recipe_beside_polish_is_refused_in_words() -> None:
    armature = rig()
    adapt(armature, 0.1)
    turn_head(armature, range(25, 31))
    wishes = armature.hangtime.requests = bpy.data.texts.new("wishes")
    wishes.write("[[")
    armature.hangtime.contacts.add().name = "heel"
    with pytest.raises(RuntimeError, match="wishes") as refused:
        bpy.ops.hangtime.adapt()
    assert "Traceback" not in str(refused.value)
