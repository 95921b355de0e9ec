"""Skin that goes into a file with its bones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.exports.engines import ENDINGS
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import Engine, FileFormat
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import animated_rig

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
    rigs.reset()
    match form:
        case FileFormat.FBX:
            bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
        case FileFormat.GLTF:
            bpy.ops.import_scene.gltf(filepath=str(path))
        case FileFormat.USD:
            bpy.ops.wm.usd_import(filepath=str(path))
    meshes = [o for o in bpy.data.objects if o.type == "MESH" and o.name.startswith("Body")]
    assert len(meshes) == 1
    bpy.context.scene.frame_set(round(FRAME - begins))
    found = shown(meshes[0])
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
