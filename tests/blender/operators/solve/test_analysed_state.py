"""Whether an analysis still counts, and what of an armature is another since."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict, replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.repairs.analysed_state import STATE, AnalysedState
from hangtime.bridge.repairs.analysis_key import analysis_is_of, analysis_key
from hangtime.operators.solve.adapt import read_wanted
from hangtime.solver.analysis.motion_sketch import MotionSketch
from hangtime.solver.data.recording import POSE_TOLERANCE
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.jump_scene import FIRST, LAST

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


def test_a_file_that_another_processor_analysed_needs_no_analysis(
    analysed: bpy.types.Object,
) -> None:
    """Products of matrices end in other bits where they are computed by other instructions."""
    settings, read = analysed.hangtime, complete(read_wanted(analysed))
    bits = np.random.default_rng(0).choice([-1e-15, 1e-15], read.heads.shape)
    assert analysis_is_of(settings, replace(read, heads=read.heads * (1.0 + bits)))
    by_floats = np.random.default_rng(1).uniform(-1e-6, 1e-6, read.heads.shape)
    assert analysis_is_of(settings, replace(read, heads=read.heads + by_floats))
    assert not analysis_is_of(settings, replace(read, heads=read.heads + 1e-3))
    for grid in (POSE_TOLERANCE, 0.0):  # as earlier versions kept it
        settings.analysed = analysis_key(settings, read, grid, named=True, timed=True)
        assert analysis_is_of(settings, read)


def test_edit_mode_and_back_needs_no_analysis(analysed: bpy.types.Object) -> None:
    """It moves bones by a fraction of a micrometre."""
    for mode in ("EDIT", "OBJECT"):
        bpy.ops.object.mode_set(mode=mode)
    assert analysis_is_of(analysed.hangtime, complete(read_wanted(analysed)))


def test_a_sketch_that_is_left_is_no_analysis(analysed: bpy.types.Object) -> None:
    """As where the next results are made from a result, whose contacts are to be found anew."""
    settings = analysed.hangtime
    settings.use_range = False
    read = complete(read_wanted(analysed))
    settings.analysed, settings.analysed_motion = "", MotionSketch.of(read).text
    assert not analysis_is_of(settings, read)


@pytest.mark.usefixtures("analysed")
@pytest.mark.slow
def test_a_frame_rate_that_changed_is_named() -> None:
    """As importing another clip sets it. At the analysis' own all is as before."""
    render = bpy.context.scene.render
    before = render.fps, render.fps_base
    render.fps, render.fps_base = 24, 1.001
    told = r"frame rate changed from 120 to 23\.976 frames a second.*set it back to 120"
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.hangtime.fit()
    render.fps, render.fps_base = before
    assert bpy.ops.hangtime.fit() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def moved(armature: bpy.types.Object) -> None:
    armature.location.x += 1.0


def key_moved(armature: bpy.types.Object) -> None:
    curves_of(armature)[0].keyframe_points[150].co[1] += 0.1


def constrained(armature: bpy.types.Object) -> None:
    held = armature.pose.bones["LeftFoot"].constraints.new("LIMIT_ROTATION")
    held.use_limit_x, held.owner_space = True, "LOCAL"


def bone_renamed(armature: bpy.types.Object) -> None:
    armature.data.bones["LeftFoot"].name = "ankle.L"


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (moved, "its place"),
        (key_moved, "its keys"),
        (constrained, "its constraints"),
        (bone_renamed, "its bones"),
        (lambda a: (moved(a), constrained(a)), "its place, its constraints"),
    ],
)
def test_what_is_not_as_it_was_analysed_is_named(
    analysed: bpy.types.Object, change: Callable[[bpy.types.Object], object], named: str
) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    change(analysed)
    with pytest.raises(RuntimeError, match=rf"changed since the analysis \({named}\); press"):
        bpy.ops.hangtime.fit()


def test_bones_that_are_posed_otherwise_are_named_where_nothing_else_changed(
    analysed: bpy.types.Object,
) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    analysed.pose.bones["LeftForeArm"].location.y += 0.2  # which has no keys
    named = r"\(the pose of LeftForeArm, .*, most at frame \d+\); press Analyze again"
    with pytest.raises(RuntimeError, match=named):
        bpy.ops.hangtime.fit()


def test_what_changed_since_an_earlier_version_analysed_is_one_of_many(
    analysed: bpy.types.Object,
) -> None:
    """Which kept nothing of it."""
    for kept in ("analysed_state", "analysed_motion"):
        analysed.hangtime.property_unset(kept)
    moved(analysed)
    with pytest.raises(RuntimeError, match=r"its bones, place, .* or unit scale changed since"):
        bpy.ops.hangtime.fit()


def test_a_frame_time_with_fewer_digits_is_the_same_frame_rate(analysed: bpy.types.Object) -> None:
    """As importing another clip of the same capture sets it."""
    render, settings = bpy.context.scene.render, analysed.hangtime
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    recording = complete(read_wanted(analysed))
    for rate, same in ((1.0 / 0.008333, True), (1.0 / 0.00833, True), (120.0 / 1.001, False)):
        render.fps, render.fps_base = 120, 120.0 / rate
        assert analysis_is_of(settings, complete(read_wanted(analysed))) == same
    render.fps_base = 1.0
    assert analysis_is_of(settings, recording)


def test_a_frame_rate_that_no_one_kept_may_be_what_changed(analysed: bpy.types.Object) -> None:
    """In files of earlier versions."""
    for kept in ("analysed_rate", "analysed_state"):
        analysed.hangtime.property_unset(kept)
    bpy.context.scene.render.fps = 24
    with pytest.raises(
        RuntimeError, match=r"or the scene's frame rate .*changed since the analysis"
    ):
        bpy.ops.hangtime.fit()


@pytest.mark.slow
def test_frames_that_were_not_analysed_are_named(analysed: bpy.types.Object) -> None:
    """As ticking, or dragging, Frame Range chooses them. At the analysis' own all is as before."""
    settings = analysed.hangtime
    settings.last_frame = LAST - 10
    chosen = f"frames {FIRST} to {LAST - 10} are to be adapted now, but {FIRST} to {LAST} were"
    with pytest.raises(RuntimeError, match=chosen):
        bpy.ops.hangtime.adapt()
    settings.last_frame, settings.use_range = LAST, False
    with pytest.raises(RuntimeError, match=f"but {FIRST} to {LAST} were analysed"):
        bpy.ops.hangtime.adapt()
    settings.use_range = True
    assert bpy.ops.hangtime.fit() == {"FINISHED"}


@pytest.mark.slow
def test_an_action_may_be_renamed_after_the_analysis(analysed: bpy.types.Object) -> None:
    analysed.animation_data.action.name = "Take 7"
    assert bpy.ops.hangtime.fit() == {"FINISHED"}
    curves_of(analysed)[0].keyframe_points[150].co[1] += 0.1
    with pytest.raises(RuntimeError, match="changed since the analysis"):
        bpy.ops.hangtime.fit()
