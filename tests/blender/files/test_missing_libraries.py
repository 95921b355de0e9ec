"""Files from which the character or its take is linked are not there: it is said which."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.takes.takes import derive
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")

LIBRARY = "hero.blend"
SAYS = "“hero.blend” is missing, from which “{}” is linked; find it"


def linked_take(path: Path) -> bpy.types.Object:
    """A character of this file, with a result of a take of another."""
    armature = rigs.make_armature()
    rigs.animate(armature, frames=(1, 50))
    take = armature.animation_data.action
    bpy.data.libraries.write(str(path), {take}, fake_user=True)
    armature.animation_data.action = None
    bpy.data.actions.remove(take)
    with bpy.data.libraries.load(str(path), link=True) as (there, wanted):
        wanted.actions = list(there.actions)
    result_of(armature, wanted.actions[0])
    return armature


def overridden_character(path: Path) -> bpy.types.Object:
    """A character of another file, with a take and a result of this one."""
    armature = rigs.make_armature()
    name = armature.name
    bpy.data.libraries.write(str(path), {armature}, fake_user=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = [name]
    linked = bpy.data.objects[name]
    scene.collection.objects.link(linked)
    armature = linked.override_hierarchy_create(
        scene, bpy.context.view_layer, do_fully_editable=True
    )
    rigs.animate(armature, frames=(1, 50))
    result_of(armature, armature.animation_data.action)
    return armature


def result_of(armature: bpy.types.Object, take: bpy.types.Action) -> None:
    """An accepted result, shown."""
    data = armature.animation_data or armature.animation_data_create()
    data.action = take
    result = take.copy()
    result.name = "Result"
    derive(result, take, armature)
    result.use_fake_user = result.hangtime.accepted = True
    data.action = armature.hangtime.adapted = result


Made = Callable[[Path], bpy.types.Object]


def reopened_without(make: Made, folder: Path) -> bpy.types.Object:
    """The file that holds it, opened again after its library has gone."""
    rigs.reset()
    armature = make(folder / LIBRARY)
    bpy.context.scene.hangtime.armature = armature
    name, path = armature.name, str(folder / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    (folder / LIBRARY).unlink()
    bpy.ops.wm.open_mainfile(filepath=path)
    return bpy.data.objects[name]


@pytest.mark.parametrize("asked", ["analyze", "examine", "adapt", "export", "show_take"])
def test_a_character_whose_file_is_missing_is_named_with_it(asked: str, tmp_path: Path) -> None:
    armature = reopened_without(overridden_character, tmp_path)
    assert len(armature.data.bones) == 0
    with pytest.raises(RuntimeError, match=SAYS.format(".*")):
        getattr(bpy.ops.hangtime, asked)()


def test_a_missing_take_that_is_made_local_is_told_as_any_without_keys(tmp_path: Path) -> None:
    """Blender keeps it marked as missing."""
    armature = reopened_without(linked_take, tmp_path)
    lost = current_action(armature).hangtime.recording
    lost.make_local()
    assert lost.is_missing
    with pytest.raises(RuntimeError, match="has no keyframes"):
        bpy.ops.hangtime.analyze()


@pytest.mark.parametrize("asked", ["analyze", "examine", "adapt", "show_recording", "compare"])
def test_a_recording_whose_file_is_missing_is_named_with_it(asked: str, tmp_path: Path) -> None:
    armature = reopened_without(linked_take, tmp_path)
    shown = current_action(armature)
    with pytest.raises(RuntimeError, match=SAYS.format(shown.hangtime.recording.name)):
        getattr(bpy.ops.hangtime, asked)()
    assert current_action(armature) == shown


def test_no_missing_take_is_shown_but_the_result_is_exported(tmp_path: Path) -> None:
    armature = reopened_without(linked_take, tmp_path)
    shown = current_action(armature)
    lost = shown.hangtime.recording
    with pytest.raises(RuntimeError, match=SAYS.format(lost.name)):
        bpy.ops.hangtime.show_take(action=lost.name_full)
    assert current_action(armature) == shown
    path = tmp_path / "result.bvh.fbx"
    assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}
    assert path.is_file()
