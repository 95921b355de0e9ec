"""A rig that follows another armature in some frames, in which none of its controls does anything,
and is posed by them in others."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import record
from hangtime.bridge.controls.control_rig import control_poses, found_controls
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import PoseTrack
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.ik_rig import ik_rig

FRAMES = np.arange(1.0, 9.0)
FOLLOWS = FRAMES < 5.0
HIGHER = 0.02  # m

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def following() -> bpy.types.Object:
    """A rig that is switched from a mocap armature to its own controls, both with moving hips."""
    rigs.reset()
    mocap, rig = ik_rig(), ik_rig()
    for each in (mocap, rig):
        hips = each.pose.bones["hips"]
        for frame in (FRAMES[0], FRAMES[-1]):
            hips.location.y = -0.05 - 0.01 * frame
            hips.keyframe_insert("location", frame=frame)
    for bone in rig.pose.bones:
        follow = bone.constraints.new("COPY_TRANSFORMS")
        follow.target, follow.subtarget = mocap, bone.name
        for frame, follows in zip(FRAMES, FOLLOWS, strict=True):
            follow.influence = float(follows)
            follow.keyframe_insert("influence", frame=frame)
    return rig


def test_where_no_control_does_anything_what_lacks_is_told(following: bpy.types.Object) -> None:
    take = record(following, FRAMES)
    columns = [segment.bone for segment in map_anatomy(take.bones)]
    bodies = tuple(take.bones[c].name for c in columns)
    higher = take.heads[:, columns[0]] + [0.0, 0.0, HIGHER]
    track = PoseTrack(FRAMES, bodies, take.rotations[:, columns], higher)
    rig = complete(found_controls(following, bodies, FRAMES))
    posed = complete(control_poses(rig, sample(following, FRAMES), track))
    off = posed.off.max(axis=1)
    np.testing.assert_allclose(off[FOLLOWS], HIGHER, atol=1e-4)
    assert off[~FOLLOWS].max() < 1e-3
