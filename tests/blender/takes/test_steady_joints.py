"""Joints of a written action hold their places in the body above, whatever the recording's did."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.armature.write import remove, write_action
from hangtime.solver.data.recording import Recording
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import altered, assert_follows, snapshot

NEAR = 5e-4  # m, the median of turns from that of places


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


def rig() -> bpy.types.Object:
    """A thigh that hangs on a bone between it and the hips; only bodies move."""
    specs = [replace(s, parent="side") if s.name == "thigh" else s for s in rigs.BODY]
    side = rigs.BoneSpec("side", "hips", (0.0, 0.0, 1.0), (0.1, 0.0, 1.0))
    armature = rigs.make_armature([specs[0], side, *specs[1:]])
    rigs.animate(armature)
    for bone in ("side", *rigs.RIDING):
        path = armature.pose.bones[bone].path_from_id("rotation_quaternion")
        remove(fcurves.holder(armature), path)
        armature.pose.bones[bone].rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
    return armature


def sways(armature: bpy.types.Object, bone: str, attribute: str, size: float) -> None:
    """Key a property's second channel of a bone around its default."""
    posed = armature.pose.bones[bone]
    posed.rotation_mode = "XYZ" if attribute == "rotation_euler" else posed.rotation_mode
    usual = getattr(posed, attribute)[2]
    for frame in rigs.FRAMES:
        getattr(posed, attribute)[2] = usual + size * np.sin(0.5 * frame)
        posed.keyframe_insert(attribute, frame=frame)


def places(recording: Recording, bone: str, above: str) -> np.ndarray:
    """(T, 3) m, heads of a bone in the frame of another."""
    b, a = recording.index(bone), recording.index(above)
    apart = recording.heads[:, b] - recording.heads[:, a]
    return np.einsum("tji,tj->ti", recording.rotations[:, a], apart)


@pytest.mark.parametrize(
    ("bone", "attribute", "joint"),
    [
        ("side", "rotation_euler", ("thigh", "hips")),
        ("side", "location", ("thigh", "hips")),
        ("side", "scale", None),
        ("thigh", "location", ("thigh", "hips")),
        ("foot", "scale", None),
        ("hips", "scale", ("thigh", "hips")),
    ],
)
def test_what_moves_a_joint_holds_still(
    bone: str, attribute: str, joint: tuple[str, str] | None
) -> None:
    armature = rig()
    sways(armature, bone, attribute, 0.1)
    recorded, take = read_recording(armature), armature.animation_data.action
    before, track = snapshot(take, armature), altered(recorded)
    write_action(armature, track, name="Adapted")
    written = assert_follows(armature, track)
    path = armature.pose.bones[bone].path_from_id(attribute)
    curves = [curve for curve in fcurves.curves_of(armature) if curve.data_path == path]
    assert len(curves) == 3
    assert all(np.ptp(fcurves.keys(curve)[:, 1]) < 1e-6 for curve in curves)
    assert snapshot(take, armature) == before
    if joint is not None:
        now, was = places(written, *joint), places(recorded, *joint)
        assert np.ptp(was, axis=0).max() > 5e-3
        assert np.ptp(now, axis=0).max() < 1e-5
        np.testing.assert_allclose(now[0], np.median(was, axis=0), atol=NEAR)


def test_a_bone_that_turns_about_the_joint_keeps_its_keys() -> None:
    armature = rig()
    sways(armature, "twist", "rotation_euler", 0.3)  # the head's joint is where it turns about
    sways(armature, "finger", "location", 0.1)
    before = snapshot(armature.animation_data.action, armature)
    track = altered(read_recording(armature))
    action = write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    after = snapshot(action, armature)
    kept = [c for c in before if "twist" in c[0] or "finger" in c[0]]
    assert len(kept) == 6
    assert all(after[each] == before[each] for each in kept)
