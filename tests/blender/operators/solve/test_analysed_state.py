"""What of an armature is another since it was analysed."""

from __future__ import annotations

import json
from dataclasses import asdict

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.repairs.analysed_state import STATE, AnalysedState

pytestmark = pytest.mark.usefixtures("_enabled")


def test_a_bone_that_rests_otherwise_is_told_but_no_visit_to_edit_mode(
    analysed: bpy.types.Object,
) -> None:
    before = AnalysedState.of(analysed)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert AnalysedState.of(analysed).since(before) == ()
    bpy.ops.object.mode_set(mode="EDIT")
    analysed.data.edit_bones["LeftFoot"].roll += 0.3
    bpy.ops.object.mode_set(mode="OBJECT")
    assert AnalysedState.of(analysed).since(before) == ("its bones",)


def test_what_an_action_constraint_lists_of_slots_is_no_change(analysed: bpy.types.Object) -> None:
    """Which the artist may select, and add."""
    action, held = analysed.animation_data.action, analysed.pose.bones["LeftHand"].constraints
    if not hasattr(action, "slots"):
        pytest.skip("actions have no slots before Blender 4.4")
    held.new("ACTION").action = action
    before = AnalysedState.of(analysed)
    action.slots[0].select = not action.slots[0].select
    action.slots.new("OBJECT", "Other")
    assert AnalysedState.of(analysed).since(before) == ()
    held[0].target_space = "LOCAL"
    assert AnalysedState.of(analysed).since(before) == ("its constraints",)


def test_what_keys_change_of_a_constraint_is_no_change(analysed: bpy.types.Object) -> None:
    held = analysed.pose.bones["LeftHand"].constraints.new("LIMIT_ROTATION")
    held.keyframe_insert("influence", frame=1)
    before = AnalysedState.of(analysed)
    held.influence = 0.5
    assert AnalysedState.of(analysed).since(before) == ()
    held.max_x = 0.5
    assert AnalysedState.of(analysed).since(before) == ("its constraints",)


def test_of_what_an_earlier_version_kept_the_place_and_size_count(
    analysed: bpy.types.Object,
) -> None:
    """Of other parts nothing is told."""
    now = AnalysedState.of(analysed)
    told = {"conditions": asdict(now.conditions), "bones": "1", "keys": "2", "loop": False}
    before = STATE.of(json.dumps(told))
    assert before is not None
    assert now.since(before) == ()
    analysed.location.x += 1.0
    bpy.context.view_layer.update()
    assert AnalysedState.of(analysed).since(before) == ("its place",)
