"""Bones outside of the body that go along with it: a root bone, and what keeps its place on it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import showing_action
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.poses import Poses, sample
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.polish.renewal import Renewal
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.made import note_made
from hangtime.bridge.rows.choices import After, Engine, RootMotion, WrittenAs
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.span import WrittenTake
from hangtime.bridge.takes.write_result import (
    combine,
    write_adapted_incrementally,
    write_result,
)
from hangtime.operators.words.take_text import take_lines, take_record
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.data.stance_move import StanceMove
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.figures.company import FRAMES, LENGTH, ON, at, beside, take

pytestmark = pytest.mark.usefixtures("_enabled")

FIRST, LAST = 20, 35
AHEAD = StanceMove("ground 2", (0.0, 0.0, 0.0), 0.0, (0.0, -0.4, 0.0))
TURNED = StanceMove("ground 2", (0.3, -0.2, 0.0), 0.5, (0.1, -0.4, 0.2))
# The tests of the others are CI's.
LATER = [pytest.param(m, marks=pytest.mark.slow) for m in ("XYZ", "AXIS_ANGLE")]


def moved(armature: bpy.types.Object, move: StanceMove, **options: object) -> AdaptedMotion:
    """The take's frames, moved more and more with a stance, and each bone a little bent."""
    poses = sample(armature, np.arange(float(FIRST), LAST + 1.0))
    frames = np.arange(float(FIRST), LAST + 1.0)
    share = (frames - FIRST) / (LAST - FIRST)
    share = share**2 * (3.0 - 2.0 * share)
    turn = axis_rotation(2, move.turn * share)
    bends = [axis_rotation(0, 0.05 * k * np.sin(np.pi * share)) for k in range(len(rigs.MOVING))]
    parts = [
        turn @ bend @ at(poses, bone)[:, :3, :3]
        for bone, bend in zip(rigs.MOVING, bends, strict=True)
    ]
    head = at(poses, "hips")[:, :3, 3] - move.pivot
    head = np.einsum("tij,tj->ti", turn, head) + move.pivot + share[:, None] * move.shift
    times = TimeMap((FIRST, LAST), (FIRST, LAST))
    wanted = replace(ResultOptions(blend_in=6.0, blend_out=6.0), **options)
    return AdaptedMotion(
        PoseTrack(frames, rigs.MOVING, np.stack(parts, axis=1), head), times, move, wanted
    )


def written(
    armature: bpy.types.Object, move: StanceMove, **options: object
) -> tuple[Poses, WrittenTake | None]:
    """A result as Blender shows it."""
    _, made = write_result(armature, moved(armature, move, **options), name="Result")
    return sample(armature, FRAMES), made


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "AXIS_ANGLE"])
@pytest.mark.parametrize("root", ["along", "still"])
@pytest.mark.parametrize(("move", "back"), [(AHEAD, False), (TURNED, False), (TURNED, True)])
def test_helper_bones_stay_on_the_body(mode: str, root: str, move: StanceMove, back: bool) -> None:
    """In the adapted frames, the blends, what is carried along and on the way back."""
    armature = take(mode, root=root)
    was = sample(armature, FRAMES)
    options = {"after": After.RETURN, "return_frame": 52.0} if back else {}
    now, made = written(armature, move, **options)
    assert np.abs(at(now, "foot") - at(was, "foot")).max() > 0.3
    for bone, body in ON.items():
        np.testing.assert_allclose(beside(now, bone, body), beside(was, bone, body), atol=2e-5)
    assert made is not None
    assert dict(made.companions.followers) == ON
    if back:
        np.testing.assert_allclose(at(now, "ik_head")[52:], at(was, "ik_head")[52:], atol=1e-5)


@pytest.mark.parametrize("mode", ["QUATERNION", *LATER])
@pytest.mark.parametrize("move", [AHEAD, TURNED])
def test_a_root_bone_stays_under_the_hips_as_in_the_take(mode: str, move: StanceMove) -> None:
    armature = take(mode)
    was = sample(armature, FRAMES)
    asked = moved(armature, move)
    _, made = write_result(armature, asked, name="Result")
    now = sample(armature, FRAMES)
    assert made is not None
    assert made.companions.root == "root"
    apart, before = (at(p, "hips")[:, :3, 3] - at(p, "root")[:, :3, 3] for p in (now, was))
    rest = FRAMES > LAST + 6
    turn = axis_rotation(2, move.turn)
    np.testing.assert_allclose(apart[rest, :2], (before[rest] @ turn.T)[:, :2], atol=1e-5)
    if not move.turn:
        np.testing.assert_allclose(apart[:, :2], before[:, :2], atol=1e-5)
    turned = at(now, "root")[rest, :3, :3] @ np.swapaxes(at(was, "root")[rest, :3, :3], 1, 2)
    np.testing.assert_allclose(turned, np.broadcast_to(turn, turned.shape), atol=1e-5)
    np.testing.assert_allclose(at(now, "root")[:, 2], at(was, "root")[:, 2], atol=1e-5)
    rows = slice(FIRST - 1, LAST)
    hips = at(now, "hips")[rows]
    np.testing.assert_allclose(hips[:, :3, 3], asked.track.root_head, atol=1e-5)
    for column, bone in enumerate(rigs.MOVING):
        wanted = asked.track.rotations[:, column]
        np.testing.assert_allclose(at(now, bone)[rows, :3, :3], wanted, atol=1e-5)
    steps = np.linalg.norm(np.diff(at(now, "root")[:, :3, 3], 2, axis=0), axis=1)
    assert steps.max() < 0.05  # without a jump at any seam
    np.testing.assert_allclose(beside(now, "prop", "root"), beside(was, "prop", "root"), atol=1e-5)


@pytest.mark.parametrize("root", ["still", "other"])
def test_a_root_bone_that_does_not_travel_with_the_hips_stays(root: str) -> None:
    armature = take(root=root)
    was = sample(armature, FRAMES)
    now, made = written(armature, AHEAD)
    assert made is not None
    assert made.companions.root is None
    np.testing.assert_array_equal(at(now, "root"), at(was, "root"))
    np.testing.assert_array_equal(at(now, "prop"), at(was, "prop"))


def test_bones_that_do_not_follow_or_follow_by_a_constraint_keep_their_keys() -> None:
    armature = take(root="still")
    constraint = armature.pose.bones["ik_foot"].constraints.new("COPY_TRANSFORMS")
    constraint.target, constraint.subtarget = armature, "foot"
    gun = armature.pose.bones["ik_gun"]
    gun.location.x += 0.1
    gun.keyframe_insert("location", frame=30)  # it leaves its place for a moment
    gun.keyframe_insert("location", frame=31)
    gun.keyframe_insert("location", frame=32)
    before = keys(armature)
    now, made = written(armature, AHEAD)
    assert made is not None
    assert "ik_foot" not in made.companions.bones
    assert "ik_gun" not in made.companions.bones
    assert "prop" not in made.companions.bones
    after = keys(armature)
    for bone in ("ik_foot", "ik_gun", "prop", "ik_root", "root"):
        for path in (path for path in before if fcurves.bone_of(path[0]) == bone):
            np.testing.assert_array_equal(after[path], before[path])
    assert np.abs(at(now, "ik_foot") - at(now, "foot"))[:, :3, 3].max() < 1e-5


@pytest.mark.parametrize("hidden", ["ik_gun", "head"])
def test_what_a_scale_of_zero_hides_follows_nothing_and_is_not_followed(hidden: str) -> None:
    armature = take()
    bone = armature.pose.bones[hidden]
    bone.scale = (0.0, 0.0, 0.0)
    bone.keyframe_insert("scale", frame=1)
    _, made = written(armature, AHEAD)
    assert made is not None
    followers = dict(made.companions.followers)
    assert followers["ik_foot"] == "foot"
    assert hidden not in followers.keys() | followers.values()


def keys(armature: bpy.types.Object) -> dict[tuple[str, int], np.ndarray]:
    """Frames and values of every key, by channel."""
    return {(c.data_path, c.array_index): fcurves.keys(c) for c in fcurves.curves_of(armature)}


def test_helper_bones_are_on_the_body_where_the_adapted_frames_are_alone() -> None:
    armature = take()
    was = sample(armature, FRAMES)
    now, _ = written(armature, AHEAD, after=After.CUT)
    rows = slice(FIRST - 1, LAST)
    assert {float(each[0, 0]) for each in keys(armature).values()} == {float(FIRST)}
    for bone, body in ON.items():
        apart = beside(now, bone, body)[rows] - beside(was, bone, body)[rows]
        assert np.abs(apart).max() < 2e-5
    apart = at(now, "hips")[rows, :2, 3] - at(now, "root")[rows, :2, 3]
    before = at(was, "hips")[rows, :2, 3] - at(was, "root")[rows, :2, 3]
    np.testing.assert_allclose(apart, before, atol=1e-5)


@pytest.mark.parametrize("alone", [False, True])
def test_they_go_with_the_body_where_durations_change(alone: bool) -> None:
    """Whether other channels keep their times or not."""
    armature = take()
    was = beside(sample(armature, FRAMES), "ik_foot", "foot")
    asked = moved(armature, AHEAD, lock_others=alone)
    track = asked.track
    rows = np.linspace(0, len(track.frames) - 1, len(track.frames) + 6).round().astype(int)
    frames = FIRST + np.arange(float(len(rows)))
    longer = PoseTrack(frames, track.bones, track.rotations[rows], track.root_head[rows])
    times = TimeMap((FIRST, LAST), (FIRST, LAST + 6.0))
    write_result(armature, replace(asked, track=longer, times=times), name="Result")
    now = sample(armature, np.arange(1.0, LENGTH + 7.0))
    apart = beside(now, "ik_foot", "foot") - was.mean(axis=0)
    assert np.abs(apart[:, :3, 3]).max() < 5e-3  # of keys between frames, a chord
    hips, root = at(now, "hips")[:, :2, 3], at(now, "root")[:, :2, 3]
    assert np.abs(hips - root).max() < 0.5


def test_of_a_cut_take_nothing_is_told_of_the_rest() -> None:
    armature = take()
    _, made = written(armature, AHEAD, after=After.CUT)
    assert made is not None
    told = "\n".join(take_lines(made))
    assert f"Take: frames {FIRST} to {LAST} are adapted" in told
    assert "Blended" not in told
    assert "What follows" not in told
    assert take_record(made)["take_frames"] == [FIRST, LAST]


def test_it_is_told_in_words_and_in_the_report() -> None:
    _, made = written(take(), AHEAD)
    assert made is not None
    lines = take_lines(made)
    assert "root goes along with the hips over the floor, as in the take" in lines
    assert (
        "Kept where they are on the body in the take: ik_foot (foot), ik_gun (thigh), "
        "ik_head (head)" in lines
    )
    record = take_record(made)
    assert (record["root_along"], record["bones_kept_on_body"]) == ("root", ON)
    _, plain = written(take(root="still", baked=False), AHEAD)
    assert not [line for line in take_lines(plain) if "goes along" in line or "Kept" in line]


@pytest.mark.slow
def test_a_file_for_an_engine_has_the_root_under_the_hips_and_helpers_on_the_body(
    tmp_path: Path,
) -> None:
    armature = take()
    was = sample(armature, FRAMES)
    now, _ = written(armature, AHEAD)
    path, options = tmp_path / "jump.fbx", ExportOptions(Engine.UNREAL, root=RootMotion.AS_IT_IS)
    export_takes(armature, [armature.animation_data.action], path, options, "hips")
    again = reimport(path, FRAMES, begins=FRAMES[0])
    place = {
        bone: again.heads[:, again.index(bone)] for bone in ("hips", "root", *ON, *ON.values())
    }
    for bone in place:
        np.testing.assert_allclose(place[bone], at(now, bone)[:, :3, 3], atol=1e-4)
    for bone, body in ON.items():
        np.testing.assert_allclose(place[bone], place[body], atol=1e-4)
    before = at(was, "hips")[:, :2, 3] - at(was, "root")[:, :2, 3]
    np.testing.assert_allclose((place["hips"] - place["root"])[:, :2], before, atol=1e-4)
    travelled = place["root"][-1] - place["root"][0]
    np.testing.assert_allclose(travelled, [0.0, -1.9, 0.0], atol=1e-3)


def renewed(armature: bpy.types.Object, move: StanceMove, **options: object) -> bpy.types.Action:
    """A result with the polish of the one before it, as it is made in a session."""
    motion, renewal = moved(armature, move, **options), Renewal.of(armature)
    action, made = complete(write_adapted_incrementally(armature, motion))
    assert made is not None
    no_contacts = ContactSchedule((), 1.0, 0.0)
    complete(renewal.put_on(action, made.owned, made.time, no_contacts, 24.0))
    if motion.options.written_as is WrittenAs.COMBINE:
        combine(armature, action, motion.options.after)
    note_made(armature, action, made.span, made.time.later)
    renewal.note(action, made.time, (float(FIRST), float(LAST)))
    return action


def test_polish_of_a_helper_bone_is_put_on_where_it_is_now() -> None:
    armature = take()
    bpy.context.scene.hangtime.armature = armature
    recording = armature.animation_data.action
    was = sample(armature, FRAMES)
    renewed(armature, AHEAD)
    helper = armature.pose.bones["ik_foot"]
    for frame in range(25, 31):
        bpy.context.scene.frame_set(frame)
        helper.location.x += 0.1
        helper.keyframe_insert("location", frame=frame)
    with showing_action(armature, recording):
        further = moved(armature, replace(AHEAD, shift=(0.0, -0.8, 0.0)))
    assert further.moved is not None
    renewed(armature, further.moved)
    now = sample(armature, FRAMES)
    apart = (beside(now, "ik_foot", "foot") - beside(was, "ik_foot", "foot"))[:, :3, 3]
    off = np.linalg.norm(apart, axis=1)
    np.testing.assert_allclose(off[24:30], 0.1, atol=1e-4)
    assert max(off[:23].max(), off[31:].max()) < 1e-4


def test_a_difference_on_the_take_has_them_too() -> None:
    armature = take()
    bpy.context.scene.hangtime.armature = armature
    was = sample(armature, FRAMES)
    renewed(armature, AHEAD, written_as=WrittenAs.COMBINE)
    now = sample(armature, FRAMES)
    assert np.abs(at(now, "foot") - at(was, "foot")).max() > 0.3
    for bone, body in ON.items():
        np.testing.assert_allclose(beside(now, bone, body), beside(was, bone, body), atol=2e-3)
    apart, before = (at(p, "hips")[:, :2, 3] - at(p, "root")[:, :2, 3] for p in (now, was))
    np.testing.assert_allclose(apart, before, atol=1e-4)
