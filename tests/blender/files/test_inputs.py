"""Recordings that the artist brings in by one of Blender's importers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.files.import_clip import import_clip
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.bridge.rows.choices import FileFormat
from hangtime.devtools.rigs.actor import actor
from hangtime.devtools.rigs.build import build
from hangtime.devtools.rigs.files import NATIVE
from hangtime.devtools.rigs.layout import layouts
from hangtime.solver.data.faults import UnreadableClip
from hangtime.solver.skeleton.bind_pose import bind_frames
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import mocap_path

T_POSED = "09_11_cmu.fbx"  # whose first frame is a T-pose


def imported(importer: str, path: Path) -> bpy.types.Object:
    rigs.reset()
    family, name = importer.split(".")
    getattr(getattr(bpy.ops, family), name)(filepath=str(path))
    return next(o for o in bpy.data.objects if o.type == "ARMATURE")


@pytest.mark.slow
def test_each_importer_of_fbx_gives_the_same_motion_after_the_same_bind_frame() -> None:
    found = []
    for importer in ("import_scene.fbx", *(("wm.fbx_import",) if NATIVE else ())):
        recording = read_recording(imported(importer, mocap_path(T_POSED)))
        assert bind_frames(recording) == 1
        assert len(recording.frames) == 166
        names = sorted(bone.name for bone in recording.bones)
        found.append(recording.heads[:, [recording.index(name) for name in names]])
    size = np.ptp(found[0], axis=(0, 1)).max()
    np.testing.assert_allclose(found[-1], found[0], atol=1e-5 * size)


@pytest.mark.slow
@pytest.mark.usefixtures("_enabled")
def test_an_armature_from_a_usd_file_is_analysed(tmp_path: Path) -> None:
    """Its parent carries the scale, and nothing tells Blender its frame rate."""
    armature = build(next(each for each in layouts() if each.key == "mixamo"), actor())
    path = tmp_path / "jump.usda"
    action = armature.animation_data.action
    export_takes(armature, [action], path, ExportOptions(format=FileFormat.USD))
    again = imported("wm.usd_import", path)
    bpy.context.scene.render.fps = 120
    bpy.context.scene.hangtime.armature = again
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert again.hangtime.contacts
    assert {part.name for part in again.hangtime.parts if part.needed and not part.bone} == set()


@pytest.mark.parametrize("ending", [".fbx", ".bvh"])
def test_an_import_that_fails_leaves_scene_and_selection(ending: str, tmp_path: Path) -> None:
    rigs.reset()
    mine = bpy.data.objects.new("Mine", bpy.data.armatures.new("Mine"))
    bpy.context.collection.objects.link(mine)
    bpy.context.view_layer.objects.active = mine
    mine.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    bpy.context.scene.frame_end = 77
    path = (tmp_path / "broken").with_suffix(ending)
    nodes = b"Objects", b"Objectz"  # without which Blender's importer stumbles on its way
    path.write_bytes(mocap_path(T_POSED).read_bytes().replace(*nodes))
    with pytest.raises(UnreadableClip):
        import_clip(path)
    assert bpy.context.mode == "POSE"
    assert bpy.context.selected_objects == [mine]
    assert bpy.context.scene.frame_end == 77
    assert [o.name for o in bpy.data.objects] == ["Mine"]
