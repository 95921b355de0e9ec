"""The pipeline's own doings: scaling to a stated stature, faults before the fit, what is timed."""

import numpy as np
import pytest
from hangtime.solver.data.faults import Fault, NotComputable, StillBone, UnknownBone, UnknownPhase
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    AddedMass,
    BodyChange,
    ConeLimit,
    LimbChange,
    Requests,
    Shape,
    TorqueLimit,
)
from hangtime.solver.data.solver_options import SolverOptions
from hangtime.solver.stages.fit import Fit
from hangtime.solver.worker.pipeline import ADAPTING, StageClock, Subject, adapt_fit, measure, solve
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of, hop

FURTHER = Pin("further", "ground 2", offset=(0.1, 0.0, 0.0))
FRAMES = frames_of(HOP_CLIP, HOP)


def subject(*pins: Pin) -> Subject:
    return Subject(hop(), MotionProblem(frames=FRAMES, pins=pins), 1.76, 1.0)


def unfitted(_: Subject, __: StageClock) -> Fit:
    raise AssertionError("fitted in vain")


def test_a_wrong_name_is_said_before_the_fit() -> None:
    with pytest.raises(UnknownPhase):
        solve(subject(Pin("nowhere", "ground 7")), StageClock(), unfitted)


@pytest.mark.parametrize(
    ("requests", "fault"),
    [
        (Requests(shapes=(Shape("Ring", ("LeftFingerBase",)),), solution=solution), StillBone)
        for solution in (SolverOptions(solid=True), SolverOptions(solid=False))
    ]
    + [
        (Requests(cones=(ConeLimit("Arm", "LeftFingerBase", 1.0),)), StillBone),
        (Requests(torques=(TorqueLimit("Limp", ("LeftKnee",), bound=0.0),)), StillBone),
        (Requests(body=BodyChange(added=(AddedMass("Bag", "Wing", 1.0),))), UnknownBone),
        (Requests(body=BodyChange(limbs=(LimbChange("Tail", ("Tail",), 2.0),))), UnknownBone),
    ],
)
def test_a_wrong_bone_is_said_before_the_fit(requests: Requests, fault: type[Fault]) -> None:
    asked = subject().asked(MotionProblem(frames=FRAMES, requests=requests))
    with pytest.raises(fault):
        solve(asked, StageClock(), unfitted)


def test_a_stated_stature_scales_the_solvers_lengths_alone() -> None:
    plain = MotionProblem(frames=FRAMES, pins=(FURTHER,))
    tall = MotionProblem(frames=FRAMES, pins=(FURTHER,), height=2.0)
    recording = load_recording(HOP_CLIP)
    one, other = measure(recording, plain), measure(recording, tall)
    assert one.factor == 1.0
    assert other.analysis.performance.character.height == pytest.approx(2.0)
    assert other.height == pytest.approx(one.height)
    assert other.problem.pins[0].offset[0] == pytest.approx(0.1 * other.factor)
    assert other.asked(tall).problem == other.problem
    assert other.asked(plain).problem == plain
    np.testing.assert_allclose(
        other.recorded_traces().heads, one.recorded_traces().heads, atol=1e-3
    )


def test_a_solution_is_timed_and_has_all_its_parts() -> None:
    clock = StageClock()
    result = adapt_fit(subject(FURTHER), fitted_hop(), clock)
    assert result.fault is None
    assert [stage.name for stage in clock.done] == [ADAPTING]
    assert clock.done[0].seconds > 0.0
    np.testing.assert_array_equal(result.track.frames, result.traces().frames)
    assert result.recording.frames[0] == result.track.frames[0]


def test_what_no_numbers_can_hold_is_a_fault() -> None:
    """Matrices that are not positive definite ended in a traceback."""
    requests = Requests(body=BodyChange(mass=1e-7, gravity=1e13))
    asked = subject().asked(MotionProblem(frames=FRAMES, requests=requests))
    with pytest.raises(NotComputable):
        adapt_fit(asked, fitted_hop(), StageClock())
