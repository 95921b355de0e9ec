"""What an artist, or a script of another extension, does in the middle of something."""

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")


def purge(_armature: bpy.types.Object) -> None:
    bpy.ops.outliner.orphans_purge(do_recursive=True)


def edit(_armature: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="EDIT")


def rename(armature: bpy.types.Object) -> None:
    armature.data.bones["LeftFoot"].name = "Left"


def remove(armature: bpy.types.Object) -> None:
    bpy.data.objects.remove(armature)


def undo(_armature: bpy.types.Object) -> None:
    window = bpy.data.window_managers[0].windows[0]
    area = window.screen.areas[0]
    with bpy.context.temp_override(window=window, screen=window.screen, area=area):
        bpy.ops.ed.undo()


def move(armature: bpy.types.Object) -> None:
    armature.location.x += 1.0
    bpy.context.view_layer.update()


def unkey(armature: bpy.types.Object) -> None:
    bpy.data.actions.remove(armature.animation_data.action)
