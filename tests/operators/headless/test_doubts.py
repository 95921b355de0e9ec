"""What is wrong with a recording is told before a fit that is to end far from it."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.headless.doubts import doubts_about
from hangtime.operators.words.doubt_text import MOST_DAMAGES, damage_doubts
from hangtime.solver.data.problem import AddedContact, ContactEdit, MotionProblem, Pin
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.scaling import scaled_recording
from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.meshes import box, thing

USUAL = MotionProblem()


def told(recording: Recording, problem: MotionProblem = USUAL) -> list[str]:
    return doubts_about(problem, None, measure(recording, problem), Origin("jump.bvh"))


def leaping() -> Recording:
    """The jump with one frame in which the whole body is 20 m higher."""
    recording = load_recording(JUMP)
    heads = recording.heads.copy()
    heads[109, :, 2] += 20.0
    return replace(recording, heads=heads)


def test_of_a_clean_recording_nothing_is_told() -> None:
    assert told(load_recording(JUMP)) == []


@pytest.mark.slow
def test_a_frame_that_no_fit_can_follow_is_told_with_where_its_remedy_is() -> None:
    recording = leaping()
    damage, remedy = told(recording)
    assert f"at frame {recording.frames[109]:g}" in damage
    assert "“doctor”" in remedy


def test_a_contact_that_is_to_last_while_its_foot_is_elsewhere_is_told() -> None:
    recording, late = load_recording(JUMP), 210.0
    for end, doubts in ((115.0, 0), (late, 1)):
        edited = replace(USUAL, contacts=(ContactEdit("Left toe 1", end_frame=end),))
        lines = [line for line in told(recording, edited) if "Left toe 1" in line]
        assert len(lines) == doubts, (end, lines)
    toe = recording.heads[:, recording.index("LeftToeBase")]
    flown = 100.0 * float(np.linalg.norm(toe[int(late - recording.frames[0])] - toe[0]))
    (said,) = re.findall(rf"([\d.]+) cm from where it touches \(frame {late:.0f}\)", lines[0])
    assert float(said) == pytest.approx(flown, rel=0.1)


def test_a_contact_that_is_added_while_its_point_goes_on_is_told() -> None:
    flight = AddedContact("Left toe", 120.0, 200.0)
    lines = told(load_recording(JUMP), replace(USUAL, added=(flight,)))
    assert [line for line in lines if "Left toe" in line and "from where it touches" in line]


def test_of_a_contact_whose_edit_changes_nothing_nothing_is_told_in_centimetres() -> None:
    recording = scaled_recording(load_recording(JUMP), 100.0)
    edited = replace(USUAL, height=1.75, contacts=(ContactEdit("Left toe 1", end_frame=115.0),))
    assert not [line for line in told(recording, edited) if "from where it touches" in line]


def test_at_a_stated_stature_lengths_are_told_as_recorded() -> None:
    lifted = load_recording(JUMP)
    lifted = replace(lifted, heads=lifted.heads + np.array([0.0, 0.0, 0.5]))
    floor, _ = told(lifted, replace(USUAL, height=1.5))
    assert "height of 0.5" in floor


def test_ground_of_the_scene_may_be_anywhere() -> None:
    lifted = load_recording(JUMP)
    lifted = replace(lifted, heads=lifted.heads + np.array([0.0, 0.0, 0.5]))
    stage = thing("Stage", box((9.0, 9.0, 0.5)), (0.0, 0.0, 0.25))
    assert told(lifted, replace(USUAL, scene=(stage,))) == []


@pytest.mark.slow
def test_a_landing_that_nobody_reaches_is_told_at_the_stated_stature() -> None:
    asked = replace(USUAL, pins=(Pin("Landing", "ground 2", offset=(0.0, 0.0, 1.5)),))
    assert told(load_recording(JUMP), asked) == []
    _, doubt = told(load_recording(JUMP), replace(asked, height=2.6))
    assert "“Landing”: ground 2 would be 2.3" in doubt


def test_a_pin_that_the_solve_refuses_tells_nothing_of_its_leap() -> None:
    asked = replace(USUAL, pins=(Pin("Landing", "ground 9", offset=(5.0, 0.0, 0.0)),))
    assert told(load_recording(JUMP), asked) == []


def test_of_many_damages_the_first_few_are_told() -> None:
    many = [
        Finding(FindingKind.FLIP, 180.0, "°", ((float(i), float(i)),), "Hips") for i in range(9)
    ]
    lines = damage_doubts(many)
    assert len(lines) == MOST_DAMAGES + 1
    assert lines[-1].startswith(f"{9 - MOST_DAMAGES} more; the command")
