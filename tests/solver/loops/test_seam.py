"""A run cycle that is solved as periodic: cut in a flight, and while a foot stands."""

from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.contacts import PhaseKind
from hangtime.solver.data.faults import SeamStanceMoved
from hangtime.solver.data.loop import Cycle
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.loops.loop_report import loop_report
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.transcription.motion import Motion, dynamics_residual
from hangtime.tests.helpers.clips import load_recording

RUN = "run_2.bvh"
LEFT = (0.15, 0.0, 0.0)  # m, of one who runs towards -y
CUTS = {"in flight": (28, 122), "in a stance": (45, 139)}  # frames of one cycle


@cache
def looped(cut: str) -> Fit:
    analysis = analyse(load_recording(RUN), MotionProblem(frames=CUTS[cut]))
    return fit(analysis.performance, analysis.schedule, periodic=True)


@pytest.fixture(
    scope="module", params=[pytest.param("in flight", marks=pytest.mark.slow), "in a stance"]
)
def cycle(request: pytest.FixtureRequest) -> Fit:
    return looped(request.param)


def test_end_meets_start(cycle: Fit) -> None:
    motion = cycle.motion
    assert cycle.solved
    ends = np.array([0.0, motion.duration])
    for order in range(3):
        first, last = motion.angles(ends, order)
        np.testing.assert_allclose(last, first, atol=1e-6)
    first, last = motion.joint_centres(ends) - motion.com(ends)[:, None]
    np.testing.assert_allclose(last, first, atol=1e-6)
    np.testing.assert_allclose(*motion.com(ends, 1), atol=1e-6)
    np.testing.assert_allclose(*motion.com(ends, 2), atol=1e-3)
    along, aside, up = np.abs(np.diff(motion.com(ends), axis=0)[0])[[1, 0, 2]]
    assert along > 2.0
    assert aside < 0.1
    assert up < 1e-6
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    np.testing.assert_allclose(*motion.forces(ends) / weight, atol=1e-6)


def test_physics_holds_beside_the_seam(cycle: Fit) -> None:
    motion = cycle.motion
    beside = np.linspace(0.0, 0.03, 60)[1:]
    off = dynamics_residual(motion, np.concatenate([beside, motion.duration - beside]))
    assert np.abs(off.force).max() < 1e-6
    assert np.sqrt((off.moment**2).sum(axis=1).mean()) < 0.002


def test_steady_speed_needs_no_force_in_the_mean(cycle: Fit) -> None:
    motion = cycle.motion
    times = (np.arange(4000) + 0.5) * motion.duration / 4000
    mean = motion.forces(times).sum(axis=1).mean(axis=0)
    weight = motion.transcription.character.mass * motion.transcription.character.gravity
    np.testing.assert_allclose(mean / weight, [0.0, 0.0, 1.0], atol=2e-3)


def test_a_moved_stance_leaves_it_a_loop(cycle: Fit) -> None:
    phase = next(
        p.name for p in cycle.schedule.phases if p.kind is PhaseKind.GROUND and p.start > 0
    )
    pin = Pin("Further out", phase, offset=(0.05, 0.1, 0.0))
    adapted = adapt(cycle, MotionProblem(pins=(pin,), loop=True))
    assert adapted.solved
    motion = adapted.motion
    assert motion.duration == cycle.motion.duration
    ends = np.array([0.0, motion.duration])
    np.testing.assert_allclose(*motion.angles(ends), atol=1e-6)
    np.testing.assert_allclose(*motion.com(ends, 1), atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("cut", CUTS)
def test_a_stance_moved_aside_leaves_the_course(cut: str) -> None:
    """Every cycle has that foot there, and the other where it was: nothing turns."""
    cycle = looped(cut)
    adapted = adapt(cycle, MotionProblem(pins=(Pin("Aside", "ground 2", offset=LEFT),), loop=True))
    assert adapted.solved
    assert course(adapted.motion) == pytest.approx(course(cycle.motion), abs=0.01)
    report = loop_report(adapted.motion, Cycle((28.0, 122.0), (28.0, 122.0)), cycle.performance.com)
    assert abs(report.turned_deg) < 1.0


def test_the_report_tells_how_far_the_way_is_turned() -> None:
    motion = looped("in a stance").motion
    turned = axis_rotation(2, np.radians(-5.0))
    way = motion.com(np.array([0.0, motion.duration])) @ turned.T
    report = loop_report(motion, Cycle((45.0, 139.0), (45.0, 139.0)), way)
    assert report.turned_deg == pytest.approx(5.0, abs=1e-6)


def course(motion: Motion) -> float:
    """Direction of a cycle's way, degrees."""
    x, y, _ = np.diff(motion.com(np.array([0.0, motion.duration])), axis=0)[0]
    return float(np.degrees(np.arctan2(y, x)))


def test_a_torn_stance_is_refused() -> None:
    cycle = looped("in a stance")
    pin = Pin("Torn", "ground 1", touching=("Right heel",), offset=(0.0, 0.05, 0.0))
    with pytest.raises(SeamStanceMoved):
        adapt(cycle, MotionProblem(pins=(pin,), loop=True))
