"""Loop in the panel: the range becomes a cycle, and Adapt writes an action that repeats."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature.read import record
from hangtime.bridge.files.import_clip import import_clip
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import mocap_path

ASKED = (28, 120)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def run() -> bpy.types.Object:
    rigs.reset()
    armature = import_clip(mocap_path("run_2.bvh")).armature
    settings = armature.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = ASKED
    settings.loop.use = True
    return armature


@pytest.mark.slow
def test_a_run_becomes_a_loop(run: bpy.types.Object) -> None:
    settings, take = run.hangtime, current_action(run)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    first, last = settings.first_frame, settings.last_frame
    assert first == ASKED[0]
    assert 94 <= last - first <= 97
    settings.result.written_as = "SLOT"  # which is about the rest of the take: a loop has none
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert f"Loop: frames {first} to {last}" in settings.status
    action = current_action(run)
    assert action != take
    assert action == run.animation_data.action
    assert action.use_cyclic
    frames = np.arange(first, last + 1.0)
    once, again = record(run, frames), record(run, frames + last - first)
    travel = again.heads[0, 0] - once.heads[0, 0]
    assert 2.0 < np.linalg.norm(travel) < 2.3
    assert abs(travel[2]) < 1e-5
    np.testing.assert_allclose(again.heads, once.heads + travel, atol=5e-5)


@pytest.mark.slow
def test_an_accepted_loop_can_be_looped_again(run: bpy.types.Object) -> None:
    settings = run.hangtime
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    cycle = settings.first_frame, settings.last_frame
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    assert bpy.ops.hangtime.start_from(result=True) == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert (settings.first_frame, settings.last_frame) == cycle
    settings.stances["ground 2"].left = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert f"Loop: frames {cycle[0]} to {cycle[1]}" in settings.status


def test_loop_ticked_after_the_analysis_asks_for_another(run: bpy.types.Object) -> None:
    run.hangtime.loop.use = False
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    run.hangtime.loop.use = True
    with pytest.raises(RuntimeError, match="Analyze"):
        bpy.ops.hangtime.adapt()


def test_what_cannot_repeat_is_said(run: bpy.types.Object) -> None:
    run.hangtime.last_frame = ASKED[0] + 45
    with pytest.raises(RuntimeError, match="Nothing repeats from frame 28 to 73"):
        bpy.ops.hangtime.analyze()
    assert (run.hangtime.first_frame, run.hangtime.last_frame) == (ASKED[0], ASKED[0] + 45)


@pytest.mark.slow
def test_reduced_keys_and_a_missing_root_are_said_before_the_solve(run: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    run.hangtime.result_keys.on = "REDUCED"
    with pytest.raises(RuntimeError, match="cannot have keys on “reduced”"):
        bpy.ops.hangtime.adapt()
    run.hangtime.result_keys.on = "EVERY_FRAME"
    run.hangtime.loop.root = "ROOT_BONE"
    with pytest.raises(RuntimeError, match="no bone above the pelvis"):
        bpy.ops.hangtime.adapt()
