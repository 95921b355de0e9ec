"""The main job as a script asks for it, and what its settings and texts ask for."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.rows.phases import phases_of
from hangtime.solver.data.solver_options import HumanRanges
from hangtime.tests.blender.helpers.actions import snapshot
from hangtime.tests.blender.helpers.jump_scene import (
    FIRST,
    LAST,
    SceneState,
    ask_by_text,
    drift,
    landing,
)
from mathutils import Vector

OFFSET = np.array([0.3, 0.1, 0.2])  # forward, left, up

pytestmark = pytest.mark.usefixtures("_enabled")


def test_the_landing_moves_and_the_recording_stays(analysed: bpy.types.Object) -> None:
    settings, recorded = analysed.hangtime, analysed.animation_data.action
    keys = snapshot(recorded, analysed)
    stance = settings.stances["ground 2"]
    stance.forward, stance.left, stance.up = OFFSET
    settings.keep_times = True  # so that the contacts' frames are still those of the rows
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    adapted = analysed.animation_data.action
    assert adapted != recorded
    assert adapted.hangtime.recording == recorded
    assert recorded.use_fake_user
    assert snapshot(recorded, analysed) == keys
    for row in landing(settings):
        moved = np.array(row.place) - np.array(row.found_at)
        assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm(OFFSET), abs=1e-4)
        assert drift(analysed, row) < 0.002
    assert settings.status.startswith("Solved in")
    assert bpy.ops.hangtime.show_recording() == {"FINISHED"}
    assert analysed.animation_data.action == recorded
    assert bpy.ops.hangtime.show_adapted() == {"FINISHED"}
    assert analysed.animation_data.action == adapted


@pytest.mark.slow
def test_settings_survive_saving_and_still_adapt(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    settings = analysed.hangtime
    settings.mass, settings.mass_table = 62.0, "DE_LEVA"
    settings.contacts[0].used = False
    settings.stances["ground 2"].up = 0.05
    name = analysed.name
    stored = SceneState.of(analysed)
    path = str(tmp_path / "jump.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    loaded = bpy.data.objects[name]
    assert SceneState.of(loaded) == stored
    assert (loaded.hangtime.mass, loaded.hangtime.mass_table) == (62.0, "DE_LEVA")
    assert bpy.context.scene.hangtime.armature == loaded
    loaded.hangtime.contacts[0].used = True
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}


def test_what_was_changed_is_kept_by_another_analysis(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    settings.contacts["Right heel 1"].used = False
    settings.contacts["Left heel 1"].end_frame = 120.0
    settings.stances["ground 2"].forward = 0.3
    settings.stances["ground 2"].turn = 0.2
    changed = SceneState.of(analysed).contacts
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    again = SceneState.of(analysed).contacts
    for one, other in zip(changed, again, strict=True):
        assert one[:2] == other[:2]
        np.testing.assert_allclose(one[2:], other[2:], atol=1e-5)
    assert settings.stances["ground 2"].forward == pytest.approx(0.3, abs=1e-5)
    assert settings.stances["ground 2"].turn == pytest.approx(0.2, abs=1e-5)


# ---------------------------------------------------------------- requests


@pytest.mark.slow
def test_a_text_of_requests_is_met(analysed: bpy.types.Object) -> None:
    analysed.hangtime.keep_out, analysed.hangtime.human_ranges = False, False  # quicker
    ask_by_text(
        analysed,
        '[[torque]]\nname = "Weak ankle"\nbones = ["RightFoot"]\nbound = 60\n'
        'phase = "ground 1"\n[[load]]\nname = "Briefcase"\nbone = "RightHand"\nshare = 0.1\n',
    )
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert analysed.animation_data.action.name.endswith("adapted")
    problem = problem_of(analysed.hangtime, read_recorded(analysed, FIRST, LAST))
    assert [limit.name for limit in problem.requests.torques] == ["Weak ankle"]
    assert [load.share for load in problem.requests.body.added] == [0.1]


@pytest.mark.slow
def test_a_longer_jump_has_more_frames_and_is_played_to_its_end(
    analysed: bpy.types.Object,
) -> None:
    scene, recorded = bpy.context.scene, analysed.animation_data.action
    scene.frame_end = int(recorded.frame_range[1])
    analysed.hangtime.stances["ground 2"].forward = 0.2
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    adapted = analysed.animation_data.action
    assert adapted.frame_range[1] > recorded.frame_range[1] + 3
    assert adapted.frame_range[1] <= scene.frame_end < adapted.frame_range[1] + 1
    assert f"The scene now ends at frame {scene.frame_end}" in analysed.hangtime.status
    assert re.search(r"Flight 1: 0\.\d\d s, was 0\.4\d s", analysed.hangtime.status)
    assert "Flight 1    takes 0." in adapted.hangtime.report


@pytest.mark.slow
def test_a_hand_is_on_a_ball_that_moves_as_the_longer_result_is_played(
    analysed: bpy.types.Object,
) -> None:
    settings, scene = analysed.hangtime, bpy.context.scene
    flight = next(p for p in phases_of(settings) if p.name == "flight 1")
    first, last = flight.start + 22.0, flight.start + 30.0
    ball = bpy.data.objects.new("Ball", None)
    scene.collection.objects.link(ball)
    for frame in np.arange(first - 10.0, last + 30.0):
        ball.location = hand(analysed, frame)
        ball.location.z += 0.05
        ball.keyframe_insert("location", frame=frame)
    scene.frame_set(int(first))
    bpy.ops.hangtime.add_constraint(kind="POINT")
    (row,) = settings.constraints
    row.bones.add().name = "LeftHand"
    row.use_offset, row.offset = True, (0.0, 0.0, 0.0)
    row.target, row.span, row.first_frame, row.last_frame = ball, "FRAMES", first, last
    settings.stances["ground 2"].forward = 0.2
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    held = re.fullmatch(r"Met at frames ([\d.]+) to ([\d.]+) \(the recording's .*\)", row.status)
    assert f"{row.name}: {row.status.replace('Met', 'held')}" in settings.status
    begin, end = map(float, held.groups())
    assert begin > first + 1.0  # else nothing was retimed
    for frame in np.linspace(begin, end, 9):
        shown = hand(analysed, frame)
        assert (shown - ball.matrix_world.translation).length < 0.005


def hand(armature: bpy.types.Object, frame: float) -> Vector:
    """Where the left hand is played."""
    bpy.context.scene.frame_set(int(frame), subframe=frame % 1.0)
    return armature.matrix_world @ armature.pose.bones["LeftHand"].head


def test_times_are_kept_where_that_is_chosen(analysed: bpy.types.Object) -> None:
    recording = read_recorded(analysed, FIRST, LAST)
    assert not problem_of(analysed.hangtime, recording).requests.solution.keep_times
    analysed.hangtime.keep_times = True
    ask_by_text(analysed, "[solution]\nlongest_span = 0.1\n")
    solution = problem_of(analysed.hangtime, recording).requests.solution
    assert (solution.keep_times, solution.longest_span) == (True, 0.1)


@pytest.mark.parametrize(
    ("setting", "option"),
    [("keep_out", "solid"), ("human_ranges", "human")],
    ids=["limbs", "joints"],
)
def test_the_body_is_solid_and_human_unless_switched_off(
    analysed: bpy.types.Object, setting: str, option: str
) -> None:
    recording = read_recorded(analysed, FIRST, LAST)

    def asked() -> object:
        return getattr(problem_of(analysed.hangtime, recording).requests.solution, option)

    assert asked()
    setattr(analysed.hangtime, setting, False)
    assert not asked()
    setattr(analysed.hangtime, setting, True)
    ask_by_text(analysed, f"[solution]\n{option} = false\n")
    assert not asked()


def test_ranges_are_hard_or_wider_where_asked(analysed: bpy.types.Object) -> None:
    recording = read_recorded(analysed, FIRST, LAST)
    analysed.hangtime.hard_ranges, analysed.hangtime.wider_ranges = True, 0.25
    solution = problem_of(analysed.hangtime, recording).requests.solution
    assert (solution.human, solution.wider) == (HumanRanges.HARD, 0.25)
    analysed.hangtime.hard_ranges = False
    ask_by_text(analysed, '[solution]\nhuman = "hard"\n')
    assert problem_of(analysed.hangtime, recording).requests.solution.human is HumanRanges.HARD


@pytest.mark.slow
def test_longer_limbs_perform_on_an_armature_of_their_own(analysed: bpy.types.Object) -> None:
    analysed.hangtime.keep_out, analysed.hangtime.human_ranges = False, False  # quicker
    bones = '["LeftUpLeg", "RightUpLeg", "LeftLeg", "RightLeg"]'
    ask_by_text(analysed, f'[[limb]]\nname = "Long legs"\nbones = {bones}\nlength = 1.15\n')
    recorded = analysed.animation_data.action
    keys = snapshot(recorded, analysed)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert snapshot(recorded, analysed) == keys
    other = bpy.data.objects[f"{analysed.name} changed"]
    longer = other.data.bones["LeftLeg"].length / analysed.data.bones["LeftLeg"].length
    scale = analysed.matrix_world.median_scale
    assert longer == pytest.approx(1.15 * scale, rel=0.01)
    assert other.animation_data.action is not None
    assert "keys do not show" not in analysed.hangtime.status  # which are in other axes
