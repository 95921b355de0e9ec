"""Motions with one damage each are examined, repaired, and where it tells more, adapted."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.fcurves import curves_of, put, table
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.repairs.stored import finding_of, findings, is_applied
from hangtime.solver.doctor.examination.repair import as_asked
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.operators.recording.damages import kinds
from hangtime.tests.helpers.clips import JUMP_FRAMES, mocap_path

pytestmark = pytest.mark.usefixtures("_enabled")


def legs_exchanged(source: Path, target: Path, frames: slice) -> Path:
    """A copy of a BVH file in which each leg has the other's angles."""
    head, rows = source.read_text().split("Frame Time:")
    clock, *lines = rows.strip().splitlines()
    joints = re.findall(r"(?:ROOT|JOINT) (\S+)", head)
    values = np.array([line.split() for line in lines], float)
    for part in ("Hip", "Knee", "Ankle", "Toe"):
        left, right = (
            slice(3 * joints.index(side + part) + 3, 3 * joints.index(side + part) + 6)
            for side in ("Left", "Right")
        )
        values[frames, left], values[frames, right] = (
            values[frames, right].copy(),
            values[frames, left].copy(),
        )
    changed = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in values)
    target.write_text(f"{head}Frame Time: {clock.strip()}\n{changed}\n")
    return target


@pytest.mark.slow
def test_legs_that_were_exchanged_in_a_file_are_exchanged_back(tmp_path) -> None:
    rigs.reset()
    source = mocap_path("131_03_hop.bvh")
    whole = read_recording(import_clip(source).armature)
    rigs.reset()
    clip = legs_exchanged(source, tmp_path / "exchanged.bvh", slice(280, 320))
    hop = import_clip(clip).armature
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(hop) == ["exchanged legs", "sliding feet"]  # as they are: he turns on them
    found = finding_of(hop.hangtime.findings["exchanged legs"])
    assert found.frames == ((281.0, 320.0),)
    assert bpy.ops.hangtime.repair(kind="exchanged legs") == {"FINISHED"}
    recording = read_recording(hop)
    mended = as_asked(recording, problem_of(hop.hangtime, recording))
    assert np.abs(recording.heads - whole.heads).max() > 0.3
    assert np.abs(mended.heads - whole.heads).max() < 0.05
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert is_applied(hop.hangtime, hop.hangtime.findings["exchanged legs"])


@pytest.mark.slow
def test_a_body_that_drifts_upwards_is_held_level_and_goes_on_where_it_was(jump) -> None:
    """What follows the adapted frames drifts still; it is moved so that nothing jumps."""
    rise = 0.1
    for curve in curves_of(jump):
        if 'Hips"' in curve.data_path and curve.data_path.endswith("location"):
            hips = jump.data.bones["Hips"].matrix_local.to_3x3()
            turn = np.linalg.inv(np.array(jump.matrix_world.to_3x3() @ hips))
            keys = table(curve)
            seconds = (keys["co"][:, 0] - 1.0) / 120.0
            keys["co"][:, 1] += rise * seconds * turn[curve.array_index, 2]
            put(curve, keys)
    settings = jump.hangtime
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert kinds(jump) == ["rising"]
    assert finding_of(settings.findings["rising"]).amount == pytest.approx(rise, abs=0.015)
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert settings.unseen == ""
    settings.stances["ground 2"].forward = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    heights = read_recording(jump).heads[:, 0, 2]
    bends = np.abs(np.diff(heights, 2))[settings.last_frame - 20 :]
    assert bends.max() < 4e-3  # at 120 frames a second
    taken_out = rise * (settings.last_frame - settings.first_frame) / 120.0
    recorded = read_recorded(jump, None, None).heads[-1, 0, 2]
    assert recorded - heights[-1] == pytest.approx(taken_out, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bone", "attribute", "usual"), [("Spine", "scale", 1.0), ("LeftFoot", "location", 0.0)]
)
def test_a_length_is_told_by_the_bone_whose_keys_change_it(
    jump: bpy.types.Object, bone: str, attribute: str, usual: float
) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    jump.data.edit_bones[bone].use_connect = False  # else its location does not count
    bpy.ops.object.mode_set(mode="OBJECT")
    for frame, more in ((150, 0.0), (200, 0.2), (250, 0.0)):
        setattr(jump.pose.bones[bone], attribute, [usual + more] * 3)
        jump.pose.bones[bone].keyframe_insert(attribute, frame=frame)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    found = {row.name: finding_of(row) for row in findings(jump.hangtime)}
    assert found["bone length"].part == bone


@pytest.mark.slow
def test_hips_that_keep_one_place_get_height_and_way_back_and_are_adapted(
    jump: bpy.types.Object,
) -> None:
    """As capture by video has them that tells all places from the hips."""
    recorded = read_recorded(jump, *JUMP_FRAMES).heads[:, 0]
    hips = jump.pose.bones[0].name
    for curve in curves_of(jump):
        if curve.data_path == f'pose.bones["{hips}"].location':
            for key in curve.keyframe_points:
                key.co[1] = 0.0
            curve.update()
    before = keys_digest(action := jump.animation_data.action)
    assert bpy.ops.hangtime.examine() == {"FINISHED"}
    assert {"level hips", "in place"} <= set(kinds(jump))
    assert bpy.ops.hangtime.repair_all() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert keys_digest(action) == before
    adapted = read_recording(jump).heads[:, 0]
    assert [each.name for each in jump.hangtime.stances] == ["ground 1", "ground 2"]
    assert np.ptp(adapted[:, 2]) == pytest.approx(np.ptp(recorded[:, 2]), rel=0.1)
    way, wanted = (np.linalg.norm((each[-1] - each[0])[:2]) for each in (adapted, recorded))
    assert way == pytest.approx(wanted, rel=0.3)
