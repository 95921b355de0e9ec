"""A result is the whole take: before the adapted frames, in the blends, and what follows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.rows.choices import After
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.stance_move import StanceMove
from hangtime.solver.numerics.rotations import axis_rotation, rotation_vector
from hangtime.tests.blender.helpers import rigs

LENGTH = 100
FIRST, LAST = 40, 60
BLEND = 8.0
MOVED = StanceMove("ground 2", (0.3, -0.2, 0.0), 0.4, (0.5, 0.2, 0.0))
OPTIONS = ResultOptions(blend_in=BLEND, blend_out=BLEND)
SHIFT = np.array([0.02, -0.01, 0.015])  # m, of the adapted frames off the take
TURN = axis_rotation(0, 0.03)

STEADY = ("spine", "head", "foot")  # bones that do not inherit rotation, where that is tried

Table = dict[tuple[str, int], np.ndarray]


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


def take(mode: str = "QUATERNION", every: int = 1) -> bpy.types.Object:
    """A rig with a key on every so many frames."""
    armature = rigs.make_armature()
    rigs.animate(armature, mode, frames=range(1, LENGTH + 1, every))
    return armature


def adapted(recording: Recording, frames: int = LAST - FIRST + 1) -> PoseTrack:
    """The frames from FIRST on, a little beside the take and turning a little otherwise."""
    part = recording.window(FIRST, FIRST + frames - 1)
    bones = [recording.index(bone) for bone in rigs.MOVING]
    wave = 1.0 + 0.2 * np.sin(part.frames)[:, None]
    return PoseTrack(
        part.frames, rigs.MOVING, TURN @ part.rotations[:, bones], part.heads[:, 0] + wave * SHIFT
    )


def motion(recording: Recording, moved: StanceMove | None = None, **options: object):
    track = adapted(recording)
    if moved is not None:
        turn = axis_rotation(2, moved.turn)
        head = (track.root_head - moved.pivot) @ turn.T + moved.pivot + moved.shift
        share = np.clip((track.frames - FIRST - 5) / 10.0, 0.0, 1.0)[:, None]
        share = share**2 * (3.0 - 2.0 * share)
        turns = axis_rotation(2, moved.turn * share[:, 0])
        track = replace(
            track,
            rotations=turns[:, None] @ track.rotations,
            root_head=(1.0 - share) * track.root_head + share * head,
        )
    times = TimeMap((FIRST, LAST), (FIRST, LAST))
    return AdaptedMotion(track, times, moved, replace(OPTIONS, **options))


def keys_of(armature: bpy.types.Object) -> Table:
    """Frame, value and handles of every key, by channel."""
    tables = {(c.data_path, c.array_index): fcurves.table(c) for c in fcurves.curves_of(armature)}
    names = ("co", "handle_left", "handle_right", "interpolation")
    return {
        channel: np.hstack([table[name].astype(np.float32) for name in names])
        for channel, table in tables.items()
    }


def outside(keys: np.ndarray, first: float, last: float) -> bytes:
    at = keys[:, 0]
    return keys[(at <= first) | (at >= last)].tobytes()


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZXY", "AXIS_ANGLE"])
def test_keys_outside_of_frames_and_blends_stay_bit_by_bit(mode: str) -> None:
    armature = take(mode)
    before = keys_of(armature)
    write_result(armature, motion(read_recording(armature)), name="Result")
    after = keys_of(armature)
    assert before.keys() == after.keys()
    for channel, keys in before.items():
        own = outside(after[channel], FIRST - BLEND, LAST + BLEND)
        assert own == outside(keys, FIRST - BLEND, LAST + BLEND)
    changed = [
        channel for channel in before if after[channel].tobytes() != before[channel].tobytes()
    ]
    assert {fcurves.bone_of(path) for path, _ in changed} == set(rigs.MOVING)


def test_the_adapted_frames_are_as_solved_and_seams_have_no_bend() -> None:
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording)
    write_result(armature, asked, name="Result")
    now = read_recording(armature)
    assert now.frames.tolist() == recording.frames.tolist()
    rows = slice(FIRST - 1, LAST)
    bones = [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.heads[rows, 0], asked.track.root_head, atol=2e-6)
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)
    # Neither pose nor velocity jumps: what is left of the offset changes as smoothly as it is.
    left = now.heads[:, 0] - recording.heads[:, 0]
    bends = np.abs(np.diff(left, 2, axis=0)).max(axis=1)
    inside = bends[FIRST : LAST - 2].max()
    assert bends.max() < 2.0 * inside + 1e-4
    turned = rotation_vector(now.rotations[:, 0] @ recording.rotations[:, 0].swapaxes(1, 2))
    assert np.abs(np.diff(turned, 2, axis=0)).max() < 0.01
    assert np.abs(left[: FIRST - int(BLEND)]).max() == 0.0


def test_how_blends_move_the_hips_is_told() -> None:
    """Of hips that are 0.4 m beside the take at both seams."""
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording)
    steady = recording.window(FIRST, LAST).heads[:, 0] + [0.0, 0.4, 0.0]
    asked = replace(asked, track=replace(asked.track, root_head=steady))
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    into, out = written.blends
    assert (into.into, into.first_frame, into.last_frame) == (True, FIRST - BLEND, FIRST)
    assert (out.into, out.first_frame, out.last_frame) == (False, LAST, LAST + BLEND)
    rate = bpy.context.scene.render.fps
    usual = 0.4 * 1.875 * rate / BLEND  # the quintic polynomial's highest speed, halfway
    for each in written.blends:
        assert each.off_m == pytest.approx(0.4, abs=1e-6)
        assert each.speed_m_s == pytest.approx(usual, abs=each.take_speed_m_s + 0.05 * usual)
        assert each.first_frame < each.frame < each.last_frame


@pytest.mark.parametrize(
    ("moved", "out"),
    [(None, 0.1), (StanceMove("ground 2", (0.0, 0.0, 0.0), 0.0, (0.0, 0.1, 0.0)), 0.0)],
)
def test_feet_that_stand_in_the_take_and_slide_in_a_blend_are_told(
    moved: StanceMove | None, out: float
) -> None:
    """Of a figure that stands still, and 0.1 m aside in the adapted frames."""
    armature = rigs.make_armature()
    for frame in (1, LENGTH):
        for bone in rigs.MOVING:
            armature.pose.bones[bone].keyframe_insert("rotation_quaternion", frame=frame)
        armature.pose.bones["hips"].keyframe_insert("location", frame=frame)
    part = read_recording(armature).window(FIRST, LAST)
    bones = [part.index(bone) for bone in rigs.MOVING]
    aside = part.heads[:, 0] + [0.0, 0.1, 0.0]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], aside)
    times = TimeMap((FIRST, LAST), (FIRST, LAST))
    asked = AdaptedMotion(track, times, moved, OPTIONS, touching=("foot",))
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert [each.slide_bone for each in written.blends] == ["foot", "foot"]
    assert [each.slide_m for each in written.blends] == pytest.approx([0.1, out], abs=1e-4)


def as_made(_armature: bpy.types.Object) -> None:
    """Nothing but its curves moves the rig."""


def under_a_moving_parent(armature: bpy.types.Object) -> None:
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    armature.parent, parent.rotation_euler.z = parent, 0.7
    parent.keyframe_insert("location", frame=1)
    parent.location = (0.4, 0.1, 0.0)
    parent.keyframe_insert("location", frame=LENGTH)


def not_turned_by_parents(armature: bpy.types.Object) -> None:
    for bone in STEADY:
        armature.data.bones[bone].use_inherit_rotation = False


@pytest.mark.parametrize("set_up", [as_made, under_a_moving_parent, not_turned_by_parents])
@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_what_follows_is_carried_along_rigidly(
    mode: str, set_up: Callable[[bpy.types.Object], None]
) -> None:
    armature = take(mode)
    set_up(armature)
    before, recording = keys_of(armature), read_recording(armature)
    write_result(armature, motion(recording, MOVED), name="Result")
    now, after = read_recording(armature), keys_of(armature)
    rest = recording.frames > LAST + BLEND
    turn = axis_rotation(2, MOVED.turn)
    heads = (recording.heads[rest] - MOVED.pivot) @ turn.T + MOVED.pivot + MOVED.shift
    np.testing.assert_allclose(now.heads[rest], heads, atol=1e-6)
    np.testing.assert_allclose(now.rotations[rest], turn @ recording.rotations[rest], atol=3e-6)
    jumps = np.linalg.norm(np.diff(now.heads[:, 0], axis=0), axis=1)
    assert jumps.max() < 0.2
    carrying = {"hips", *(STEADY if set_up is not_turned_by_parents else ())}
    for channel, keys in before.items():
        if fcurves.bone_of(channel[0]) not in carrying:
            own = outside(after[channel], FIRST - BLEND, LAST + BLEND)
            assert own == outside(keys, FIRST - BLEND, LAST + BLEND)


def test_a_take_returns_by_a_frame() -> None:
    armature = take()
    before, recording = keys_of(armature), read_recording(armature)
    asked = motion(recording, MOVED, after=After.RETURN, return_frame=85.0)
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert written.back == 85.0
    now, after = read_recording(armature), keys_of(armature)
    for channel, keys in before.items():
        assert outside(after[channel], FIRST - BLEND, 85.0) == outside(keys, FIRST - BLEND, 85.0)
    left = np.linalg.norm(now.heads[:, 0] - recording.heads[:, 0], axis=1)
    assert left[LAST - 1] > 0.3
    assert np.abs(np.diff(now.heads[LAST - 1 :, 0], 2, axis=0)).max() < 0.05
    assert left[85:].max() == 0.0


@pytest.mark.parametrize("ends", [False, True])
def test_where_nothing_follows_nothing_is_carried_or_comes_back(ends: bool) -> None:
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording, MOVED, after=After.RETURN)
    if not ends:
        for curve in fcurves.curves_of(armature):
            fcurves.crop(curve, 1.0, LAST)
    _, written = write_result(armature, replace(asked, ends=ends), name="Result")
    assert written is not None
    assert (written.moved, written.back) == (None, None)
    now = read_recording(armature)
    assert now.frames[[0, -1]].tolist() == [1.0, LAST]
    np.testing.assert_allclose(now.heads[-1, 0], asked.track.root_head[-1], atol=2e-6)


def later(recording: Recording, **options: object) -> AdaptedMotion:
    """A motion of the frames that takes 3.4 frames more."""
    track = adapted(recording, LAST - FIRST + 4)
    times = TimeMap((FIRST, 50.0, LAST), (FIRST, 53.4, LAST + 3.4))
    return AdaptedMotion(track, times, None, replace(OPTIONS, **options))


@pytest.mark.slow
@pytest.mark.parametrize("moved", [None, MOVED])
@pytest.mark.parametrize("longer", [0.0, 3.0, 3.4, 3.958, -3.5, -2.6])
@pytest.mark.parametrize("room", [1, 2, 5, 7, 8, 9])
def test_nothing_jumps_where_the_take_ends_in_or_beside_the_blend(
    room: int, longer: float, moved: StanceMove | None
) -> None:
    """Whatever the durations: all bones go to one last frame, no faster than in a whole blend."""
    armature = take()
    for curve in fcurves.curves_of(armature):
        fcurves.crop(curve, 1.0, LAST + room)
    recording = read_recording(armature)
    asked = motion(recording, moved)
    count = int(np.floor(LAST + longer)) - FIRST + 1
    rows = np.minimum(np.arange(count), LAST - FIRST)
    track = PoseTrack(
        FIRST + np.arange(count, dtype=float),
        rigs.MOVING,
        asked.track.rotations[rows],
        asked.track.root_head[rows],
    )
    times = TimeMap((FIRST, 50.0, LAST), (FIRST, 50.0 + longer, LAST + longer))
    _, written = write_result(armature, replace(asked, track=track, times=times), name="Result")
    assert written is not None
    ends = {float(keys[-1, 0]) for keys in keys_of(armature).values()}
    assert ends == {LAST + room + written.later}
    now = read_recording(armature)
    steps = np.linalg.norm(np.diff(now.heads, axis=0), axis=2).max(axis=1)
    usual = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max()
    assert steps[track.frames[-1].astype(int) - 1 :].max() < 1.3 * usual + 0.03


@pytest.mark.parametrize("locked", [False, True])
def test_what_follows_comes_as_much_later_as_the_frames_take_longer(locked: bool) -> None:
    armature = take()
    armature.pose.bones["finger"]["smile"] = 0.0
    for frame, value in ((10, 0.1), (45, 0.2), (90, 0.9)):
        armature.pose.bones["finger"]["smile"] = value
        armature.pose.bones["finger"].keyframe_insert('["smile"]', frame=frame)
    before, recording = keys_of(armature), read_recording(armature)
    _, written = write_result(armature, later(recording, lock_others=locked), name="Result")
    assert written is not None
    assert written.later == 3
    after = keys_of(armature)
    for channel, keys in before.items():
        now, bone = after[channel], fcurves.bone_of(channel[0])
        if bone not in rigs.MOVING and locked:
            assert now.tobytes() == keys.tobytes()
            continue
        tail = keys[keys[:, 0] >= LAST + BLEND]
        tail[:, [0, 2, 4]] += 3.0
        assert now[now[:, 0] >= LAST + BLEND + 3.0].tobytes() == tail.tobytes()
        head = keys[keys[:, 0] <= FIRST - BLEND]
        assert now[now[:, 0] <= FIRST - BLEND].tobytes() == head.tobytes()
    smile = after['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 0] == pytest.approx([10.0, 45.0, 90.0] if locked else [10.0, 46.7, 93.0])
    assert smile[:, 1] == pytest.approx([0.1, 0.2, 0.9])


def test_curves_with_a_key_on_every_frame_have_one_on_every_frame_of_the_result() -> None:
    """Also to its very end, where the take ends with the adapted frames."""
    armature = take()
    finger = armature.pose.bones["finger"]
    finger["smile"] = 0.0
    for frame in range(1, LAST + 1):
        finger["smile"] = float(frame)
        finger.keyframe_insert('["smile"]', frame=frame)
    (curve,) = (c for c in fcurves.curves_of(armature) if "smile" in c.data_path)
    for key in curve.keyframe_points:
        key.interpolation = "LINEAR"
    write_result(armature, later(read_recording(armature)), name="Result")
    smile = keys_of(armature)['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 0].tolist() == list(range(1, LAST + 4))
    shown = np.interp(smile[:, 0], [FIRST, 53.4, LAST + 3.4], [FIRST, 50.0, LAST])
    inside = smile[:, 0] >= FIRST
    assert smile[inside, 1] == pytest.approx(shown[inside], abs=1e-4)


def test_a_switch_of_two_keys_side_by_side_is_no_baked_curve() -> None:
    armature = take()
    armature.pose.bones["finger"]["smile"] = 0.0
    for frame, value in ((10, 0.0), (45, 0.0), (46, 1.0), (90, 1.0)):
        armature.pose.bones["finger"]["smile"] = value
        armature.pose.bones["finger"].keyframe_insert('["smile"]', frame=frame)
    write_result(armature, later(read_recording(armature)), name="Result")
    smile = keys_of(armature)['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 1].tolist() == [0.0, 0.0, 1.0, 1.0]


def test_markers_and_other_slots_go_along_in_time() -> None:
    armature = take()
    action = armature.animation_data.action
    action.pose_markers.new("Early").frame = 20
    action.pose_markers.new("Late").frame = 80
    if bpy.app.version >= (4, 4):
        face = action.slots.new("KEY", "Face")
        bag = action.layers[0].strips[0].channelbag(face, ensure=True)
        smile = bag.fcurves.new('key_blocks["smile"].value')
        smile.keyframe_points.insert(20.0, 0.0)
        smile.keyframe_points.insert(80.0, 1.0)
    result, _ = write_result(armature, later(read_recording(armature)), name="Result")
    assert [marker.frame for marker in result.pose_markers] == [20, 83]
    assert [marker.frame for marker in action.pose_markers] == [20, 80]
    if bpy.app.version >= (4, 4):
        curves = [c for c in all_curves(result) if "smile" in c.data_path]
        assert fcurves.keys(curves[0]).tolist() == [[20.0, 0.0], [83.0, 1.0]]


def test_sparse_curves_keep_their_keys_and_what_is_between_them() -> None:
    armature = take(every=7)
    before, recording = keys_of(armature), read_recording(armature)
    write_result(armature, motion(recording), name="Result")
    after, now = keys_of(armature), read_recording(armature)
    for channel, keys in before.items():
        frames = set(after[channel][:, 0])
        own = keys[(keys[:, 0] <= FIRST - BLEND) | (keys[:, 0] >= LAST + BLEND)]
        assert {row.tobytes() for row in own} <= {row.tobytes() for row in after[channel]}, channel
        assert frames >= set(own[:, 0])
    outer = (recording.frames <= FIRST - BLEND) | (recording.frames >= LAST + BLEND)
    np.testing.assert_allclose(now.heads[outer], recording.heads[outer], atol=1e-6)


@pytest.mark.parametrize(
    ("first", "last"), [(1, 60), (3, 60), (40, LENGTH), (40, LENGTH - 3), (1, LENGTH)]
)
def test_blends_end_with_the_take(first: int, last: int) -> None:
    armature = take()
    recording = read_recording(armature)
    part = recording.window(first, last)
    bones = [recording.index(bone) for bone in rigs.MOVING]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], part.heads[:, 0] + SHIFT)
    times = TimeMap((first, last), (first, last))
    write_result(armature, AdaptedMotion(track, times, None, OPTIONS), name="Result")
    now = read_recording(armature)
    assert now.frames.tolist() == recording.frames.tolist()
    rows = slice(first - 1, last)
    np.testing.assert_allclose(now.heads[rows, 0], track.root_head, atol=2e-6)
    assert np.abs(np.diff(now.heads[:, 0] - recording.heads[:, 0], axis=0)).max() < 0.01


def test_no_blend_reaches_into_another_adaptation_of_the_take() -> None:
    armature = take()
    before, recording = keys_of(armature), read_recording(armature)
    asked = replace(motion(recording), kept=((10.0, 37.0), (63.0, 70.0)))
    write_result(armature, asked, name="Result")
    after = keys_of(armature)
    for channel, keys in before.items():
        assert outside(after[channel], 37.0, 63.0) == outside(keys, 37.0, 63.0)


@pytest.mark.parametrize("keyed", [(), (1,), (LENGTH,)])
def test_without_blends_a_bone_that_is_hardly_keyed_stays_as_it_was(keyed: tuple[int, ...]) -> None:
    armature = take()
    curves = fcurves.holder(armature).fcurves
    for curve in [c for c in curves if fcurves.bone_of(c.data_path) == "foot"]:
        curves.remove(curve)
    foot = armature.pose.bones["foot"]
    foot.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
    for frame in keyed:
        foot.keyframe_insert("rotation_quaternion", frame=frame)
    recording = read_recording(armature)
    asked = motion(recording, blend_in=0.0, blend_out=0.0)
    asked.track.rotations[:, -1] = TURN @ asked.track.rotations[:, -1]  # the foot's, by itself
    write_result(armature, asked, name="Result")
    now = read_recording(armature)
    outer = (recording.frames < FIRST) | (recording.frames > LAST)
    np.testing.assert_allclose(now.rotations[outer], recording.rotations[outer], atol=1e-6)
    rows, bones = slice(FIRST - 1, LAST), [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)


def spoilt_by_a_modifier(curve: bpy.types.FCurve) -> None:
    curve.modifiers.new("NOISE")


def spoilt_by_muting(curve: bpy.types.FCurve) -> None:
    curve.mute = True


@pytest.mark.parametrize("spoil", [spoilt_by_a_modifier, spoilt_by_muting])
def test_modifiers_become_keys(spoil: Callable[[bpy.types.FCurve], None]) -> None:
    armature = take("XYZ")
    spoil(next(c for c in fcurves.curves_of(armature) if fcurves.bone_of(c.data_path) == "shin"))
    recording = read_recording(armature)
    asked = motion(recording)
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert written.applied == ("shin",)
    now = read_recording(armature)
    rows = slice(FIRST - 1, LAST)
    bones = [now.index(bone) for bone in rigs.MOVING]
    np.testing.assert_allclose(now.rotations[rows][:, bones], asked.track.rotations, atol=5e-6)
    outer = (recording.frames < FIRST - BLEND) | (recording.frames > LAST + BLEND)
    np.testing.assert_allclose(now.rotations[outer], recording.rotations[outer], atol=5e-6)


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_a_full_turn_more_does_not_spin_back(mode: str) -> None:
    """Between the last new key and the take's next one, too."""
    armature = take(mode)
    recording = read_recording(armature)
    asked = motion(recording)
    spin = np.clip((asked.track.frames - FIRST) / (LAST - FIRST), 0.0, 1.0)
    spun = axis_rotation(2, 2.0 * np.pi * spin**2 * (3.0 - 2.0 * spin))
    track = replace(asked.track, rotations=spun[:, None] @ asked.track.rotations)
    write_result(armature, replace(asked, track=track), name="Result")
    end = round(LAST + BLEND)
    for frame in np.arange(LAST - 1, end + 2, 0.5):
        one, two = (
            np.array(rigs.world_of(armature, "spine", at).to_3x3()) for at in (frame, frame + 0.5)
        )
        assert np.linalg.norm(rotation_vector(two @ one.T)) < 0.2


def test_after_a_hold_that_ends_nothing_follows() -> None:
    armature = take()
    recording = read_recording(armature)
    write_result(armature, replace(motion(recording), ends=True), name="Result")
    assert read_recording(armature).frames[[0, -1]].tolist() == [1.0, LAST]


def test_cut_leaves_the_adapted_frames_alone() -> None:
    armature = take()
    asked = motion(read_recording(armature), after=After.CUT)
    action, written = write_result(armature, asked, name="Result")
    assert written is None
    assert action.frame_range.to_tuple() == (FIRST, LAST)


@pytest.mark.parametrize(
    ("ends", "after", "cyclic", "now"),
    [
        ((1.0, LENGTH), After.CARRY, True, (1.0, LENGTH)),
        ((FIRST, LAST - 5.0), After.CARRY, False, (FIRST, LAST)),
        ((1.0, LAST + BLEND - 2.0), After.CARRY, False, (1.0, LAST + BLEND - 2.0)),
        ((1.0, LENGTH), After.CUT, False, (FIRST, LAST)),
    ],
)
def test_a_manual_frame_range_holds_the_adapted_frames(
    ends: tuple[float, float], after: After, cyclic: bool, now: tuple[float, float]
) -> None:
    """Exports go by it: half of two adapted cycles was left out, as a loop."""
    armature = take()
    recorded = armature.animation_data.action
    asked = motion(read_recording(armature), after=after)
    recorded.use_frame_range = recorded.use_cyclic = True
    recorded.frame_start, recorded.frame_end = ends
    action, _ = write_result(armature, asked, name="Result")
    assert action.use_cyclic == cyclic
    assert (action.frame_start, action.frame_end) == now


def sized() -> bpy.types.Object:
    """A take whose thigh changes its size from frame to frame."""
    armature = take()
    thigh = armature.pose.bones["thigh"]
    for frame in range(1, LENGTH + 1):
        thigh.scale.y = 1.0 + 0.1 * np.sin(0.3 * frame)
        thigh.keyframe_insert("scale", frame=frame)
    return armature


SIZE = ('pose.bones["thigh"].scale', 1)


def test_a_size_that_changes_holds_still_in_the_adapted_frames_and_is_blended() -> None:
    armature = sized()
    before = keys_of(armature)
    write_result(armature, motion(read_recording(armature)), name="Result")
    was, now = before[SIZE], keys_of(armature)[SIZE]
    np.testing.assert_array_equal(now[:, 0], was[:, 0])
    frames, sizes, recorded = now[:, 0], now[:, 1], was[:, 1]
    inside = (frames >= FIRST) & (frames <= LAST)
    outside = (frames <= FIRST - BLEND) | (frames >= LAST + BLEND)
    assert sizes[outside].tobytes() == recorded[outside].tobytes()
    np.testing.assert_allclose(sizes[inside], np.median(recorded[inside]), atol=1e-6)
    assert np.abs(np.diff(sizes)).max() < 0.06  # no step at the seams; recorded 0.03 a frame


@pytest.mark.parametrize("options", [{"lock_others": True}, {"after": After.CUT}, {}])
def test_sizes_hold_at_the_recordings_median_whatever_the_durations(options) -> None:
    armature = sized()
    recorded = keys_of(armature)[SIZE][FIRST - 1 : LAST, 1]
    _, written = write_result(armature, later(read_recording(armature), **options), name="Result")
    assert written is None or written.held == ("thigh",)
    keys = keys_of(armature)[SIZE]
    sizes = keys[(keys[:, 0] >= FIRST) & (keys[:, 0] <= LAST), 1]
    np.testing.assert_allclose(sizes, np.median(recorded), atol=1e-6)
