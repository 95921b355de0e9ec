"""Where hands that roll over the floor carry the body, the contacts to add are told."""

from dataclasses import replace

import numpy as np
from hangtime.bridge.recipe.contacts import added_texts
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.operators.headless.explained import explained
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.analysis.performance import contact_points
from hangtime.solver.arrays import BoolArray
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.helpers.clips import JUMP, load_recording

ON_HANDS = 20, 85  # frames, from the first; half a second
TURNING = 0.05  # s; a sharp turn, in which nothing touches
SPEED = 0.6  # m/s; at which no contact of a hand is found


def standing() -> Recording:
    """Who stands before the jump."""
    return load_recording(JUMP).window(1.0, 110.0)


def on_hands(lift: float = 0.0) -> Recording:
    """Who stands, and between two frames is upside down, rolling over his palms. lift: m."""
    stood = standing()
    during = between(stood)
    performance = analyse(stood, MotionProblem()).performance
    points, floor_m = contact_points(performance)
    turn = axis_rotation(0, np.pi)
    heads, rotations = stood.heads.copy(), stood.rotations.copy()
    heads[during] = stood.heads[during] @ turn.T
    rotations[during] = turn @ stood.rotations[during]
    palms = np.stack([points[f"{side} hand"].track for side in ("Left", "Right")])
    highest = (palms @ turn.T)[:, during, 2].max()
    heads[during, :, 2] += floor_m + 0.03 - highest + lift
    heads[during, :, 0] += SPEED * (stood.times[during] - stood.times[during][0])[:, None]
    return replace(stood, heads=heads, rotations=rotations)


def between(stood: Recording) -> BoolArray:
    index = np.arange(len(stood.times))
    return np.asarray((index >= ON_HANDS[0]) & (index <= ON_HANDS[1]))


def told(recording: Recording) -> tuple[Analysis, UnseenSupport]:
    analysis = analyse(recording, MotionProblem())
    (unseen,) = analysis.unseen
    assert isinstance(unseen, UnseenSupport)
    return analysis, unseen


def test_hands_on_the_floor_are_told_with_contacts_that_carry() -> None:
    recording = on_hands()
    _, unseen = told(recording)
    first, last = recording.frames[list(ON_HANDS)]
    assert {each.point for each in unseen.hands} == {"Left hand", "Right hand"}
    for each in unseen.hands:
        assert (each.start_frame, each.end_frame) == (first, last)
    said = explained(unseen, None)
    assert f"(Left hand {first:g} to {last:g}, Right hand {first:g} to {last:g})" in said
    assert all(text.strip() in said for text in added_texts(unseen.hands))
    added = parse_recipe("\n".join(added_texts(unseen.hands))).problem.added
    assert added == unseen.hands
    left = analyse(recording, MotionProblem(added=added)).schedule.unseen
    assert max(each.end - each.start for each in left) < TURNING


def test_hands_in_mid_air_carry_nothing() -> None:
    _, unseen = told(on_hands(lift=0.4))
    assert unseen.hands == ()
    assert "Left hand" not in explained(unseen, None)
