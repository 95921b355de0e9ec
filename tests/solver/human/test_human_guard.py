"""Human by default: joints keep to a person's ranges, or the recording's; what cannot is told."""

from dataclasses import replace
from functools import cache
from math import radians

import numpy as np
import pytest
from hangtime.operators.words.headline import headline
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.requests import AngleLimit, OrientationRequest, Requests, Shape, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.data.status import Status
from hangtime.solver.human.human_guard import HumanGuard, recorded_ranges
from hangtime.solver.human.ranges import joint_ranges
from hangtime.solver.results.report import report
from hangtime.solver.results.violations import most_telling
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.validity import assert_valid

MOST = 0.5  # degrees beyond; 3 are allowed
FAR = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.6, 0.0, 0.0)),))
NEAR = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.02, 0.0, 0.0)),))


def any_body(problem: MotionProblem) -> MotionProblem:
    """The same of a figure that is no human."""
    solution = replace(problem.requests.solution, human=HumanRanges.OFF)
    return replace(problem, requests=replace(problem.requests, solution=solution))


@cache
def unguarded() -> Adaptation:
    """The far landing by a figure that is no human."""
    return adapt(fitted_hop(), any_body(FAR))


def beyond(adaptation: Adaptation) -> dict[str, float]:
    """Degrees beyond its range, by what a joint does."""
    reference = adaptation.setup.context.reference
    guard = HumanGuard(recorded_ranges(reference), reference)
    return {
        each.name: float(np.degrees(each.amount)) for each in guard.violations(adaptation.motion)
    }


@pytest.mark.slow
def test_a_far_landing_keeps_joints_in_their_ranges() -> None:
    before = beyond(unguarded())
    assert max(before.values()) > 5.0
    adaptation = adapt(fitted_hop(), FAR)
    assert adaptation.solved
    assert_valid(adaptation.motion, adaptation.setup.schedule)
    assert max(beyond(adaptation).values(), default=0.0) < MOST


def test_the_fit_is_within_its_own_ranges() -> None:
    guard = adapt(fitted_hop(), NEAR).setup.human
    assert guard is not None
    assert not guard.violations(fitted_hop().motion)
    assert guard.recorded  # the recording itself goes beyond a person's


def test_the_fit_bends_no_joint_further_than_a_person_or_the_recording() -> None:
    performance, fitted = fitted_hop().performance, fitted_hop().motion
    angles, found = performance.angles, fitted.joint_rotations(performance.times)
    for limit in joint_ranges(performance.character, angles):
        axes, dofs = limit.measure.joint.axes, limit.measure.joint.dofs
        allowed = limit.holding(axes.rotation(angles[:, dofs]))
        assert allowed.beyond(found[:, limit.body]).max() < radians(MOST), limit.name
    assert not fitted.transcription.guards


@pytest.mark.slow
def test_what_is_off_has_no_rows() -> None:
    assert unguarded().setup.human is None
    assert unguarded().motion.transcription.guard(RowKind.RANGE) is None


@pytest.mark.slow
def test_a_joint_that_the_artist_limits_is_the_artist_s() -> None:
    """A knee is asked to bend further than a person's can."""
    frame = float(fitted_hop().performance.recording.frames[0]) + 60.0
    when = When(frames=(frame - 1.0, frame + 1.0))
    asked = AngleLimit("Folded", "LeftLeg", radians(150.0), None, when)
    adaptation = adapt(fitted_hop(), MotionProblem(requests=Requests(angles=(asked,))))
    assert adaptation.solved
    assert beyond(adaptation).pop("Left knee bends") > 10.0


def nodding(
    solution: SolverOptions, shapes: tuple[Shape, ...] = (), tilt: float = 90.0
) -> MotionProblem:
    """The head is asked to tilt by so many degrees for a moment, with the chest held as it was."""
    frame = float(fitted_hop().performance.recording.frames[0]) + 60.0
    when = When(frames=(frame - 1.0, frame + 1.0))
    asked = (
        OrientationRequest("Nod", "Head", when, tilt=radians(tilt)),
        OrientationRequest("Chest", "Spine1", when),
    )
    return MotionProblem(requests=Requests(orientations=asked, shapes=shapes, solution=solution))


@pytest.mark.slow
def test_what_cannot_be_met_is_given_up_and_told_by_name() -> None:
    problem = nodding(SolverOptions())
    adaptation = adapt(fitted_hop(), problem)
    assert adaptation.solved
    left = beyond(adaptation)
    assert max(left.values()) > 10.0
    assert all(name.startswith("Neck") for name in left)
    told = report(adaptation, problem, Origin("hop"))
    name = max(left, key=lambda each: left[each])
    assert any(name in line and "°" in line for line in headline(told))


@pytest.mark.slow
def test_what_no_body_can_do_is_no_success_and_told_by_name() -> None:
    problem = nodding(SolverOptions(), tilt=170.0)
    found = adapt(fitted_hop(), problem)
    assert found.outcome.status is Status.NO_BODY
    assert not found.solved
    assert max(beyond(found).values()) > 45.0
    assert most_telling(found, problem)[0].name.startswith("Neck")


@pytest.mark.slow
def test_hard_ranges_are_not_given_up_and_the_conflict_is_told() -> None:
    problem = nodding(SolverOptions(human=HumanRanges.HARD))
    adaptation = adapt(fitted_hop(), problem)
    assert not adaptation.solved
    assert max(beyond(adaptation).values(), default=0.0) < MOST
    told = {each.name for each in most_telling(adaptation, problem)}
    assert "Nod" in told
    assert any(name.startswith("Neck") for name in told)


@pytest.mark.slow
def test_hard_ranges_hinder_nothing_that_can_be_met() -> None:
    hard = Requests(solution=SolverOptions(human=HumanRanges.HARD))
    assert adapt(fitted_hop(), replace(FAR, requests=hard)).solved


def test_wider_ranges_let_joints_go_so_much_further() -> None:
    wide = SolverOptions(wider=radians(20.0))
    usual, wider = (
        set_up(fitted_hop(), nodding(options)).human for options in (SolverOptions(), wide)
    )
    assert usual is not None
    assert wider is not None
    rest = np.eye(3)[None]
    for one, other in zip(usual.human, wider.human, strict=True):
        (low, high), (lower, upper) = one.past(rest), other.past(rest)
        assert np.isclose(high - upper, wide.wider)
        assert np.isinf(one.lower) or np.isclose(low - lower, wide.wider)


def test_joints_that_are_no_person_s_have_no_ranges() -> None:
    tail = Shape("Tail", ("Neck", "Neck1", "Head"), human=False)
    guard = set_up(fitted_hop(), nodding(SolverOptions(), (tail,))).human
    assert guard is not None
    free = {each.name for each in guard.ranges if np.isinf(each.upper)}
    assert free
    assert all(name.startswith("Neck") for name in free)
