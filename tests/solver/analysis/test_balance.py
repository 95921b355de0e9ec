"""Who sits or leans has the weight beside the feet; who stands, walks or lands has not."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.headless.explained import explained
from hangtime.operators.words.doctor_text import finding_sentence
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.balance import SURELY_LASTS, off_balance, pelvis_at_rest
from hangtime.solver.analysis.performance import contact_points
from hangtime.solver.data.faults import OffBalance
from hangtime.solver.data.problem import AddedContact, MotionProblem, Unseen
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.leaned import leaned

CLEAN = JUMP, "131_03_hop.bvh", "fair1_jumping.bvh", "cmu1_jumping_jacks.bvh", "run_2.bvh"


@pytest.mark.parametrize("name", CLEAN)
def test_feet_that_carry_the_body_are_below_its_weight(name: str) -> None:
    analysis = analyse(load_recording(name), MotionProblem())
    assert off_balance(analysis.performance, analysis.schedule, SURELY_LASTS) == ()
    assert analysis.unseen == ()


def test_who_leans_is_told_so() -> None:
    """Refused is what is sure: whether something must carry the fit tells."""
    analysis = analyse(leaned(20.0), MotionProblem(unseen=Unseen.REFUSE))
    (told,) = analysis.unseen
    assert isinstance(told, OffBalance)
    assert (told.spans, told.hands) == (((1.0, 90.0),), ())
    said = "In frames 1 to 90 the weight is beside the feet, as of who sits or leans"
    assert sentence(told).startswith(said)


def still(recording: Recording) -> Recording:
    """Who stays as in the first frame."""
    heads, rotations = (
        np.broadcast_to(each[:1], each.shape).copy()
        for each in (recording.heads, recording.rotations)
    )
    return replace(recording, heads=heads, rotations=rotations)


def with_palms(recording: Recording, height: float, speed: float = 0.0) -> Recording:
    """Both hands so high above the floor, m, before the body; speed: m/s, aside."""
    points, floor_m = contact_points(analyse(recording, MotionProblem()).performance)
    heads = recording.heads.copy()
    for side in ("Left", "Right"):
        palm = points[f"{side} hand"]
        down = floor_m + height - palm.track[0, 2]
        hand = recording.index(palm.bone)
        heads[:, hand] += [0.0, -0.3, down]
        heads[:, hand, 0] += speed * recording.times
    return replace(recording, heads=heads)


def test_of_who_leans_the_frames_are_told_in_which_the_pelvis_is_still() -> None:
    recording = still(leaned(20.0))
    heads = recording.heads.copy()
    heads[70:, :, 0] += (0.5 * np.arange(len(heads) - 70) / recording.rate)[:, None]
    (told,) = analyse(replace(recording, heads=heads), MotionProblem()).unseen
    assert isinstance(told, OffBalance)
    ((first, last),) = told.resting
    assert first == 1.0
    assert last == pytest.approx(70.0, abs=8.0)
    assert f"rests in frames {first:g} to {last:g}" in sentence(told)


def test_hands_on_the_floor_beside_the_feet_are_told_with_contacts_that_carry() -> None:
    """Palms at rest are higher than where one is sure to touch."""
    recording = with_palms(still(leaned(20.0)), height=0.1)
    (told,) = analyse(recording, MotionProblem()).unseen
    assert isinstance(told, OffBalance)
    assert [(c.point, c.start_frame, c.end_frame) for c in told.hands] == [
        ("Left hand", 1.0, 90.0),
        ("Right hand", 1.0, 90.0),
    ]
    said = explained(told, None)
    assert "for hands are on the ground" in said
    assert said.count("[[add_contact]]") == 3  # where they are asked for, and both
    assert analyse(recording, MotionProblem(added=told.hands)).unseen == ()


@pytest.mark.parametrize(("height", "speed"), [(0.2, 0.0), (0.1, 1.0)])
def test_hands_in_mid_air_or_that_slide_carry_nothing(height: float, speed: float) -> None:
    recording = with_palms(still(leaned(20.0)), height, speed)
    (told,) = analyse(recording, MotionProblem()).unseen
    assert isinstance(told, OffBalance)
    assert told.hands == ()


def test_a_hand_that_touches_is_named_and_no_chair_then() -> None:
    added = AddedContact("Left hand", 1.0, 60.0)
    told = analyse(leaned(20.0), MotionProblem(added=(added,))).unseen
    assert all(isinstance(each, OffBalance) for each in told)
    on_hand, on_feet = told
    assert isinstance(on_hand, OffBalance)
    assert on_hand.spans[0] == pytest.approx((1.0, 60.0), abs=1.0)
    assert "Left hand" in on_hand.touching
    assert "is beside what touches (" in sentence(on_hand)
    assert "sits" not in sentence(on_hand)
    assert "the weight is beside the feet" in sentence(on_feet)


def test_a_pelvis_above_the_shoulders_does_not_rest() -> None:
    """As in a handstand, however still it is; whoever lies on the floor may have it higher."""
    recording = still(leaned(0.0))
    heads, rotations = recording.heads.copy(), recording.rotations.copy()
    turn, later = axis_rotation(0, np.pi), slice(45, None)
    heads[later] = heads[later] @ turn.T + [0.0, 0.0, 2.0]
    rotations[later] = turn @ rotations[later]
    turned = replace(recording, heads=heads, rotations=rotations)
    at_rest, low = pelvis_at_rest(analyse(turned, MotionProblem()).performance)
    assert at_rest[:10].all()  # later ones are smoothed with the turn
    assert not at_rest[later].any()
    assert not low.any()


def test_the_doctor_notes_who_leans() -> None:
    notes = [finding_sentence(each) for each in diagnose(leaned(20.0)).findings]
    assert any(
        note.startswith("The weight is beside what touches in frames 1 to 90") for note in notes
    )


def test_who_leans_a_little_is_not() -> None:
    """Over toes, though not by a hand's breadth beyond them."""
    assert analyse(leaned(8.0), MotionProblem()).unseen == ()
