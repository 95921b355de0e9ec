"""A cycle as an action: played over and over, in place, and on a root bone."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import record
from hangtime.bridge.loops.write_loop import Loop
from hangtime.bridge.rows.choices import LoopRoot
from hangtime.solver.data.faults import NoRootBone
from hangtime.solver.data.recording import PoseTrack
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.figures.cycle import FRAMES, TRAVEL, cycle, looped

pytestmark = pytest.mark.usefixtures("_enabled")

CLOSE = 2e-5  # m and rad; single precision


def made(mode: str = "QUATERNION", *, root: bool = True) -> bpy.types.Object:
    """A rig whose recording moves all of it, its root and its object too."""
    rigs.reset()
    armature = rigs.make_armature(rigs.with_root() if root else rigs.BODY)
    rigs.animate(armature, mode, frames=range(1, 40))
    armature.location = (0.2, 0.0, 0.1)
    armature.keyframe_insert("location", frame=1)
    armature.location = (0.5, 0.3, 0.1)
    armature.keyframe_insert("location", frame=30)
    return armature


def shown(armature: bpy.types.Object, track: PoseTrack, frames: np.ndarray) -> np.ndarray:
    """(T, bones, 3) m, heads of the bones that move."""
    seen = record(armature, frames)
    return seen.heads[:, [seen.index(bone) for bone in track.bones]]


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "AXIS_ANGLE"])
def test_every_repetition_goes_on_from_the_last(mode: str) -> None:
    armature = made(mode)
    track, _ = looped(armature, LoopRoot.HIPS)
    seen = record(armature, FRAMES)
    bones = [seen.index(bone) for bone in track.bones]
    np.testing.assert_allclose(seen.heads[:, bones[0]], track.root_head, atol=CLOSE)
    np.testing.assert_allclose(seen.rotations[:, bones], track.rotations, atol=CLOSE)
    between = np.arange(FRAMES[0], FRAMES[-1], 0.25)
    once = shown(armature, track, between)
    for times in (1.0, 2.0, -1.0):
        again = shown(armature, track, between + times * (len(FRAMES) - 1))
        np.testing.assert_allclose(again, once + times * TRAVEL, atol=2.0 * CLOSE)


def test_what_moves_a_joint_holds_still() -> None:
    armature = made()
    thigh = armature.pose.bones["thigh"]
    for frame in range(1, 40):
        thigh.scale.y = 1.0 + 0.1 * np.sin(0.3 * frame)
        thigh.keyframe_insert("scale", frame=frame)
    track, _ = looped(armature, LoopRoot.HIPS)
    heads = shown(armature, track, FRAMES)
    thighs = (heads[:, track.bones.index(bone)] for bone in ("shin", "thigh"))
    assert np.ptp(np.linalg.norm(np.subtract(*thighs), axis=1)) < CLOSE


def test_speed_goes_on_across_the_seam() -> None:
    armature = made()
    track, _ = looped(armature, LoopRoot.HIPS)
    step = 0.05
    at = shown(armature, track, FRAMES[-1] + step * np.arange(-2.0, 3.0))
    before = (3.0 * at[2] - 4.0 * at[1] + at[0]) / (2.0 * step)
    after = (-3.0 * at[2] + 4.0 * at[3] - at[4]) / (2.0 * step)
    np.testing.assert_allclose(after, before, atol=1e-4)  # m a frame, of 0.1


def test_in_place_leaves_the_steady_travel_out() -> None:
    armature = made(root=False)
    track, _ = looped(armature, LoopRoot.IN_PLACE)
    steady = np.linspace(0.0, 1.0, len(FRAMES))[:, None] * TRAVEL
    first = shown(armature, track, FRAMES)
    np.testing.assert_allclose(first[:, 0], track.root_head - steady, atol=CLOSE)
    again = shown(armature, track, FRAMES + len(FRAMES) - 1)
    np.testing.assert_allclose(again, first, atol=CLOSE)


def test_root_bone_carries_the_travel_at_a_steady_speed() -> None:
    armature = made()
    track, _ = looped(armature, LoopRoot.ROOT_BONE)
    np.testing.assert_allclose(shown(armature, track, FRAMES)[:, 0], track.root_head, atol=CLOSE)
    frames = np.arange(FRAMES[0], FRAMES[-1] + 30.0)
    seen = record(armature, frames)
    root = seen.heads[:, seen.index("root")]
    speed = TRAVEL / (len(FRAMES) - 1)
    np.testing.assert_allclose(
        np.diff(root, axis=0), np.tile(speed, (len(frames) - 1, 1)), atol=CLOSE
    )


@pytest.mark.parametrize("root", [LoopRoot.IN_PLACE, LoopRoot.ROOT_BONE])
def test_the_body_sways_about_a_root_that_rests_in_the_recording(root: LoopRoot) -> None:
    armature = made()
    holder = fcurves.holder(armature)
    for curve in [each for each in holder.fcurves if '"root"' in each.data_path]:
        holder.fcurves.remove(curve)
    armature.pose.bones["root"].matrix_basis.identity()
    recorded = record(armature, FRAMES[:1])
    track, _ = looped(armature, root)
    seen = record(armature, FRAMES)
    top, hips = (seen.heads[:, seen.index(name)] for name in ("root", "hips"))
    at_rest = np.subtract(*(armature.data.bones[n].head_local for n in ("hips", "root")))
    level = (hips - top).mean(axis=0)[:2]
    np.testing.assert_allclose(level, at_rest[:2], atol=CLOSE)
    if root is LoopRoot.IN_PLACE:
        still = np.tile(recorded.heads[0, recorded.index("root")], (len(FRAMES), 1))
        np.testing.assert_allclose(top, still, atol=CLOSE)
    else:
        np.testing.assert_allclose(hips, track.root_head, atol=CLOSE)


def test_a_rig_without_a_root_bone_is_refused() -> None:
    armature = made(root=False)
    with pytest.raises(NoRootBone):
        Loop.of(armature, cycle(armature), LoopRoot.ROOT_BONE)


def test_recording_stays_as_it_was() -> None:
    armature = made()
    take = current_action(armature)
    before = record(armature, FRAMES)
    looped(armature, LoopRoot.ROOT_BONE)
    fcurves.assign(armature, take, fcurves.slot_identifier(armature))
    after = record(armature, FRAMES)
    assert after.heads.tobytes() == before.heads.tobytes()
