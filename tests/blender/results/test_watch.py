"""Looks whether results are up to date: in parts, and at no keys that cannot be others."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, source_of
from hangtime.bridge.action_slots import holders_of
from hangtime.bridge.armature import keys_digest
from hangtime.bridge.results.look_again import TAKE_CHANGED
from hangtime.operators.solve import watch

pytestmark = pytest.mark.usefixtures("_enabled")


def looks() -> int:
    """Parts of a look until it is done."""
    parts = 1
    while watch.look() is not None:
        parts += 1
    return parts


def told(armature: bpy.types.Object) -> tuple[str, bool]:
    result = armature.hangtime.adapted
    return result.hangtime.stale, result.hangtime.polished


def change_key(action: bpy.types.Action) -> None:
    holders_of(action)[0].fcurves[0].keyframe_points[3].co.y += 0.1
    bpy.context.view_layer.update()


def change_all(action: bpy.types.Action) -> None:
    curve = holders_of(action)[0].fcurves[0]
    places = np.empty(2 * len(curve.keyframe_points), np.float32)
    curve.keyframe_points.foreach_get("co", places)
    places[1::2] += 0.1
    curve.keyframe_points.foreach_set("co", places)
    curve.update()  # of foreach_set alone Blender 4.2 tells nobody
    bpy.context.view_layer.update()


def change_and_go(action: bpy.types.Action) -> None:
    """After which Blender tells of no change of the action."""
    holders_of(action)[0].fcurves[0].keyframe_points[3].co.y += 0.1
    bpy.context.scene.frame_set(bpy.context.scene.frame_current + 1)


def add_curve(action: bpy.types.Action) -> None:
    holders_of(action)[0].fcurves.new('pose.bones["New"].location', index=0)
    bpy.context.view_layer.update()


def add_modifier(action: bpy.types.Action) -> None:
    """Of which Blender tells nobody."""
    holders_of(action)[0].fcurves[0].modifiers.new("NOISE")
    bpy.context.view_layer.update()


CHANGES = (change_key, change_all, change_and_go, add_curve, add_modifier)


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("of", ["result", "take that nothing performs"])
def test_a_look_sees_whatever_changed_keys_since_the_last(
    adapted: bpy.types.Object, change: Callable[[bpy.types.Action], None], of: str
) -> None:
    looks()
    assert told(adapted) == ("", False)
    result = current_action(adapted)
    change(result if of == "result" else source_of(result))
    looks()
    assert told(adapted) == (("", True) if of == "result" else (TAKE_CHANGED, False))


def test_a_look_after_an_undo_sees_the_keys_of_before(adapted: bpy.types.Object) -> None:
    bpy.ops.ed.undo_push(message="before")
    change_key(current_action(adapted))
    bpy.ops.ed.undo_push(message="edited")
    looks()
    assert told(adapted) == ("", True)
    bpy.ops.ed.undo()
    again = bpy.data.objects[adapted.name]
    looks()
    assert told(again) == ("", False)


def test_a_look_after_an_object_has_moved_reads_no_keys(
    adapted: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    prop = bpy.data.objects.new("Prop", None)
    bpy.context.scene.collection.objects.link(prop)
    bpy.context.view_layer.update()
    looks()
    read: list[bpy.types.FCurve] = []
    monkeypatch.setattr(keys_digest, "curve_digest", lambda curve, _: read.append(curve) or 0)
    prop.location.x += 1.0
    bpy.context.view_layer.update()
    looks()
    assert not read
    change_key(current_action(adapted))
    looks()
    assert read


def test_a_look_goes_through_the_keys_in_parts(
    adapted: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    change_key(source_of(current_action(adapted)))
    monkeypatch.setattr(keys_digest, "SLICE_S", 5e-4)
    assert looks() > 3
    assert told(adapted) == (TAKE_CHANGED, False)
