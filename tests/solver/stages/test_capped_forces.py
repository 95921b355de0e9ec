"""Peaks under which no body could keep off the floor are refused, and no others."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.constraints.capped_forces import check_capped
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.faults import PeakTooLow
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import BodyChange, ForceRequest, Requests, When
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.requested import requested
from hangtime.solver.worker.pipeline import measure, unfitted
from hangtime.solver.worker.possible import check_requested
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of

FRAMES = frames_of(HOP_CLIP, HOP)
MOON = BodyChange(gravity=1.62)


def check(*forces: ForceRequest, body: BodyChange | None = None) -> None:
    """Before the fit."""
    problem = MotionProblem(
        frames=FRAMES, requests=Requests(forces=forces, body=body or BodyChange())
    )
    subject = measure(load_recording(HOP_CLIP), problem)
    check_requested(unfitted(subject), subject.problem)


@pytest.mark.slow
@pytest.mark.parametrize("peak", [1e-6, 0.3])
def test_a_peak_that_carries_nobody_is_refused_with_one_that_does_not_either(peak: float) -> None:
    with pytest.raises(PeakTooLow) as caught:
        check(ForceRequest("Soft", peak=peak))
    assert (caught.value.request, caught.value.peak) == ("Soft", peak)
    assert 0.3 < caught.value.least < 3.0
    with pytest.raises(PeakTooLow):
        check(ForceRequest("Soft", peak=caught.value.least))
    check(ForceRequest("Soft", peak=1.01 * caught.value.least))


def test_peaks_of_what_carries_together_are_added() -> None:
    left = ForceRequest("Left", peak=0.2, touching=("LeftToeBase", "LeftFoot"))
    right = ForceRequest("Right", peak=0.3, touching=("RightToeBase", "RightFoot"))
    with pytest.raises(PeakTooLow) as caught:
        check(left, right)
    assert caught.value.request == "Left"
    check(left)  # the right foot may carry all


def test_the_cap_that_is_to_blame_is_named() -> None:
    with pytest.raises(PeakTooLow) as caught:
        check(
            ForceRequest("Heel", peak=0.1, touching=("Left heel",)), ForceRequest("All", peak=0.5)
        )
    assert (caught.value.request, caught.value.peak) == ("All", 0.5)


@pytest.mark.slow
def test_where_flights_take_another_time_it_is_refused_once_that_is_known() -> None:
    """Before the fit it might be that these would be shorter."""
    problem = MotionProblem(
        pins=(Pin("Further", "ground 2", offset=(0.0, 0.0, 0.3)),),
        requests=Requests(forces=(ForceRequest("Soft", peak=0.3),)),
    )
    subject = measure(load_recording(HOP_CLIP), replace(problem, frames=FRAMES))
    check_requested(unfitted(subject), subject.problem)
    with pytest.raises(PeakTooLow):
        adapt(fitted_hop(), problem)


def test_a_moment_on_no_force_and_what_the_moon_needs_are_let_through() -> None:
    check(ForceRequest("Gone", peak=0.01, when=When(frames=(FRAMES[0], FRAMES[0] + 6))))
    check(ForceRequest("Light", peak=0.6), body=MOON)


@pytest.mark.parametrize("share", [1.0, 0.999])
@pytest.mark.parametrize("phase", [None, "ground 1", "ground 2"])
def test_a_motion_that_is_valid_is_never_refused(share: float, phase: str | None) -> None:
    """Also where its own peak is the cap, in all or in one stance."""
    fit = fitted_hop()
    whole = (0.0, fit.motion.duration)
    span = next(((p.start, p.end) for p in fit.schedule.phases if p.name == phase), whole)
    times = np.linspace(*span, 500)
    weight = fit.performance.character.mass * STANDARD_GRAVITY
    peak = float(np.linalg.norm(fit.motion.forces(times).sum(axis=1), axis=1).max()) / weight
    request = ForceRequest("Cap", peak=share * peak, when=When(phase=phase))
    problem = MotionProblem(requests=Requests(forces=(request,)))
    asked = requested(fit, problem)
    check_capped(problem.requests, asked.context, replace(asked.start, places=asked.target.places))
