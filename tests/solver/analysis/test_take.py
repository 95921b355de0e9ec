"""A range cut out of a longer take is analysed as the take is: its frames beyond the cuts tell."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.accelerations import com_acceleration
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.analysis.take import take_of
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import BEYOND, Recording
from hangtime.tests.helpers.clips import load_recording

JUMP, RUN = "forward_jump_116cm.bvh", "run_1.bvh"
CUTS = {  # frames: the range cuts contacts, and movements that its frames alone would misjudge
    "push to landing": (JUMP, 150.0, 240.0),
    "flight to crouch": (JUMP, 200.0, 255.0),
    "stance to stance": (RUN, 36.0, 115.0),
}
WITHIN = 0.015  # s; instants nearer than 12 ms share a knot
MIN_PIECE = 0.03  # s; less of a contact is not taken for one
SAME_PLACE = 0.015  # m; where a sole is depends a little on the frames that are known


@cache
def whole(clip: str) -> Analysis:
    return analyse(load_recording(clip), MotionProblem())


def found(clip: str, first: float, last: float, *, beyond: bool) -> Analysis:
    recording = load_recording(clip)
    recording = recording if beyond else recording.window(first, last)
    return analyse(recording, MotionProblem(frames=(first, last)))


@pytest.mark.parametrize("cut", CUTS)
def test_contacts_are_those_of_the_whole_take_as_far_as_the_range_goes(cut: str) -> None:
    clip, first, last = CUTS[cut]
    schedule = found(clip, first, last, beyond=True).schedule
    start = (first - 1.0) / load_recording(clip).rate
    expected = {}
    for contact in whole(clip).schedule.contacts:
        span = max(contact.start - start, 0.0), min(contact.end - start, schedule.duration)
        if span[1] - span[0] > MIN_PIECE:
            expected[contact.point, round(span[0], 1)] = (*span, contact.place)
    assert len(schedule.contacts) == len(expected)
    for contact in schedule.contacts:
        begins, ends, place = next(
            each
            for (point, _), each in expected.items()
            if point == contact.point and each[0] < contact.end and each[1] > contact.start
        )
        assert contact.start == pytest.approx(begins, abs=WITHIN)
        assert contact.end == pytest.approx(ends, abs=WITHIN)
        assert contact.place == pytest.approx(place, abs=SAME_PLACE)


@pytest.mark.parametrize(("left", "counts"), [(0.02, False), (0.05, True)])
def test_a_landing_that_the_range_hardly_reaches_is_none(left: float, counts: bool) -> None:
    jump = load_recording(JUMP)
    landing = whole(JUMP).schedule.flights[0].end
    last = 1.0 + round((landing + left) * jump.rate)
    schedule = analyse(jump, MotionProblem(frames=(last - 60.0, last))).schedule
    assert (schedule.flights[-1].end < schedule.duration) == counts


@pytest.mark.parametrize("cut", CUTS)
def test_accelerations_at_the_cuts_are_the_take_s(cut: str) -> None:
    clip, first, last = CUTS[cut]
    performance = found(clip, first, last, beyond=True).performance
    times, start = performance.times, (first - 1.0) / load_recording(clip).rate
    none = replace(whole(clip).schedule, contacts=())
    none = replace(none, unseen=(), duration=0.0)  # no flight, so nothing is set to gravity
    theirs = com_acceleration(whole(clip).performance, none, times + start)
    ours = com_acceleration(performance, none, times)
    alone = com_acceleration(found(clip, first, last, beyond=False).performance, none, times)
    assert ours == pytest.approx(theirs, abs=0.3)
    ends = [0, -1]
    assert np.abs(alone - theirs)[ends].max() > 10.0 * np.abs(ours - theirs)[ends].max()


def test_without_frames_beyond_nothing_but_the_range_counts() -> None:
    performance = found(RUN, 36.0, 115.0, beyond=False).performance
    assert performance.take is performance


def test_the_result_is_of_the_range_alone() -> None:
    performance = found(RUN, 36.0, 115.0, beyond=True).performance
    assert performance.recording.frames.tolist() == np.arange(36.0, 116.0).tolist()
    assert performance.times[0] == 0.0
    assert len(performance.com) == 80


def take(recording: Recording) -> list[float]:
    """First and last frame that tell of frames 70 to 90."""
    frames = take_of(recording, recording.window(70.0, 90.0)).frames
    return frames[[0, -1]].tolist()


def test_half_a_second_counts_on_both_sides() -> None:
    run = load_recording(RUN)
    reach = BEYOND * run.rate
    assert take(run) == [70.0 - reach, 90.0 + reach]
    assert take(run.window(60.0, 95.0)) == [60.0, 95.0]


def test_a_held_pose_and_a_jump_are_no_part_of_the_take() -> None:
    """Before the first key of an action Blender holds its pose; many files begin with a T-pose."""
    run = load_recording(RUN)
    heads = run.heads.copy()
    heads[:50] = heads[50]
    heads[100:] += 0.3
    assert take(replace(run, heads=heads)) == [51.0, 100.0]


def test_support_that_nobody_sees_is_no_matter_beyond_the_range() -> None:
    """Who comes down a ramp to the take-off, which is the range: of the whole take it is told."""
    jump = load_recording(JUMP)
    flight = whole(JUMP).schedule.flights[0]
    frames = 1.0 + np.ceil(flight.start * jump.rate), 1.0 + np.floor(flight.end * jump.rate) + 40.0
    raised = jump.heads.copy()
    raised[..., 2] += 0.5 * np.clip((flight.start - jump.times) / 0.4, 0.0, 1.0)[:, None]
    ramp = replace(jump, heads=raised)
    assert analyse(ramp, MotionProblem()).unseen
    within = analyse(ramp, MotionProblem(frames=frames))
    assert within.schedule.flights
    assert within.unseen == ()
