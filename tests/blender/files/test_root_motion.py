"""What carries the way over the floor in a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import record
from hangtime.bridge.companions.root_motion import way
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import Engine, FileFormat, RootMotion
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.data.faults import MissingPart
from hangtime.solver.data.recording import Recording
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(170.0, 220.0)  # the take-off and some of the flight
LEVEL = np.array([1.0, 1.0, 0.0])
PELVIS = {"cmu": "Hips", "unreal": "pelvis"}


def exported(
    key: str, root: RootMotion, path: Path, engine: Engine = Engine.UNREAL
) -> tuple[Recording, Recording]:
    """The jump as Blender shows it and as the file has it."""
    armature = build(next(each for each in layouts() if each.key == key), actor())
    action = armature.animation_data.action
    action.use_frame_range = True
    action.frame_start, action.frame_end = FRAMES[[0, -1]]
    shown = record(armature, FRAMES)
    export_takes(armature, [action], path, ExportOptions(engine, root=root), PELVIS[key])
    return shown, reimport(path, FRAMES, begins=FRAMES[0])


@pytest.mark.slow
@pytest.mark.parametrize("key", ["cmu", "unreal"])
def test_a_root_bone_carries_the_same_motion(key: str, tmp_path: Path) -> None:
    """One that is there, and one that is added."""
    shown, again = exported(key, RootMotion.ROOT_BONE, tmp_path / "jump.fbx")
    root = again.index("root")
    columns = [again.index(bone.name) for bone in shown.bones if bone.name != "root"]
    mine = [shown.index(bone.name) for bone in shown.bones if bone.name != "root"]
    np.testing.assert_allclose(again.heads[:, columns], shown.heads[:, mine], atol=1e-4)
    hips = shown.heads[:, shown.index(PELVIS[key])]
    travelled = again.heads[-1, root] - again.heads[0, root]
    assert np.linalg.norm(travelled) > 0.5
    np.testing.assert_allclose(travelled, (hips[-1] - hips[0]) * LEVEL, atol=0.05)
    assert np.ptp(again.heads[:, root, 2]) < 1e-4
    assert all(bone.parent >= 0 for bone in again.bones if bone.name != "root")


def test_in_place_leaves_out_the_way_and_nothing_else(tmp_path: Path) -> None:
    shown, again = exported("cmu", RootMotion.IN_PLACE, tmp_path / "jump.fbx")
    columns = [again.index(bone.name) for bone in shown.bones]
    hips = shown.index("Hips")
    assert np.ptp(again.heads[:, columns[hips], :2], axis=0).max() < 1e-4
    apart = again.heads[:, columns] - shown.heads
    assert np.ptp(apart, axis=1).max() < 1e-4  # every bone was shifted alike
    assert np.abs(apart[..., 2]).max() < 1e-4


def walking() -> bpy.types.Object:
    """A figure whose hips go over the floor and turn above a root that rests, as do a camera's bone
    on it and the one that carries a bone which follows the foot."""
    rigs.reset()
    helpers = [
        rigs.BoneSpec("camera_root", "root", (0.3, 1.5, 1.8), (0.3, 1.5, 1.9)),
        rigs.BoneSpec("ik_foot_root", "root", (0.3, 0.2, 0.0), (0.3, 0.2, 0.1)),
        rigs.BoneSpec("ik_foot", "ik_foot_root", (0.12, 0.02, 0.1), (0.12, 0.02, 0.2)),
    ]
    armature = rigs.make_armature([*rigs.with_root(), *helpers])
    hips = armature.pose.bones["hips"]
    hips.rotation_mode = "XYZ"
    for frame in range(1, 11):
        hips.location = (0.1 * frame, 0.02 * frame**2, 0.05 * frame)
        hips.rotation_euler = (0.0, 0.1 * frame, 0.1)
        for channel in ("location", "rotation_euler"):
            hips.keyframe_insert(channel, frame=frame)
    follows = armature.pose.bones["ik_foot"].constraints.new("COPY_LOCATION")
    follows.target, follows.subtarget = armature, "foot"
    return armature


def walked(root: RootMotion, path: Path, *, at_origin: bool = False) -> tuple[Recording, Recording]:
    """The figure as Blender shows it and as the file has it."""
    armature = walking()
    shown = record(armature, np.arange(1.0, 11.0))
    options = ExportOptions(Engine.UNREAL, root=root, at_origin=at_origin)
    export_takes(armature, [armature.animation_data.action], path, options, pelvis="hips")
    return shown, reimport(path, shown.frames, begins=1.0)


def test_in_place_a_root_that_rests_goes_on_resting_under_the_hips(tmp_path: Path) -> None:
    shown, again = walked(RootMotion.IN_PLACE, tmp_path / "walk.fbx")
    at_rest = {bone.name: bone.matrix_local.translation for bone in walking().data.bones}
    for name in ("root", "camera_root", "ik_foot_root"):
        resting = np.tile(at_rest[name], (len(again.frames), 1))
        np.testing.assert_allclose(again.heads[:, again.index(name)], resting, atol=1e-4)
    hips, foot, follower = (again.index(name) for name in ("hips", "foot", "ik_foot"))
    level = np.tile(at_rest["hips"][:2], (len(again.frames), 1))
    np.testing.assert_allclose(again.heads[:, hips, :2], level, atol=1e-4)
    np.testing.assert_allclose(again.heads[:, follower], again.heads[:, foot], atol=1e-4)
    limbs = shown.heads[:, shown.index("foot")] - shown.heads[:, shown.index("hips")]
    np.testing.assert_allclose(again.heads[:, foot] - again.heads[:, hips], limbs, atol=1e-4)


def test_what_rests_on_a_root_bone_goes_with_it(tmp_path: Path) -> None:
    shown, again = walked(RootMotion.ROOT_BONE, tmp_path / "walk.fbx")
    root, camera, target = (again.index(n) for n in ("root", "camera_root", "ik_foot_root"))
    assert np.ptp(again.heads[:, root], axis=0).max() > 0.5
    turns = again.rotations[:, root]
    beside = np.einsum("tji,tj->ti", turns, again.heads[:, camera] - again.heads[:, root])
    assert np.ptp(beside, axis=0).max() < 1e-4
    np.testing.assert_allclose(again.heads[:, target], again.heads[:, root], atol=1e-4)
    for name in ("hips", "foot", "ik_foot"):
        seen = shown.heads[:, shown.index(name)]
        np.testing.assert_allclose(again.heads[:, again.index(name)], seen, atol=1e-4)


@pytest.mark.parametrize("root", list(RootMotion))
def test_at_the_origin_a_take_begins_as_the_figure_stands_at_rest(
    root: RootMotion, tmp_path: Path
) -> None:
    """The same motion, moved and turned on the floor; a root that rests stays there."""
    _, before = walked(root, tmp_path / "walk.fbx")
    _, after = walked(root, tmp_path / "origin.fbx", at_origin=True)
    rest = walking().data.bones
    hips, foot, top = (after.index(name) for name in ("hips", "foot", "root"))
    level = rest["hips"].matrix_local.translation[:2]
    np.testing.assert_allclose(after.heads[0, hips, :2], level, atol=1e-4)
    turned = after.rotations[0, hips] @ np.array(rest["hips"].matrix_local.to_3x3()).T
    assert turned[1, 0] == pytest.approx(turned[0, 1], abs=1e-4)  # no turn about the vertical
    np.testing.assert_allclose(
        after.heads[0, top], rest["root"].matrix_local.translation, atol=1e-4
    )
    if root is not RootMotion.ROOT_BONE:
        assert np.ptp(after.heads[:, top], axis=0).max() < 1e-4
    for one in (hips, foot):  # distances from the first hips are those of before
        apart = [each.heads[:, one] - each.heads[0, hips] for each in (before, after)]
        np.testing.assert_allclose(*(np.linalg.norm(each, axis=1) for each in apart), atol=1e-4)


def test_at_the_origin_a_root_that_turns_below_the_hips_goes_on_turning(tmp_path: Path) -> None:
    """As it is, the whole take is moved: what the root does on its spot is a part of it."""
    armature = walking()
    root = armature.pose.bones["root"]
    root.rotation_mode = "XYZ"
    for frame in (1, 10):
        root.rotation_euler = (0.0, 0.15 * frame, 0.0)
        root.keyframe_insert("rotation_euler", frame=frame)
    hips = armature.pose.bones["hips"]
    for curve in fcurves.holder(armature).fcurves:
        if curve.data_path == hips.path_from_id("location"):
            curve.mute = True
    shown = record(armature, np.arange(1.0, 11.0))
    options = ExportOptions(at_origin=True)
    path = tmp_path / "turns.fbx"
    export_takes(armature, [armature.animation_data.action], path, options, pelvis="hips")
    again = reimport(path, shown.frames)
    turned = [
        each.rotations[-1, each.index("root")] @ each.rotations[0, each.index("root")].T
        for each in (shown, again)
    ]
    assert np.trace(turned[0]) < 2.9
    assert np.trace(turned[1]) == pytest.approx(np.trace(turned[0]), abs=1e-3)


def test_as_it_is_takes_no_root_bone_but_where_an_engine_needs_one(tmp_path: Path) -> None:
    _, plain = exported("cmu", RootMotion.AS_IT_IS, tmp_path / "jump.fbx")
    assert "root" not in [bone.name for bone in plain.bones]


def test_a_root_bone_needs_a_pelvis(tmp_path: Path) -> None:
    armature = build(next(each for each in layouts() if each.key == "cmu"), actor())
    with pytest.raises(MissingPart):
        export_takes(
            armature,
            [armature.animation_data.action],
            tmp_path / "jump.fbx",
            ExportOptions(format=FileFormat.FBX, root=RootMotion.ROOT_BONE),
        )


def test_the_way_of_a_cycle_is_straight_and_even_amid_the_sway() -> None:
    pelvis = np.tile(np.eye(4), (11, 1, 1))
    pelvis[:, 0, 3] = np.linspace(0.0, 2.0, 11) ** 2  # faster and faster
    pelvis[:, 2, 3] = 1.0
    pelvis[:, :3, :3] = axis_rotation(2, 0.2 * np.sin(np.arange(11.0)))
    rest = np.eye(4)
    rest[2, 3] = 1.0
    found = way(pelvis, rest, steady=True)
    np.testing.assert_allclose(np.diff(found[:, 0, 3]), 0.4, atol=1e-12)
    np.testing.assert_allclose((found - pelvis)[:, :2, 3].mean(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(found[:, :3, :3], np.eye(3)[None].repeat(11, 0), atol=1e-12)


def test_the_way_goes_on_evenly_through_a_somersault() -> None:
    tilt = np.linspace(0.0, 2.0 * np.pi, 37)
    pelvis = np.tile(np.eye(4), (37, 1, 1))
    pelvis[:, :3, :3] = axis_rotation(2, np.linspace(0.0, 0.6, 37)) @ axis_rotation(0, tilt)
    found = way(pelvis, np.eye(4), steady=False)
    heading = np.arctan2(found[:, 1, 0], found[:, 0, 0])
    assert heading[-1] == pytest.approx(0.6)
    assert np.diff(heading).min() > -0.02
    assert np.diff(heading).max() < 0.06
