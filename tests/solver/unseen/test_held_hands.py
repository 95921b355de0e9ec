"""Who hangs is told that hands hold on to something, and what carries him in the result."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.recipe.problem import parse_recipe
from hangtime.bridge.recipe.requests import point_texts
from hangtime.operators.headless.explained import explained
from hangtime.operators.words.analysis_text import analysis_text
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.faults import OffBalance, UnseenSupport
from hangtime.solver.data.problem import AddedContact, MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.unseen.held_hands import HandTracks, holds
from hangtime.solver.unseen.support_force import HAND_OVER
from hangtime.tests.helpers.hung import BAR, RELEASE, hung

TIMES = np.linspace(0.0, 2.0, 121)
WIDTH = 0.06  # s
HANDS = ["LeftHand", "RightHand"]


def hand(height: float, head: float, pelvis: float, speed: float = 0.0) -> HandTracks:
    """Which is at a height, m, for a second, and then goes; speed: m/s, before."""
    joint, above, below = (
        np.outer(np.ones_like(TIMES), [0.0, 0.0, z]) for z in (height, head, pelvis)
    )
    joint[:, 0] = speed * TIMES + 3.0 * np.maximum(TIMES - 1.0, 0.0)
    return HandTracks(joint, joint, above, below)


def between_rungs() -> Recording:
    """Who swings three times as slowly, and moves one hand after the other to another rung."""
    swings = hung()
    held = int((swings.times <= RELEASE).sum())
    slow = np.concatenate([np.repeat(np.arange(held), 3), np.arange(held, len(swings.times))])
    times, heads = np.arange(len(slow)) / swings.rate, swings.heads[slow]
    for name, start in zip(HANDS, (1.3, 1.6), strict=True):
        moved = np.where(times <= 3.0 * RELEASE, np.clip((times - start) / 0.2, 0.0, 1.0), 0.0)
        heads[:, swings.index(name), 0] += 0.6 * moved
    rotations, frames = swings.rotations[slow], 1.0 + np.arange(len(slow))
    return replace(swings, times=times, frames=frames, heads=heads, rotations=rotations, known=())


def pulls_up(aside: float) -> Recording:
    """Who stands with the hands on a bar, pulls the body up by 0.5 m within 0.8 s and stays there.

    aside: m, by which the hands go to another bar, as soon as the feet have left the floor.
    """
    stands = hung()
    up = np.clip((stands.times - 0.7) / 0.8, 0.0, 1.0)
    heads = np.repeat(stands.heads[-1:], len(up), axis=0)
    heads[..., 2] += 0.5 * (up**2 * (3.0 - 2.0 * up))[:, None]
    goes = aside * np.clip((stands.times - 0.9) / 0.15, 0.0, 1.0)
    for name in HANDS:
        hand = stands.index(name)
        heads[:, hand] = heads[0, hand] * [1.0, 1.0, 0.0] + [0.0, 0.0, BAR]
        heads[:, hand, 0] += goes
    rotations = np.repeat(stands.rotations[-1:], len(up), axis=0)
    return replace(stands, heads=heads, rotations=rotations, known=())


def test_who_hangs_holds_on_until_he_lets_go() -> None:
    (grasp,) = holds(TIMES, hand(2.4, head=2.0, pelvis=1.3), WIDTH)
    assert (grasp.first, TIMES[grasp.last]) == (0, pytest.approx(1.0, abs=0.04))


@pytest.mark.parametrize(
    "other",
    [
        hand(0.9, head=1.5, pelvis=0.9),  # who sits with the hands on the knees
        hand(1.2, head=0.3, pelvis=0.8),  # who is upside down
        hand(2.4, head=2.0, pelvis=1.3, speed=0.5),
    ],
)
def test_hands_below_the_head_or_above_an_inverted_body_or_on_their_way_hold_nothing(
    other: HandTracks,
) -> None:
    assert holds(TIMES, other, WIDTH) == []


def test_who_hangs_is_told_points_that_carry() -> None:
    recording = hung()
    analysis = analyse(recording, MotionProblem())
    (told,) = analysis.unseen
    assert isinstance(told, UnseenSupport)
    assert [point.bone for point in told.holds] == HANDS
    for point in told.holds:
        assert point.environment
        assert point.grip
        assert point.when.frames is not None
        first, last = point.when.frames
        assert first == recording.frames[0]
        assert last == pytest.approx(recording.frames[0] + RELEASE * recording.rate, abs=1.0)
    said = explained(told, None)
    assert "hands hold on to something above" in said
    assert "Pushes Back and Grip (LeftHand 1 to" in said
    texts = point_texts(told.holds)
    assert parse_recipe("\n".join(texts)).problem.requests.points == told.holds
    assert all(text.strip() in said for text in texts)
    assert all(text in analysis_text(analysis, Origin("hung")) for text in texts)


@pytest.mark.parametrize("aside", [0.0, 0.6])
def test_hands_on_a_bar_hold_on_from_when_the_feet_leave_the_floor(aside: float) -> None:
    """Be they there before, or on another bar until then."""
    recording = pulls_up(aside)
    (told,) = analyse(recording, MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert [point.bone for point in told.holds] == HANDS
    for point in told.holds:
        assert point.when.frames is not None
        first, last = point.when.frames
        assert first >= told.first - HAND_OVER * recording.rate - 1.0
        assert last == recording.frames[-1]


def test_a_hand_that_takes_two_rungs_is_told_points_that_one_recipe_takes() -> None:
    (told,) = analyse(between_rungs(), MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert [point.bone for point in told.holds] == ["LeftHand"] * 2 + ["RightHand"] * 2
    texts = "\n".join(point_texts(told.holds))
    assert parse_recipe(texts).problem.requests.points == told.holds


def test_who_stands_on_something_unlisted_with_raised_hands_is_offered_a_box_as_well() -> None:
    (told,) = analyse(pulls_up(0.0), MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert [box.size[2] for box in told.boxes] == [pytest.approx(0.5, abs=0.02)]
    said = explained(told, None)
    assert "as on a box, and hands keep one place above the head" in said
    assert "[[object]]\nname" in said
    assert "[[point]]\nname" in said


def test_who_swings_from_a_bar_is_offered_no_box() -> None:
    (told,) = analyse(hung(), MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert told.boxes == ()


def test_hands_that_go_with_the_body_hold_nothing() -> None:
    (told,) = analyse(hung(high_hands=False), MotionProblem()).unseen
    assert isinstance(told, UnseenSupport)
    assert told.holds == ()


def test_of_contacts_from_which_a_body_hangs_askew_it_is_told_that_they_only_push() -> None:
    recording = hung()
    heads = recording.heads.copy()
    heads[:, [recording.index(hand) for hand in HANDS], 1] -= 1.5  # as a gust would have it
    recording = replace(recording, heads=heads)
    last = recording.frames[0] + RELEASE * recording.rate
    added = tuple(
        AddedContact(f"{side} hand", recording.frames[0], last) for side in ("Left", "Right")
    )
    (told,) = analyse(recording, MotionProblem(added=added)).unseen
    assert isinstance(told, OffBalance)
    assert told.touching == ("Left hand", "Right hand")
    assert [point.bone for point in told.holds] == HANDS
    said = sentence(told)
    assert "beside what touches (Left hand, Right hand)" in said
    assert "contacts only push. Give each hand a Point with Pushes Back and Grip" in said
