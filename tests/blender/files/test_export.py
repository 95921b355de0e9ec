"""Recording and result side by side in a scene, and as a file for other programs."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import addon_utils
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording, record
from hangtime.bridge.armature.write import side_by_side, write_action
from hangtime.bridge.exports.engines import ENDINGS
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.exports.fbx_exporter import span_takes
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import Engine, FileFormat
from hangtime.devtools.recordings import JUMP, find
from hangtime.solver.data.faults import (
    OutputNotWritable,
)
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import (
    altered,
    animated_rig,
    assert_follows,
    place_object,
)
from hangtime.tests.blender.helpers.fbx import animated, fbx_file


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


def test_side_by_side_shows_the_recording_on_a_copy() -> None:
    armature = animated_rig()
    place_object(armature)
    driver = armature.driver_add('pose.bones["finger"].location', 0).driver
    driver.variables.new().targets[0].id = armature
    constraint = armature.pose.bones["finger"].constraints.new("COPY_ROTATION")
    constraint.target, constraint.subtarget = armature, "hips"
    recording = read_recording(armature)
    recorded = armature.animation_data.action
    track = altered(recording)
    action = write_action(armature, track, name="Adapted")
    copy = side_by_side(armature, recorded, action)
    assert copy.name == "Rig recording"
    assert copy.animation_data.drivers[0].driver.variables[0].targets[0].id == copy
    assert copy.pose.bones["finger"].constraints[0].target == copy
    shown = read_recording(copy)
    np.testing.assert_allclose(shown.heads, recording.heads + np.array([1.5, 0.0, 0.0]), atol=1e-5)
    assert_follows(armature, track)


def test_fbx_holds_that_action_alone_and_leaves_the_scene(tmp_path: Path) -> None:
    armature = animated_rig("XZY")
    place_object(armature)
    other = rigs.make_armature(name="Other")
    recorded = armature.animation_data.action
    track = altered(read_recording(armature, first=5, last=20))
    action = write_action(armature, track, name="Adapted")
    adapted = read_recording(armature)
    slot = fcurves.slot_identifier(armature)
    fcurves.assign(armature, recorded, slot)
    armature.animation_data.nla_tracks.new().strips.new("Strip", 1, recorded)
    armature.animation_data.action_blend_type = "ADD"
    other.select_set(True)
    bpy.context.view_layer.objects.active = other
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 100, 200
    scene.render.fps, scene.render.fps_base = 30, 1.001
    scene.frame_set(3)
    blocks = [set(kind) for kind in (bpy.data.objects, bpy.data.actions, bpy.data.armatures)]

    path = tmp_path / "new" / "adapted.fbx"
    export_takes(armature, [action], path)
    again = reimport(path, adapted.frames)

    columns = [again.index(bone.name) for bone in adapted.bones]
    np.testing.assert_allclose(again.heads[:, columns], adapted.heads, atol=5e-5)
    assert path.read_bytes().count(b"\x00\x01AnimStack") == 1
    assert b"Other" not in path.read_bytes()
    assert armature.animation_data.action == recorded
    assert armature.animation_data.use_nla
    assert fcurves.slot_identifier(armature) == slot
    assert list(bpy.context.selected_objects) == [other]
    assert bpy.context.view_layer.objects.active == other
    assert (scene.frame_start, scene.frame_end, scene.frame_current) == (100, 200, 3)
    assert blocks == [set(k) for k in (bpy.data.objects, bpy.data.actions, bpy.data.armatures)]


def test_gltf_holds_the_action_by_its_name_and_comes_back(tmp_path: Path) -> None:
    armature = animated_rig("XZY")
    armature.scale = (0.01, 0.01, 0.01)
    action = write_action(armature, altered(read_recording(armature)), name="Longer Jump")
    adapted = read_recording(armature)
    path = tmp_path / "adapted.glb"
    export_takes(armature, [action], path, ExportOptions(format=FileFormat.GLTF))
    before = set(bpy.data.objects), set(bpy.data.actions)
    again = reimport(path, adapted.frames)
    assert before == (set(bpy.data.objects), set(bpy.data.actions))
    columns = [again.index(bone.name) for bone in adapted.bones]
    np.testing.assert_allclose(again.heads[:, columns], adapted.heads, atol=1e-4)
    assert b'"name":"Longer Jump"' in path.read_bytes()


@pytest.mark.parametrize(("fps", "base"), [(30, 1.001), (25, 2.0)])
def test_gltf_lasts_as_long_as_the_scene_plays_it(fps: int, base: float, tmp_path: Path) -> None:
    armature, path = animated_rig(), tmp_path / "rig.glb"
    render, action = bpy.context.scene.render, armature.animation_data.action
    render.fps, render.fps_base = fps, base
    export_takes(armature, [action], path, ExportOptions(Engine.GODOT))
    first, last = action.frame_range
    assert _seconds(path) == pytest.approx((last - first) * base / fps, rel=1e-5)
    assert (render.fps, render.fps_base) == (fps, pytest.approx(base))


def _seconds(glb: Path) -> float:
    """The latest key. Blender's importer takes the scene's rate for the file's and cannot tell."""
    said = glb.read_bytes()
    length = struct.unpack_from("<I", said, 12)[0]
    told = json.loads(said[20 : 20 + length])
    samplers = [sampler for each in told["animations"] for sampler in each["samplers"]]
    return max(told["accessors"][sampler["input"]]["max"][0] for sampler in samplers)


@pytest.mark.parametrize(
    ("form", "addon"), [(FileFormat.FBX, "io_scene_fbx"), (FileFormat.GLTF, "io_scene_gltf2")]
)
def test_an_exporter_that_is_switched_off_works_and_stays_so(
    form: FileFormat, addon: str, tmp_path: Path
) -> None:
    armature, path = animated_rig(), tmp_path / f"rig{ENDINGS[form]}"
    addon_utils.disable(addon)
    try:
        export_takes(armature, [armature.animation_data.action], path, ExportOptions(format=form))
        assert path.stat().st_size > 0
        assert not addon_utils.check(addon)[1]
    finally:
        addon_utils.enable(addon)


def test_fbx_that_cannot_be_written_is_a_fault(tmp_path: Path) -> None:
    armature = animated_rig()
    (tmp_path / "file").write_text("no folder")
    path = tmp_path / "file" / "adapted.fbx"
    with pytest.raises(OutputNotWritable) as fault:
        export_takes(armature, [armature.animation_data.action], path)
    assert fault.value.path == str(path)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # Blender's importer
def test_a_real_jump_survives_writing_and_fbx(tmp_path: Path) -> None:
    bpy.ops.import_anim.bvh(
        filepath=str(find(JUMP)),
        global_scale=0.05644,
        update_scene_fps=True,
        update_scene_duration=True,
    )
    armature = bpy.context.object
    recording = read_recording(armature)
    moving = tuple(bone.name for bone in recording.bones)
    track = altered(recording, moving)
    action = write_action(armature, track, name="Adapted")
    adapted = assert_follows(armature, track)
    export_takes(armature, [action], tmp_path / "adapted.fbx")
    again = reimport(tmp_path / "adapted.fbx", adapted.frames)
    columns = [again.index(bone) for bone in moving]
    np.testing.assert_allclose(again.heads[:, columns], adapted.heads, atol=5e-5)
    np.testing.assert_allclose(again.rotations[:, columns], adapted.rotations, atol=2e-4)


@pytest.mark.parametrize("form", [FileFormat.FBX, FileFormat.GLTF])
@pytest.mark.parametrize("inherited", ["FULL", "NONE", "ALIGNED", "AVERAGE"])
def test_joints_are_in_place_however_bones_inherit_sizes(
    inherited: str, form: FileFormat, tmp_path: Path
) -> None:
    """Squash and stretch of a spine, and what hangs on it turns."""
    armature, path = animated_rig(), tmp_path / f"squash{ENDINGS[form]}"
    for bone in armature.data.bones:
        bone.inherit_scale = inherited
    spine = armature.pose.bones["spine"]
    for frame, sizes in ((5, (1.0, 1.0, 1.0)), (12, (0.8, 1.4, 0.9)), (20, (1.0, 1.0, 1.0))):
        spine.scale = sizes
        spine.keyframe_insert("scale", frame=frame)
    shown = record(armature, np.arange(5.0, 21.0))
    export_takes(armature, [armature.animation_data.action], path, ExportOptions(format=form))
    again = reimport(path, shown.frames)
    columns = [again.index(bone.name) for bone in shown.bones]
    np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=1e-4)


@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL])
@pytest.mark.parametrize("hidden", ["spine", "head"])
def test_bones_that_a_scale_of_0_hides_are_out_of_sight_in_the_file(
    hidden: str, engine: Engine, tmp_path: Path
) -> None:
    armature, path = animated_rig(), tmp_path / "hidden.fbx"
    bone = armature.pose.bones[hidden]
    for frame, size in ((5, 0.0), (12, 0.0), (13, 1.0), (20, 1.0)):
        bone.scale = (size, size, size)
        bone.keyframe_insert("scale", frame=frame)
    action = armature.animation_data.action
    action.use_frame_range, action.frame_start, action.frame_end = True, 5, 20
    shown = record(armature, np.arange(5.0, 21.0))
    export_takes(armature, [action], path, ExportOptions(engine, FileFormat.FBX))
    sizes = animated(path, "Lcl Scaling")[hidden]
    again = reimport(path, shown.frames, begins=5.0 if engine is Engine.UNREAL else 0.0)
    columns = [again.index(each.name) for each in shown.bones]
    np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=1e-4)
    assert [min(values) for values in sizes] == pytest.approx([0.0] * 3, abs=1e-5)
    assert [max(values) for values in sizes] == pytest.approx([1.0] * 3, abs=1e-5)


@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL])
def test_a_take_of_one_frame_is_the_same_alone_and_among_others(
    engine: Engine, tmp_path: Path
) -> None:
    armature = animated_rig()
    longer = armature.animation_data.action
    pose = longer.copy()
    pose.name, pose.use_frame_range, pose.frame_start, pose.frame_end = "Pose", True, 7, 7
    options = ExportOptions(engine, FileFormat.FBX)
    found = []
    for takes in ([pose], [longer, pose]):
        path = tmp_path / f"{len(takes)}.fbx"
        export_takes(armature, takes, path, options)
        found.append(_curves(path, "Pose"))
    assert [len(keys) for keys in found[0]] == [len(keys) for keys in found[1]]
    for alone, among in zip(*found, strict=True):
        assert np.ptp(alone[:, 1]) < 1e-6
        np.testing.assert_allclose(alone[:, 1], among[:, 1], atol=1e-6)


@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNITY])
def test_what_is_not_scaled_has_no_animated_scale(engine: Engine, tmp_path: Path) -> None:
    """Rounding, too, makes curves that vary, which Unity keeps as scale animation."""
    armature, path = animated_rig(), tmp_path / "rig.fbx"
    place_object(armature)
    options = ExportOptions(engine, FileFormat.FBX)
    export_takes(armature, [armature.animation_data.action], path, options)
    scales = animated(path, "Lcl Scaling")
    for bone in armature.data.bones:
        assert len(scales[bone.name]) == 3
        np.testing.assert_array_equal(scales[bone.name], 1.0)


@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL])
def test_the_time_of_an_fbx_lasts_as_long_as_its_longest_take(
    engine: Engine, tmp_path: Path
) -> None:
    armature, path = animated_rig(), tmp_path / "rig.fbx"
    bpy.context.scene.render.fps = 12
    longer = armature.animation_data.action
    shorter = longer.copy()
    shorter.use_frame_range, shorter.frame_start, shorter.frame_end = True, 3, 8
    export_takes(armature, [longer, shorter], path, ExportOptions(engine, FileFormat.FBX))
    seconds = (longer.frame_range[1] - longer.frame_range[0]) / 12.0
    found = fbx_file(path)
    assert found.spans[0] == pytest.approx((0.0, seconds))
    assert sorted(last for _, last in found.spans[1:]) == pytest.approx([5.0 / 12.0, seconds])


def test_an_fbx_that_tells_no_span_of_time_stays_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "later.fbx"
    path.write_bytes(b"Kaydara FBX Binary")
    span_takes(path)
    assert path.read_bytes() == b"Kaydara FBX Binary"


def _curves(path: Path, take: str) -> list[np.ndarray]:
    """The keys of a file's take."""
    before = set(bpy.data.actions)
    bpy.ops.import_scene.fbx(filepath=str(path))
    (action,) = (each for each in set(bpy.data.actions) - before if take in each.name)
    return [fcurves.keys(curve) for curve in all_curves(action)]
