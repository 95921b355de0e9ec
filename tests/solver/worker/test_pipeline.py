"""The pipeline's own doings: scaling to a stated stature, faults before the fit, what is timed."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.data.faults import (
    BesideFrames,
    ContradictoryPins,
    Fault,
    NotComputable,
    OutOfReach,
    PoseHeld,
    StillBone,
    UnknownBone,
    UnknownPhase,
    UnknownPhaseIn,
    computable,
)
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    ALWAYS,
    AddedMass,
    BodyChange,
    ConeLimit,
    LimbChange,
    PointAxes,
    PointRequest,
    PoseRequest,
    Requests,
    Shape,
    TorqueLimit,
    When,
)
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.worker.pipeline import ADAPTING, Subject, adapt_fit, measure, solve
from hangtime.solver.worker.possible import check_requested, stand_in
from hangtime.solver.worker.stage_clock import StageClock
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


TOP = When(frames=(sum(FRAMES) / 2, sum(FRAMES) / 2))
STANDING = When(frames=(FRAMES[0] + 3, FRAMES[0] + 3))


def at(name: str, bone: str, place: tuple[float, float, float], when: When = TOP) -> PointRequest:
    return PointRequest(name, bone, when, place=place)


def pinned(*pins: Pin, points: tuple[PointRequest, ...] = ()) -> MotionProblem:
    return MotionProblem(frames=FRAMES, pins=pins, requests=Requests(points=points))


def checked(problem: MotionProblem) -> None:
    check_requested(stand_in(hop().performance, hop().schedule), problem)


@pytest.mark.parametrize(
    ("problem", "fault", "named"),
    [
        (
            pinned(points=(at("Here", "LeftHand", (0, 0, 1)), at("There", "LeftHand", (0, 1, 1)))),
            ContradictoryPins,
            {"Here", "There"},
        ),
        (
            pinned(points=(at("Here", "LeftHand", (0, 0, 1)), at("Far", "RightHand", (0, 4, 1)))),
            ContradictoryPins,
            {"Here", "Far"},
        ),
        (
            pinned(points=(at("Ceiling", "LeftHand", (0, 0, 9), STANDING),)),
            ContradictoryPins,
            {"Ceiling", "Left heel 1"},
        ),
        (
            pinned(Pin("Split", "ground 2", ("Left heel", "Left toe"), offset=(0, 3, 0))),
            ContradictoryPins,
            {"Split", "Right toe 2"},
        ),
        (pinned(Pin("Leap", "ground 2", offset=(30, 0, 0))), OutOfReach, {"Leap", "Left heel 1"}),
        (
            pinned(points=(at("Moon", "LeftHand", (0, 90, 9)),)),
            OutOfReach,
            {"Moon", "Left heel 1"},
        ),
        (
            pinned(points=(PointRequest("Later", "LeftHand", When(frames=(9e3, 9e3))),)),
            BesideFrames,
            {"Later"},
        ),
        (
            pinned(points=(PointRequest("Never", "LeftHand", When("flight 9")),)),
            UnknownPhaseIn,
            {"Never"},
        ),
    ],
)
def test_what_nobody_can_do_is_said_before_the_fit(
    problem: MotionProblem, fault: type[Fault], named: set[str]
) -> None:
    with pytest.raises(fault) as found:
        checked(problem)
    said = [vars(found.value).get(key) for key in ("first", "second", "request", "other")]
    assert {name for name in said if isinstance(name, str)} == named


def posed(pose: PoseRequest, *pins: Pin) -> MotionProblem:
    return MotionProblem(frames=FRAMES, pins=pins, requests=Requests(poses=(pose,)))


def test_a_body_that_is_held_in_every_pose_lands_where_it_did() -> None:
    """The steps towards another landing took minutes before they gave up."""
    with pytest.raises(PoseHeld) as held:
        checked(posed(PoseRequest("As it is", ALWAYS), Pin("Leap", "ground 2", offset=(0, 0.2, 0))))
    assert (held.value.request, held.value.pin) == ("As it is", "Leap")
    assert held.value.metres == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize(
    ("pose", "offset"),
    [
        (PoseRequest("in flight", When("flight 1")), (0, 0.2, 0)),
        (PoseRequest("arm", ALWAYS, ("LeftForeArm",)), (0, 0.2, 0)),
        (PoseRequest("preferred", ALWAYS, weight=1.0), (0, 0.2, 0)),
        (PoseRequest("loose", ALWAYS, slack=0.2), (0, 0.2, 0)),
        (PoseRequest("a sole's", ALWAYS), (0, 0.01, 0)),
        (PoseRequest("further down", ALWAYS), (0, 0.2, -0.3)),
    ],
)
def test_a_pose_that_leaves_a_motion_is_not_refused(
    pose: PoseRequest, offset: tuple[float, float, float]
) -> None:
    checked(posed(pose, Pin("Leap", "ground 2", offset=offset)))


def test_all_stances_may_be_moved_with_a_held_body() -> None:
    pins = [Pin(name, name, offset=(0.4, 0.2, 0)) for name in ("ground 1", "ground 2")]
    checked(posed(PoseRequest("As it is", ALWAYS), *pins))


def test_a_pin_is_not_blamed_for_places_that_the_recording_has_apart() -> None:
    """A foot that is found in two places, one right after the other, and moved as a whole."""
    schedule = hop().schedule
    toe = next(c for c in schedule.contacts if c.name == "Right toe 1")
    turn = 0.5 * (toe.start + toe.end)
    away = replace(toe, name="Right toe 9", start=turn, place=toe.place + np.array([0.0, 0.3, 0.0]))
    contacts = [*(c for c in schedule.contacts if c is not toe), replace(toe, end=turn), away]
    torn = replace(schedule, contacts=tuple(sorted(contacts, key=lambda c: (c.start, c.point))))
    pin = Pin("Stance", "ground 1", offset=(0.1, 0.0, 0.0))
    check_requested(stand_in(hop().performance, torn), pinned(pin))


def test_what_can_be_done_is_not_refused_before_the_fit() -> None:
    reach = PointRequest("Reach", "LeftHand", TOP, relative=(0.3, 0, 0), axes=PointAxes.TRAVEL)
    steps = PointRequest("Then", "LeftHand", STANDING, relative=(0, 0, 0.2))
    checked(pinned(Pin("Leap", "ground 2", offset=(0.6, 0.1, 0.3)), points=(reach, steps)))
    far = pinned(Pin("Leap", "ground 2", offset=(30, 0, 0)))
    free = Requests(solution=SolverOptions(human=HumanRanges.OFF))
    checked(replace(far, requests=free))  # who knows how a figure jumps that is no human


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
    with pytest.raises(NotComputable), computable():
        np.linalg.cholesky(-np.eye(2))


@pytest.mark.slow
def test_what_is_beyond_reason_ends_with_what_could_not_be_met() -> None:
    """Matrices that were not positive definite ended in a traceback."""
    alone = SolverOptions(keep_times=True, solid=False, human=HumanRanges.OFF)
    requests = Requests(body=BodyChange(mass=1e-7, gravity=1e13), solution=alone)
    asked = subject().asked(MotionProblem(frames=FRAMES, requests=requests))
    fault = adapt_fit(asked, fitted_hop(), StageClock()).fault
    assert fault is not None
    # Which rows are worst hangs on the processor's rounding; a law of motion is among them.
    assert {each.kind for each in fault.worst} & {RowKind.MOMENT, RowKind.BALANCE}
