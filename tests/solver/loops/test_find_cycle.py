"""Which frames are a cycle, and what is said where none are."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.data.faults import (
    ClipTooShort,
    CycleTurns,
    Fault,
    NothingRecurs,
    NotInLoop,
)
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.requests import PhaseTiming, Requests
from hangtime.solver.loops.find_cycle import find_cycle
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.clips import load_recording

RUN, HOPS, JUMP = "run_1.bvh", "hops_in_place.bvh", "forward_jump_116cm.bvh"
STRIDE = 91  # frames, from left landing to left landing
FRAME = 2.0  # of which a landing is found


def asked(first: float, last: float) -> MotionProblem:
    return MotionProblem(frames=(first, last), loop=True)


@pytest.mark.parametrize("frames", [(24, 115), (28, 110), (10, 130), (60, 167)])
def test_range_becomes_a_whole_stride(frames: tuple[float, float]) -> None:
    cycle = find_cycle(load_recording(RUN), asked(*frames))
    first, last = cycle.frames
    assert abs(last - first - STRIDE) <= FRAME + 1.0
    assert first == frames[0]  # nothing lands or leaves there, so the start stays
    assert cycle.asked == frames


def test_start_moves_away_from_a_landing() -> None:
    landing = 31.8
    first, _ = find_cycle(load_recording(RUN), asked(32, 123)).frames
    assert 2.0 < abs(first - landing) < 5.0


def test_a_cycle_stays_one() -> None:
    once = find_cycle(load_recording(RUN), asked(28, 110)).frames
    assert find_cycle(load_recording(RUN), asked(*once)).frames == once


def standing() -> Recording:
    return load_recording(JUMP)


def turning() -> Recording:
    """Hops in place on a disc that turns by a degree a frame."""
    recording = load_recording(HOPS)
    middle = recording.heads[:, 0].mean(axis=0) * [1.0, 1.0, 0.0]
    turn = axis_rotation(2, np.radians(recording.frames))
    heads = np.einsum("tij,tbj->tbi", turn, recording.heads - middle) + middle
    return replace(recording, heads=heads, rotations=turn[:, None] @ recording.rotations)


@pytest.mark.parametrize(
    ("recording", "frames", "fault", "says"),
    [
        (load_recording, (24, 25), ClipTooShort, "24 to 25, are only 0.01 s"),
        (load_recording, (24, 67), NothingRecurs, "one landing of a foot to its next"),
        (standing, (1, 90), NothingRecurs, "Nothing repeats from frame 1 to 90"),
        (turning, (100, 172), CycleTurns, "only a straight cycle"),
    ],
)
def test_what_is_no_cycle_is_said(
    recording: object, frames: tuple[float, float], fault: type[Fault], says: str
) -> None:
    made = load_recording(RUN) if recording is load_recording else recording()  # type: ignore[operator]
    with pytest.raises(fault) as caught:
        find_cycle(made, asked(*frames))
    assert says in sentence(caught.value)


def test_what_a_loop_cannot_have_is_said() -> None:
    timing = PhaseTiming("Longer", "flight 1", seconds=0.3)
    problem = replace(asked(24, 115), requests=Requests(timings=(timing,)))
    with pytest.raises(NotInLoop) as caught:
        measure(load_recording(RUN), problem)
    assert "cannot have a timing" in sentence(caught.value)
