"""Who rests on something unseen stays on it where feet are moved, as on a chair."""

from functools import cache

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem, OffsetAxes, Pin
from hangtime.solver.data.requests import PointRequest, Requests, When
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.interactive import Follower
from hangtime.solver.transcription.motion import Motion
from hangtime.solver.worker.pipeline import fit_subject, measure
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.helpers.leaned import leaned

pytestmark = pytest.mark.slow


@cache
def leaning() -> Fit:
    """Of who leans all the while on what was not recorded."""
    return fit_subject(measure(leaned(20.0), MotionProblem()), StageClock())


def moved(offset: float, step: str | None = None) -> Pin:
    """To the left, all of the stance or one foot."""
    return Pin(step or "All", "ground 1", (), (offset, 0.0, 0.0), OffsetAxes.WORLD, step=step)


def pelvis(motion: Motion) -> FloatArray:
    """(20, 3) m, its way from the fit's."""
    times = np.linspace(0.0, leaning().motion.duration, 20)
    return np.asarray((motion.joint_centres(times) - leaning().motion.joint_centres(times))[:, 0])


@pytest.mark.parametrize("offset", [0.02, 0.1])
def test_the_pelvis_stays_where_one_foot_is_moved(offset: float) -> None:
    """By what a whole body goes, it went along by half of the foot's way."""
    made = adapt(leaning(), MotionProblem(pins=(moved(offset, "Left heel 1"),)))
    assert made.solved
    assert np.linalg.norm(pelvis(made.motion), axis=1).max() < 0.1 * offset


def test_the_pelvis_stays_where_feet_are_spread() -> None:
    pins = moved(0.1, "Left heel 1"), moved(-0.05, "Right heel 1")
    made = adapt(leaning(), MotionProblem(pins=pins))
    assert made.solved
    assert np.linalg.norm(pelvis(made.motion), axis=1).max() < 0.01


def test_where_all_that_stands_is_moved_what_carries_goes_with_it() -> None:
    made = adapt(leaning(), MotionProblem(pins=(moved(0.1),)))
    assert made.solved
    np.testing.assert_allclose(pelvis(made.motion), np.tile([0.1, 0.0, 0.0], (20, 1)), atol=0.01)


@pytest.mark.parametrize(("step", "updates"), [(0.0005, 120), (0.006, 10)])
def test_a_drag_keeps_the_pelvis_too_however_small_its_steps(step: float, updates: int) -> None:
    """Each step is from the last one, and the seat is where the fit has it."""
    follower = Follower(leaning(), MotionProblem())
    for k in range(1, updates + 1):
        follower.follow(MotionProblem(pins=(moved(k * step, "Left heel 1"),)))
    assert np.linalg.norm(pelvis(follower.motion), axis=1).max() < 0.005


@pytest.mark.parametrize("bone", ["Hips", "LeftHand"])
def test_a_point_that_pushes_back_carries_beside_a_stance_that_is_moved(bone: str) -> None:
    """The remedy for who leans; that nothing found stood still was a crash."""
    first = leaning().performance.recording.frames[0]
    rest = PointRequest("Rest", bone, When(frames=(first + 20.0, first + 32.0)), environment=True)
    requests = Requests(points=(rest,))
    for pin in (moved(0.02), moved(0.02, "Left heel 1")):
        assert adapt(leaning(), MotionProblem(pins=(pin,), requests=requests)).solved


def test_where_the_pelvis_is_asked_for_it_goes_there_gently() -> None:
    """It is kept in no place beside the one that is asked for: it came back within 0.1 s."""
    first = leaning().performance.recording.frames[0]
    lower = PointRequest(
        "Low", "Hips", When(frames=(first + 40.0, first + 40.0)), relative=(0.0, 0.0, -0.03)
    )
    requests = Requests(points=(lower,))
    pins = (moved(0.05, "Left heel 1"),)
    motion = adapt(leaning(), MotionProblem(pins=pins, requests=requests)).motion
    up = pelvis(motion)[:, 2]
    assert up.min() < -0.02
    assert np.count_nonzero(up < 0.5 * up.min()) >= 4
