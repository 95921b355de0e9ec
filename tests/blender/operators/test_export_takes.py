"""Export: accepted results as takes of one file."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import record
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.recipe.export import ExportOptions
from hangtime.operators.export.export_takes import ExportTakesOperator
from hangtime.tests.blender.helpers.fbx import fbx_file

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def adapted(jump: bpy.types.Object) -> bpy.types.Object:
    """The jump with a result, made by hand instead of by a solve."""
    recorded = current_action(jump)
    result = recorded.copy()
    result.name, result.hangtime.recording = "Longer", recorded
    jump.animation_data.action = jump.hangtime.adapted = result
    assert bpy.ops.hangtime.find_bones() == {"FINISHED"}
    return jump


@pytest.fixture
def accepted(adapted: bpy.types.Object) -> bpy.types.Object:
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    return adapted


@pytest.mark.slow
def test_export_waits_for_a_result_that_is_accepted(
    adapted: bpy.types.Object, tmp_path: Path
) -> None:
    """The ending tells the format where none is chosen."""
    assert not bpy.ops.hangtime.export.poll()
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    assert not bpy.ops.hangtime.accept.poll()
    result = current_action(adapted)
    frames = np.arange(*result.frame_range)[::20]
    shown = record(adapted, frames)
    for name, begins in (
        ("out.fbx", b"Kaydara FBX"),
        ("out.glb", b"glTF"),
        ("out.usda", b"#usda 1.0"),
    ):
        path = tmp_path / name
        assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}
        assert path.read_bytes().startswith(begins)
        again = reimport(path, frames)
        columns = [again.index(bone.name) for bone in shown.bones]
        np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=1e-3)
    assert current_action(adapted) == result


@pytest.mark.slow
def test_all_accepted_results_are_takes_of_one_file(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    first = current_action(accepted)
    second, third = first.copy(), first.copy()
    second.name, third.name = "Higher", "Not Accepted"
    third.hangtime.accepted = False
    path = tmp_path / "jumps.fbx"
    done = bpy.ops.hangtime.export(
        filepath=str(path), engine="UNREAL", takes="ACCEPTED", root="ROOT_BONE"
    )
    assert done == {"FINISHED"}
    found = fbx_file(path)
    assert set(found.takes) == {first.name, "Higher"}
    assert {"Armature", "root"} <= set(found.transformations)
    assert current_action(accepted) == first


@pytest.mark.usefixtures("accepted")
def test_a_linked_scene_is_refused_in_words(tmp_path: Path) -> None:
    blend = tmp_path / "character.blend"
    bpy.data.libraries.write(str(blend), {bpy.context.scene}, fake_user=True)
    with bpy.data.libraries.load(str(blend), link=True) as (_, linked):
        linked.scenes = [bpy.context.scene.name]
    own = bpy.context.window.scene
    bpy.context.window.scene = linked.scenes[0]
    try:
        there = next(o for o in linked.scenes[0].objects if o.type == "ARMATURE")
        bpy.context.view_layer.objects.active = there
        with pytest.raises(RuntimeError, match="The scene is linked"):
            bpy.ops.hangtime.export(filepath=str(tmp_path / "jump.fbx"))
    finally:
        bpy.context.window.scene = own


def test_a_usd_of_several_takes_is_refused_in_words(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    current_action(accepted).copy()
    path = tmp_path / "jumps.usda"
    with pytest.raises(RuntimeError, match="A USD file holds one take"):
        bpy.ops.hangtime.export(filepath=str(path), takes="ACCEPTED", format="USD")
    assert not path.exists()


@pytest.mark.slow
def test_a_take_that_begins_below_frame_0_is_whole_and_begins_at_0_s(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    result = current_action(accepted)
    for curve in all_curves(result):
        keys = fcurves.table(curve)
        for each in ("co", "handle_left", "handle_right"):
            keys[each][:, 0] -= 40.0
        fcurves.put(curve, keys)
    frames = np.arange(*result.frame_range)[::20]
    shown, path = record(accepted, frames), tmp_path / "early.fbx"
    assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}
    again = reimport(path, frames, begins=frames[0])
    columns = [again.index(bone.name) for bone in shown.bones]
    np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=1e-3)


@pytest.mark.slow
def test_a_viewport_that_hides_armatures_does_not_empty_the_file(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    area.spaces.active.show_object_viewport_armature = False
    path, (first, last) = tmp_path / "hidden.fbx", current_action(accepted).frame_range
    with bpy.context.temp_override(window=window, area=area):
        assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}
    assert len(reimport(path, np.array([first, last])).bones) == len(accepted.data.bones)


@pytest.mark.slow
def test_a_pelvis_that_was_renamed_is_asked_for_where_it_is_needed(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    accepted.data.bones[accepted.hangtime.parts["pelvis"].bone].name = "Gubbins"
    path = str(tmp_path / "renamed.fbx")
    assert bpy.ops.hangtime.export(filepath=path) == {"FINISHED"}
    with pytest.raises(RuntimeError, match="pelvis") as refused:
        bpy.ops.hangtime.export(filepath=path, root="ROOT_BONE")
    assert "Traceback" not in str(refused.value)


@pytest.mark.slow
def test_each_take_in_a_file_that_is_called_after_it(
    accepted: bpy.types.Object, tmp_path: Path
) -> None:
    """Unity's after an @, by which it knows takes; no file replaces another of the same export."""
    first = current_action(accepted)
    for name in ("Longer/2", "longer:2"):
        first.copy().name = name
    path = str(tmp_path / "jumps.fbx")
    assert bpy.ops.hangtime.export(filepath=path, engine="UNITY", takes="FILES") == {"FINISHED"}
    held = {file.name: set(fbx_file(file).takes) for file in tmp_path.iterdir()}
    assert held == {
        "jumps@Longer.fbx": {"Longer"},
        "jumps@Longer_2.fbx": {"Longer/2"},
        "jumps@longer_2_2.fbx": {"longer:2"},
    }


@pytest.mark.usefixtures("accepted")
def test_the_dialog_mends_endings_and_leaves_a_folder_without_a_name_alone(tmp_path: Path) -> None:
    def mended(name: str, takes: str = "SHOWN") -> str:
        dialog = SimpleNamespace(filepath=f"{tmp_path}/{name}", takes=takes, _options=ExportOptions)
        ExportTakesOperator.check(dialog, bpy.context)
        return dialog.filepath.removeprefix(f"{tmp_path}/")

    assert [mended(name) for name in ("", "jump", "jump.GLB")] == ["", "jump.fbx", "jump.fbx"]
    armature = bpy.context.object.name
    assert mended("Longer.fbx", "FILES") == f"{armature}.fbx"
    assert mended(armature, "ACCEPTED") == "Longer.fbx"
