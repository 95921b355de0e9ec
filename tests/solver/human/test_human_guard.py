"""Human by default: joints keep to a person's ranges, or the recording's; what cannot is told."""

from dataclasses import replace
from math import radians

import numpy as np
from hangtime.operators.words.report_text import headline
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.report import Origin
from hangtime.solver.data.requests import AngleLimit, OrientationRequest, Requests, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.human.human_guard import HumanGuard, recorded_ranges
from hangtime.solver.results.report import report
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.validity import assert_valid

MOST = 0.5  # degrees beyond; 3 are allowed
FAR = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.6, 0.0, 0.0)),))
NEAR = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.02, 0.0, 0.0)),))


def any_body(problem: MotionProblem) -> MotionProblem:
    """The same of a figure that is no human."""
    solution = replace(problem.requests.solution, human=False)
    return replace(problem, requests=replace(problem.requests, solution=solution))


def beyond(adaptation: Adaptation) -> dict[str, float]:
    """Degrees beyond its range, by what a joint does."""
    reference = adaptation.setup.context.reference
    guard = HumanGuard(recorded_ranges(reference), reference)
    return {
        each.name: float(np.degrees(each.amount)) for each in guard.violations(adaptation.motion)
    }


def test_a_far_landing_keeps_joints_in_their_ranges() -> None:
    before = beyond(adapt(fitted_hop(), any_body(FAR)))
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


def test_what_is_off_has_no_rows() -> None:
    adaptation = adapt(fitted_hop(), any_body(FAR))
    assert adaptation.setup.human is None
    assert adaptation.motion.transcription.guard(RowKind.RANGE) is None


def test_a_joint_that_the_artist_limits_is_the_artist_s() -> None:
    """A knee is asked to bend further than a person's can."""
    frame = float(fitted_hop().performance.recording.frames[0]) + 60.0
    when = When(frames=(frame - 1.0, frame + 1.0))
    asked = AngleLimit("Folded", "LeftLeg", radians(150.0), None, when)
    adaptation = adapt(fitted_hop(), MotionProblem(requests=Requests(angles=(asked,))))
    assert adaptation.solved
    assert beyond(adaptation).pop("Left knee bends") > 10.0


def test_what_cannot_be_met_is_given_up_and_told_by_name() -> None:
    """The head is asked to tilt by 90 degrees for a moment, with the chest held as it was."""
    frame = float(fitted_hop().performance.recording.frames[0]) + 60.0
    when = When(frames=(frame - 1.0, frame + 1.0))
    asked = (
        OrientationRequest("Nod", "Head", when, tilt=radians(90.0)),
        OrientationRequest("Chest", "Spine1", when),
    )
    problem = MotionProblem(requests=Requests(orientations=asked))
    adaptation = adapt(fitted_hop(), problem)
    assert adaptation.solved
    left = beyond(adaptation)
    assert max(left.values()) > 10.0
    assert all(name.startswith("Neck") for name in left)
    told = report(adaptation, problem, Origin("hop"))
    name = max(left, key=lambda each: left[each])
    assert any(name in line and "°" in line for line in headline(told))
