"""Skin that goes into a file with its bones."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.exports.engines import ENDINGS
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import Engine, FileFormat
from hangtime.operators.export.skin_text import skin_text
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import animated_rig
from hangtime.tests.blender.helpers.fbx import fbx_file

FRAME = 13


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


def skinned(armature: bpy.types.Object) -> bpy.types.Object:
    """A box at each bone's head, which the bone moves; beside it an undeformed mesh."""
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.mesh.primitive_cube_add()
    body = bpy.context.object
    body.name = "Body"
    corners = np.array([corner.co for corner in body.data.vertices])
    faces = [tuple(face.vertices) for face in body.data.polygons]
    bones = armature.data.bones
    places = [0.03 * corners + np.array(bone.head_local) for bone in bones]
    shifted = [[tuple(v + 8 * i for v in f) for f in faces] for i in range(len(bones))]
    mesh = bpy.data.meshes.new("Body")
    mesh.from_pydata(np.concatenate(places).tolist(), [], [f for part in shifted for f in part])
    body.data = mesh
    for i, bone in enumerate(bones):
        group = body.vertex_groups.new(name=bone.name)
        group.add(list(range(8 * i, 8 * i + 8)), 1.0, "REPLACE")
    body.parent = armature
    body.modifiers.new("Armature", "ARMATURE").object = armature
    return body


def shown(mesh: bpy.types.Object) -> np.ndarray:
    """(n, 3) corners in the world, as deformed."""
    graph = bpy.context.evaluated_depsgraph_get()
    posed = mesh.evaluated_get(graph)
    return np.array([posed.matrix_world @ corner.co for corner in posed.data.vertices])


def skin_in(path: Path) -> bpy.types.Object:
    """The one mesh "Body" of a file, which is all that the scene then holds."""
    rigs.reset()
    match path.suffix:
        case ".fbx":
            bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
        case ".glb":
            bpy.ops.import_scene.gltf(filepath=str(path))
        case _:
            bpy.ops.wm.usd_import(filepath=str(path))
    (found,) = (o for o in bpy.data.objects if o.type == "MESH" and o.name.startswith("Body"))
    return found


@pytest.mark.parametrize("form", FileFormat)
@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL, Engine.UNITY])
def test_skin_follows_the_bones_in_the_file_as_it_did(
    engine: Engine, form: FileFormat, tmp_path: Path
) -> None:
    armature = animated_rig()
    body = skinned(armature)
    armature.rotation_euler, armature.scale = (0.2, 0.1, 0.4), (1.5, 1.5, 1.5)
    armature.location = (1.0, 2.0, 0.0) if engine is Engine.NONE else (0.0, 0.0, 0.0)
    action, path = armature.animation_data.action, tmp_path / f"body{ENDINGS[form]}"
    begins = 0 if engine is Engine.NONE else action.frame_range[0]
    bpy.context.scene.frame_set(FRAME)
    expected = shown(body)
    export_takes(armature, [action], path, ExportOptions(engine, form, skin=True))
    assert (body.name, body.parent, body.modifiers[0].object) == ("Body", armature, armature)
    mesh = skin_in(path)
    bpy.context.scene.frame_set(round(FRAME - begins))
    found = shown(mesh)
    apart = np.linalg.norm(found[:, None] - expected[None], axis=2)
    assert apart.min(axis=0).max() < 1e-4
    assert apart.min(axis=1).max() < 1e-4


def test_hidden_meshes_stay_out_of_the_file(tmp_path: Path) -> None:
    armature = animated_rig()
    body = skinned(armature)
    proxy = body.copy()
    proxy.name = "Proxy"
    bpy.context.collection.objects.link(proxy)
    proxy.hide_set(True)
    path = tmp_path / "rig.usda"
    options = ExportOptions(format=FileFormat.USD, skin=True)
    export_takes(armature, [armature.animation_data.action], path, options)
    said = path.read_text()
    assert '"Body"' in said
    assert '"Proxy"' not in said


@pytest.mark.parametrize("form", FileFormat)
def test_a_mesh_that_its_parent_deforms_goes_along_without_a_modifier(
    form: FileFormat, tmp_path: Path
) -> None:
    armature = animated_rig()
    body = skinned(armature)
    body.modifiers.clear()
    body.parent_type = "ARMATURE"
    bpy.context.scene.frame_set(FRAME)
    expected = shown(body)
    path = tmp_path / f"body{ENDINGS[form]}"
    options = ExportOptions(format=form, skin=True)
    export_takes(armature, [armature.animation_data.action], path, options)
    assert len(body.modifiers) == 0
    found = skin_in(path)
    bpy.context.scene.frame_set(FRAME)
    apart = np.linalg.norm(shown(found)[:, None] - expected[None], axis=2)
    assert apart.min(axis=0).max() < 1e-4


@pytest.mark.parametrize("form", FileFormat)
@pytest.mark.parametrize("how", ["it hangs on a bone", "it cannot be selected nor rendered"])
def test_a_skinned_mesh_goes_along_wherever_it_hangs(
    how: str, form: FileFormat, tmp_path: Path
) -> None:
    armature = animated_rig()
    body = skinned(armature)
    bpy.context.scene.frame_set(FRAME)
    expected = shown(body)
    if how == "it hangs on a bone":  # as it is at rest
        armature.data.pose_position = "REST"
        bpy.context.view_layer.update()
        place = body.matrix_world.copy()
        body.parent, body.parent_type = armature, "BONE"
        body.parent_bone = armature.data.bones[-1].name
        body.matrix_world = place
        armature.data.pose_position = "POSE"
    else:
        body.hide_select = body.hide_render = True
    path = tmp_path / f"body{ENDINGS[form]}"
    options = ExportOptions(format=form, skin=True)
    export_takes(armature, [armature.animation_data.action], path, options)
    found = skin_in(path)
    bpy.context.scene.frame_set(FRAME)
    apart = np.linalg.norm(shown(found)[:, None] - expected[None], axis=2)
    assert apart.min(axis=0).max() < 1e-4


def test_what_is_no_mesh_or_hangs_on_a_bone_is_left_out_and_named(tmp_path: Path) -> None:
    """An armature that deforms them does not keep the meshes from being written."""
    armature = animated_rig()
    skinned(armature)
    lattice = bpy.data.objects.new("Eye", bpy.data.lattices.new("Eye"))
    rope = bpy.data.objects.new("Rope", bpy.data.curves.new("Rope", "CURVE"))
    sword = bpy.data.objects.new("Sword", bpy.data.meshes.new("Sword"))
    for thing in (lattice, rope, sword):
        bpy.context.collection.objects.link(thing)
    for thing in (lattice, rope):
        thing.modifiers.new("Armature", "ARMATURE").object = armature
    sword.parent, sword.parent_type = armature, "BONE"
    sword.parent_bone = armature.data.bones[0].name
    path = tmp_path / "body.fbx"
    skin = export_takes(armature, [armature.animation_data.action], path, ExportOptions(skin=True))
    assert skin_text(skin).startswith(" with 1 mesh; left out")
    assert skin_text(skin).endswith(": Rope, Sword")
    assert [lattice.name for lattice in bpy.data.lattices] == ["Eye"]
    assert skin_in(path).name == "Body"


@pytest.mark.parametrize("form", FileFormat)
@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL, Engine.UNITY])
def test_modifiers_are_in_the_file_with_their_lengths(
    engine: Engine, form: FileFormat, tmp_path: Path
) -> None:
    """Unreal's unit is a hundredth of the scene's, and the mesh's object has a scale of its own."""
    armature = animated_rig()
    body = skinned(armature)
    body.scale = (2.0, 2.0, 2.0)
    shell = body.modifiers.new("Shell", "SOLIDIFY")
    shell.thickness, shell.offset = 0.02, 1.0
    twin = body.modifiers.new("Twin", "ARRAY")
    twin.count, twin.use_relative_offset, twin.use_constant_offset = 2, False, True
    twin.constant_offset_displace = (0.5, 0.0, 0.0)
    body.modifiers.move(2, 0)
    bpy.context.scene.frame_set(FRAME)
    expected = shown(body)
    action, path = armature.animation_data.action, tmp_path / f"body{ENDINGS[form]}"
    begins = 0 if engine is Engine.NONE else action.frame_range[0]
    export_takes(armature, [action], path, ExportOptions(engine, form, skin=True))
    assert [modifier.type for modifier in body.modifiers] == ["ARRAY", "ARMATURE", "SOLIDIFY"]
    assert armature.data.pose_position == "POSE"
    found = skin_in(path)
    bpy.context.scene.frame_set(round(FRAME - begins))
    apart = np.linalg.norm(shown(found)[:, None] - expected[None], axis=2)
    assert apart.min(axis=0).max() < 1e-3
    assert apart.min(axis=1).max() < 1e-3


@pytest.mark.parametrize("form", FileFormat)
def test_modifiers_give_way_to_shape_keys_and_are_named(form: FileFormat, tmp_path: Path) -> None:
    armature = animated_rig()
    body = skinned(armature)
    for name in ("Basis", "Smile"):
        body.shape_key_add(name=name)
    body.modifiers.new("Smooth", "SUBSURF")
    path = tmp_path / f"body{ENDINGS[form]}"
    action, options = armature.animation_data.action, ExportOptions(format=form, skin=True)
    skin = export_takes(armature, [action], path, options)
    assert skin_text(skin).endswith("for the sake of shape keys: Body (Smooth)")
    assert "Smile" in skin_in(path).data.shape_keys.key_blocks


@pytest.mark.parametrize("form", FileFormat)
def test_mesh_data_keep_their_names_in_the_file(form: FileFormat, tmp_path: Path) -> None:
    armature = animated_rig()
    body = skinned(armature)
    body.data.name = "BodyMesh"
    twin = body.copy()
    twin.name = "Twin"
    bpy.context.collection.objects.link(twin)
    path = tmp_path / f"body{ENDINGS[form]}"
    action, options = armature.animation_data.action, ExportOptions(format=form, skin=True)
    export_takes(armature, [action], path, options)
    assert (body.data.name, twin.data) == ("BodyMesh", body.data)
    written = path.read_bytes()
    pattern = {
        FileFormat.FBX: rb"([\w.]+)\x00\x01Geometry",
        FileFormat.GLTF: rb'"name":"([\w.]+)","primitives"',
        FileFormat.USD: rb'def Mesh "([\w.]+)"',
    }[form]
    assert sorted(re.findall(pattern, written))[0] == b"BodyMesh"


def test_a_mesh_leaves_the_name_to_the_armature_that_unreal_leaves_out(tmp_path: Path) -> None:
    armature, path = animated_rig(), tmp_path / "body.fbx"
    body = skinned(armature)
    body.name = "Armature"
    action = armature.animation_data.action
    export_takes(armature, [action], path, ExportOptions(Engine.UNREAL, skin=True))
    nodes = fbx_file(path).transformations
    assert nodes.keys() - armature.data.bones.keys() == {"Armature", "Armature Mesh"}
    assert body.name == "Armature"


def test_a_mesh_that_leaves_its_name_takes_none_of_another(tmp_path: Path) -> None:
    armature, path = animated_rig(), tmp_path / "body.fbx"
    for name in ("Armature", "Armature Mesh", "Armature Mesh 2"):
        skinned(armature).name = name
    action = armature.animation_data.action
    export_takes(armature, [action], path, ExportOptions(Engine.UNREAL, skin=True))
    nodes = fbx_file(path).transformations.keys() - armature.data.bones.keys()
    assert nodes == {"Armature", *(f"Armature Mesh{number}" for number in ("", " 2", " 3"))}


def smiling(body: bpy.types.Object, armature: bpy.types.Object) -> bpy.types.Object:
    """A mesh with a shape key that has keys, one that a bone drives, and one that nothing moves."""
    for name in ("Basis", "Smile", "Bulge", "Fat"):
        key = body.shape_key_add(name=name)
        for point in key.data:
            point.co.z += 0.1 * (name != "Basis")
    blocks = body.data.shape_keys.key_blocks
    blocks["Fat"].value = 0.25
    for frame, value in ((1, 0.0), (25, 1.0)):
        blocks["Smile"].value = value
        blocks["Smile"].keyframe_insert("value", frame=frame)
    driver = blocks["Bulge"].driver_add("value").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    target = variable.targets[0]
    target.id, target.bone_target = armature, rigs.MOVING[0]
    target.transform_type, target.transform_space = "LOC_X", "WORLD_SPACE"
    return body


@pytest.mark.parametrize("form", FileFormat)
@pytest.mark.parametrize("engine", [Engine.NONE, Engine.UNREAL])
def test_shape_keys_play_in_the_file_as_they_did(
    engine: Engine, form: FileFormat, tmp_path: Path
) -> None:
    armature = animated_rig()
    body = smiling(skinned(armature), armature)
    action, path = armature.animation_data.action, tmp_path / f"body{ENDINGS[form]}"
    begins = 0 if engine is Engine.NONE else action.frame_range[0]
    frames = [2, FRAME, 20]
    expected = [at(frame, body) for frame in frames]
    export_takes(armature, [action], path, ExportOptions(engine, form, skin=True))
    assert len(body.data.shape_keys.animation_data.drivers) == 1
    found = skin_in(path)
    for frame, corners in zip(frames, expected, strict=True):
        apart = np.linalg.norm(at(frame - begins, found)[:, None] - corners[None], axis=2)
        assert apart.min(axis=0).max() < 1e-4


def at(frame: float, body: bpy.types.Object) -> np.ndarray:
    bpy.context.scene.frame_set(round(frame))
    return shown(body)
