"""Takes of characters that have a recording in common, were copied, or deleted."""

from __future__ import annotations

from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, source_of
from hangtime.bridge.results.start import start_from_result
from hangtime.bridge.takes import takes
from hangtime.bridge.takes.takes import derive, keep_edit, takes_of

pytestmark = pytest.mark.usefixtures("_enabled")


def result_for(armature: bpy.types.Object) -> bpy.types.Action:
    """A result of what the armature performs, which stays in the file."""
    recording = current_action(armature)
    result = recording.copy()
    result.name, result.use_fake_user = "Result", True
    derive(result, recording, armature)
    armature.hangtime.adapted = result
    return result


def actions_of(armature: bpy.types.Object) -> list[str]:
    return [take.action.name for take in takes_of(armature)]


def copied(armature: bpy.types.Object) -> bpy.types.Object:
    """By Alt-D: the same recording, and the same edit at work."""
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    bpy.ops.object.duplicate(linked=True)
    return bpy.context.view_layer.objects.active


def test_results_for_a_deleted_character_are_not_another_ones(
    armature: bpy.types.Object,
) -> None:
    other, recording = copied(armature), current_action(armature).name
    result_for(armature)
    assert actions_of(armature) == [recording, "Result"]
    bpy.data.objects.remove(armature)
    assert actions_of(other) == [recording]


def test_a_copied_character_leaves_the_edit_of_the_originals_result_alone(
    armature: bpy.types.Object,
) -> None:
    result = result_for(armature)
    result.hangtime.edit.mass = 60.0
    copy = copied(armature)
    copy.hangtime.mass = 50.0
    start_from_result(copy, result)
    assert result.hangtime.edit.mass == 60.0


def test_a_deleted_character_is_left_out_of_the_file_and_comes_back_by_undo(
    armature: bpy.types.Object, tmp_path: Path
) -> None:
    name, path = armature.name, str(tmp_path / "scene.blend")
    result_for(armature)
    before = actions_of(armature)
    bpy.context.scene.hangtime.armature = armature
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push()
    armature.select_set(True)
    assert bpy.ops.object.delete() == {"FINISHED"}
    bpy.ops.ed.undo_push()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.ed.undo()
    assert actions_of(bpy.data.objects[name]) == before
    bpy.ops.wm.open_mainfile(filepath=path)
    assert name not in bpy.data.objects
    assert "Result" in bpy.data.actions


def test_a_deleted_characters_results_of_earlier_versions_are_not_another_ones_either(
    armature: bpy.types.Object, tmp_path: Path
) -> None:
    other, recording = copied(armature).name, current_action(armature).name
    result_for(armature).hangtime.property_unset("owned")
    bpy.context.collection.objects.unlink(armature)
    path = str(tmp_path / "deleted.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert "Result" in bpy.data.actions
    assert actions_of(bpy.data.objects[other]) == [recording]


def test_an_edit_with_bones_is_kept_without_a_word(
    armature: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    result, row = result_for(armature), armature.hangtime.constraints.add()
    for bones in (["shin", "foot"], ["thigh"], []):
        row.bones.clear()
        for bone in bones:
            row.bones.add().name = bone
        keep_edit(armature)
        assert [each.called for each in result.hangtime.edit.constraints[0].bones] == bones
    assert "Traceback" not in "".join(capfd.readouterr())


def test_each_action_in_the_file_is_looked_at_once_for_all_takes(
    armature: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The sidebar draws them: with 30 takes among 1500 actions it took a tenth of a second."""
    results = [result_for(armature).name for _ in range(5)]
    others = [bpy.data.actions.new(f"A prop {count}") for count in range(20)]
    asked: list[bpy.types.Action] = []
    monkeypatch.setattr(takes, "source_of", lambda each: asked.append(each) or source_of(each))

    assert set(actions_of(armature)[1:]) == set(results)
    assert [asked.count(each) for each in others] == [1] * len(others)
