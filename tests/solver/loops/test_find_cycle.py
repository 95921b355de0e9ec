"""Which frames are a cycle, and what is said where none are."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.data.faults import (
    ClipTooShort,
    CycleClimbs,
    CycleTurns,
    Fault,
    NothingRecurs,
    NotInLoop,
    Treadmill,
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


def found(recording: Recording, first: float, last: float) -> tuple[float, float]:
    """Frames of the cycle nearest to those."""
    return find_cycle(recording, asked(first, last))[0].frames


@pytest.mark.parametrize("frames", [(24, 115), (28, 110), (10, 130), (60, 167)])
def test_range_becomes_a_whole_stride(frames: tuple[float, float]) -> None:
    cycle, _ = find_cycle(load_recording(RUN), asked(*frames))
    first, last = cycle.frames
    assert abs(last - first - STRIDE) <= FRAME + 1.0
    assert first == frames[0]  # nothing lands or leaves there, so the start stays
    assert cycle.asked == frames


def test_start_moves_away_from_a_landing() -> None:
    landing = 31.8
    first, _ = found(load_recording(RUN), 32, 123)
    assert 2.0 < abs(first - landing) < 5.0


def test_a_cycle_stays_one() -> None:
    once = found(load_recording(RUN), 28, 110)
    assert found(load_recording(RUN), *once) == once


@pytest.mark.slow
# Runs cut in a flight, while a foot stands, and just as one lands; and hops.
@pytest.mark.parametrize(
    ("name", "first", "count"),
    [("run_2.bvh", 28, 95), ("run_2.bvh", 48, 95), ("run_2.bvh", 35, 95), (HOPS, 561, 87)],
)
def test_a_clip_of_one_cycle_is_one(name: str, first: int, count: int) -> None:
    clip = load_recording(name).window(first, first + count)
    cycle, endless = find_cycle(clip, asked(*clip.ends))
    assert cycle.frames[1] - cycle.frames[0] == count
    assert abs(cycle.frames[0] - first) <= 4.0
    assert endless.frames[0] < first < first + count < endless.frames[-1]
    assert find_cycle(clip, asked(*cycle.frames))[0].as_asked
    assert find_cycle(held(clip, *cycle.frames), asked(*cycle.frames))[0].as_asked


def held(clip: Recording, first: float, last: float) -> Recording:
    """A clip with its end poses held, as Blender shows it beyond its keys, to as far as stated."""
    begin, end = min(first, clip.frames[0]), max(last, clip.frames[-1])
    frames = np.arange(begin, end + 1.0)
    shown = np.clip(frames, *clip.ends) - clip.frames[0]
    poses = replace(
        clip, heads=clip.heads[shown.astype(int)], rotations=clip.rotations[shown.astype(int)]
    )
    return replace(poses, frames=frames, times=(frames - begin) / clip.rate)


def test_a_clip_of_little_more_than_a_cycle_has_it_where_its_pose_comes_again() -> None:
    clip = load_recording("run_2.bvh").window(21, 130)
    first, last = found(clip, 21, 130)
    assert abs(last - first - 95) <= FRAME
    assert 21 <= first < last <= 130


def test_contacts_go_on_across_the_seam_of_a_clip_of_one_cycle() -> None:
    clip = load_recording("run_2.bvh").window(48, 143)
    subject = measure(clip, asked(48, 143))
    ends = (0.0, subject.schedule.duration)
    cut = [{c.point for c in subject.schedule.contacts if t in (c.start, c.end)} for t in ends]
    assert cut[0] == cut[1] != set()


def standing() -> Recording:
    return load_recording(JUMP)


def turning() -> Recording:
    """Hops in place on a disc that turns by a degree a frame."""
    recording = load_recording(HOPS)
    middle = recording.heads[:, 0].mean(axis=0) * [1.0, 1.0, 0.0]
    turn = axis_rotation(2, np.radians(recording.frames))
    heads = np.einsum("tij,tbj->tbi", turn, recording.heads - middle) + middle
    return replace(recording, heads=heads, rotations=turn[:, None] @ recording.rotations)


def on_treadmill() -> Recording:
    """A run whose hips keep their place along the floor."""
    recording = load_recording("run_2.bvh")
    heads = recording.heads - np.linspace(0, 1, len(recording.frames))[:, None, None] * level_way(
        recording
    )
    return replace(recording, heads=heads)


def uphill() -> Recording:
    return on_slope(0.1)


def downhill() -> Recording:
    return on_slope(-0.1)


def on_slope(steepness: float) -> Recording:
    """A run that rises by a share of its way."""
    recording = load_recording("run_2.bvh")
    heads = recording.heads.copy()
    way = np.linalg.norm((heads[:, :1] - heads[:1, :1])[..., :2], axis=2)
    heads[..., 2] += steepness * way
    return replace(recording, heads=heads)


def level_way(recording: Recording) -> np.ndarray:
    return (recording.heads[-1, 0] - recording.heads[0, 0]) * [1.0, 1.0, 0.0]


@pytest.mark.parametrize(
    ("recording", "frames", "fault", "says"),
    [
        (load_recording, (24, 25), ClipTooShort, "24 to 25, are only 0.01 s"),
        (load_recording, (24, 67), NothingRecurs, "one landing of a foot to its next"),
        (standing, (1, 90), NothingRecurs, "Nothing repeats from frame 1 to 90"),
        (turning, (100, 172), CycleTurns, "only a straight cycle"),
        (on_treadmill, (28, 122), Treadmill, "as the doctor's repair of drift does"),
        (uphill, (28, 110), CycleClimbs, "m higher at the cycle's end"),
        (downhill, (28, 122), CycleClimbs, "m lower at the cycle's end"),
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
