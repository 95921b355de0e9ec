"""A real jump on rigs set up as files come: read as from the plain rig, and written."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.channels import channels
from hangtime.bridge.armature.pose_basis import basis_under
from hangtime.bridge.armature.poses import Poses, sample
from hangtime.bridge.armature.read import record
from hangtime.bridge.armature.write import write_action
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.solver.numerics.rotations import rotation_matrix, rotation_vector

FRAMES = np.arange(170.0, 200.0)  # around the take-off
BONES = ("Hips", "LowerBack", "Spine", "LeftUpLeg", "LeftLeg", "LeftFoot", "RightArm")
READ_M, WRITTEN_M, WRITTEN_RAD = 1e-4, 1e-3, np.radians(0.1)
SHIFTED = 0.37  # frames

SetUp = Callable[[bpy.types.Object], bpy.types.Object]


def plain() -> bpy.types.Object:
    return build(next(each for each in layouts() if each.key == "cmu"), actor())


@cache
def jump() -> Recording:
    return record(plain(), FRAMES)


@cache
def solution() -> PoseTrack:
    """The jump 0.2 m to the side, with its bones turned by up to 0.3 rad."""
    rng, recording = np.random.default_rng(3), jump()
    wave = np.sin((FRAMES - FRAMES[0]) / 9.0)[:, None]
    turned = [
        rotation_matrix(wave * rng.uniform(-0.3, 0.3, 3))
        @ recording.rotations[:, recording.index(bone)]
        for bone in BONES
    ]
    head = recording.heads[:, recording.index("Hips")] + [0.2, 0.0, 0.0]
    return PoseTrack(FRAMES, BONES, np.stack(turned, axis=1), head)


def inheriting(**flags: bool | str) -> SetUp:
    """Bones that inherit in part, with keys that pose them as the plain rig's."""

    def set_up(armature: bpy.types.Object) -> bpy.types.Object:
        poses = sample(armature, FRAMES)
        curves = fcurves.holder(armature)
        for name in ("Spine", "LeftLeg", "Hips"):
            bone = armature.data.bones[name]
            for flag, value in flags.items():
                setattr(bone, flag, value)
            _key(armature, curves, bone, poses)
        return armature

    return set_up


def _key(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    bone: bpy.types.Bone,
    poses: Poses,
) -> None:
    own = poses.matrices[:, poses.bones.index(bone.name)]
    above = bone.parent and poses.matrices[:, poses.bones.index(bone.parent.name)]
    basis = basis_under(bone, above, own)
    posed = armature.pose.bones[bone.name]
    for channel, values in (
        ("rotation_quaternion", channels(basis[:, :3, :3], "QUATERNION")),
        ("location", basis[:, :3, 3]),
    ):
        path = posed.path_from_id(channel)
        fcurves.write_channels(curves, path, FRAMES, values, bone.name)


def parented(*, animated: bool) -> SetUp:
    """Under a scaled and turned parent, whose movement the armature's own undoes."""

    def set_up(armature: bpy.types.Object) -> bpy.types.Object:
        parent = bpy.data.objects.new("Cart", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.scale, parent.rotation_euler = (2.5, 2.5, 2.5), (0.4, -0.2, 1.1)
        parent.location = (3.0, -1.0, 0.5)
        if animated:
            parent.keyframe_insert("location", frame=FRAMES[0])
            parent.keyframe_insert("rotation_euler", frame=FRAMES[0])
            parent.location, parent.rotation_euler = (5.0, 2.0, 1.0), (0.1, 0.3, 2.0)
            parent.keyframe_insert("location", frame=FRAMES[-1])
            parent.keyframe_insert("rotation_euler", frame=FRAMES[-1])
        armature.parent, armature.rotation_mode = parent, "QUATERNION"
        curves, own = fcurves.holder(armature), []
        for frame in FRAMES:
            bpy.context.scene.frame_set(int(frame))
            own.append(np.array(parent.matrix_world.inverted()))
        to = np.array(own)
        turn = channels(2.5 * to[:, :3, :3], "QUATERNION")
        for path, values in (("location", to[:, :3, 3]), ("rotation_quaternion", turn)):
            fcurves.write_channels(curves, path, FRAMES, values, "Object")
        armature.scale = (0.4, 0.4, 0.4)
        return armature

    return set_up


def in_centimetres(armature: bpy.types.Object) -> bpy.types.Object:
    bpy.context.scene.unit_settings.scale_length = 0.01
    armature.scale = (100.0, 100.0, 100.0)
    return armature


def with_slots(armature: bpy.types.Object) -> bpy.types.Object:
    """The action animates a camera as well, whose slot comes first by name."""
    action = armature.animation_data.action
    if not hasattr(action, "slots"):
        pytest.skip("actions have no slots before Blender 4.4")
    camera = bpy.data.objects.new("A Camera", None)
    bpy.context.scene.collection.objects.link(camera)
    camera.animation_data_create().action = action
    camera.animation_data.action_slot = action.slots.new("OBJECT", "A Camera")
    camera.location.x = 7.0
    camera.keyframe_insert("location", frame=FRAMES[0])
    return armature


def overridden(armature: bpy.types.Object) -> bpy.types.Object:
    """Linked from another file and overridden, with the action in this one."""
    name = armature.name
    with TemporaryDirectory() as folder:
        path = str(Path(folder) / "library.blend")
        bpy.data.libraries.write(path, {armature}, fake_user=True)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.render.fps = 120
        with bpy.data.libraries.load(path, link=True) as (_, wanted):
            wanted.objects = [name]
    linked = bpy.data.objects[name]
    scene.collection.objects.link(linked)
    made = linked.override_hierarchy_create(scene, bpy.context.view_layer)
    armature = made or linked
    assert armature.override_library is not None
    return armature


KINDS: dict[str, SetUp] = {
    "rotation not inherited": inheriting(use_inherit_rotation=False),
    "scale not inherited": inheriting(inherit_scale="NONE"),
    "location of the armature": inheriting(use_local_location=False),
    "scaled and turned parent": parented(animated=False),
    "animated parent": parented(animated=True),
    "centimetres": in_centimetres,
    "several slots": with_slots,
    "library override": overridden,
}


@pytest.mark.parametrize("set_up", KINDS.values(), ids=list(KINDS))
def test_an_odd_rig_is_read_and_written_as_the_plain_one(set_up: SetUp) -> None:
    expected, track = jump(), solution()
    armature = set_up(plain())
    _assert_near(record(armature, FRAMES), expected, FRAMES)
    write_action(armature, track, name="Solved")
    _assert_written(record(armature, FRAMES), track)


@pytest.mark.slow
def test_keys_between_frames_are_read_and_written_there() -> None:
    expected, track = jump(), solution()
    armature = plain()
    for curve in fcurves.curves_of(armature):
        for key in curve.keyframe_points:
            key.co.x += SHIFTED
            key.handle_left.x += SHIFTED
            key.handle_right.x += SHIFTED
    between = FRAMES + SHIFTED
    _assert_near(record(armature, between), expected, FRAMES)
    write_action(armature, PoseTrack(between, BONES, track.rotations, track.root_head), name="S")
    _assert_written(record(armature, between), track)


def test_other_slots_keep_their_keys() -> None:
    armature = with_slots(plain())
    write_action(armature, solution(), name="Solved")
    solved = armature.animation_data.action
    other = fcurves.holder_in(solved, "OBA Camera")
    assert other is not None
    assert [curve.evaluate(FRAMES[0]) for curve in other.fcurves] == [7.0, 0.0, 0.0]


def _assert_near(found: Recording, expected: Recording, frames: np.ndarray) -> None:
    columns = [found.index(bone.name) for bone in expected.bones]
    assert len(found.frames) == len(frames)
    np.testing.assert_allclose(found.heads[:, columns], expected.heads, atol=READ_M)
    assert _apart(found.rotations[:, columns], expected.rotations) < math.radians(0.01)


def _assert_written(found: Recording, track: PoseTrack) -> None:
    columns = [found.index(bone) for bone in track.bones]
    np.testing.assert_allclose(found.heads[:, columns[0]], track.root_head, atol=WRITTEN_M)
    assert _apart(found.rotations[:, columns], track.rotations) < WRITTEN_RAD


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    """The largest angle between rotations (T, B, 3, 3), rad."""
    turn = np.swapaxes(other, -1, -2) @ one
    return float(np.linalg.norm(rotation_vector(turn.reshape(-1, 3, 3)), axis=1).max())
