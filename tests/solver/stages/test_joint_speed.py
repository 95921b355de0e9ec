"""Where a joint would go faster than a person's torques are weighed; what stays so is told."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hangtime.operators.words.report_text import as_text, joint_lines
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.requests import Requests, TorqueLimit
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.fitting.fit import ADAPT_COST_WEIGHTS, Fit, fit
from hangtime.solver.human.limb_speed import FAST, JointSpeed, fastest_joint, too_fast
from hangtime.solver.results import joint_report
from hangtime.solver.results.report import report
from hangtime.solver.stages import implicit
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop

RUN = "BMC_run.bvh"


def test_a_recording_is_not_too_fast_beside_itself() -> None:
    motion = fitted_hop().motion
    seen = motion.joint_centres(np.linspace(0.0, motion.duration, 500))
    seen = seen - motion.com(np.linspace(0.0, motion.duration, 500))[:, None]
    steps = np.linalg.norm(np.diff(seen, axis=0), axis=2) / (motion.duration / 499)
    assert fastest_joint(motion).speed == pytest.approx(steps.max(), rel=0.02)
    assert fastest_joint(motion).body == steps.max(axis=0).argmax()
    assert too_fast(motion, motion) is None


@pytest.mark.slow
@pytest.mark.parametrize(
    "requests",
    [
        Requests(),
        Requests(torques=(TorqueLimit("Weak", ("RightLeg",), bound=500.0),)),
        Requests(solution=SolverOptions(human=HumanRanges.OFF)),
    ],
)
def test_what_weighed_torques_do_not_calm_stays(
    monkeypatch: pytest.MonkeyPatch, requests: Requests
) -> None:
    """They are not even weighed where the artist limits some, or for what is no human."""
    seen = list[object]()

    def fast(motion: Motion, _: object) -> JointSpeed:
        seen.append(motion)
        return fastest_joint(motion)

    monkeypatch.setattr(implicit, "too_fast", fast)
    found = adapt(fitted_hop(), MotionProblem(requests=requests))
    assert found.solved
    assert found.calmed is None
    assert len(seen) == (1 if requests == Requests() else 0)


def test_a_solve_that_ends_in_no_numbers_leaves_what_was_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its report tells the joint that is too fast."""
    plain, asked = implicit.adapt, []

    def again(_: Fit, problem: MotionProblem, **__: object) -> Adaptation:
        asked.append(problem)
        raise np.linalg.LinAlgError

    for module in (implicit, joint_report):
        monkeypatch.setattr(module, "too_fast", lambda *_: JointSpeed(3, 19.0))
    monkeypatch.setattr(implicit, "adapt", again)
    found = plain(fitted_hop(), MotionProblem())
    assert found.solved
    assert len(asked) == 1
    made = report(found, MotionProblem(), Origin("hop"))
    bone = found.motion.transcription.character.bodies[3].bone
    assert f"{bone} moves at 19 m/s beside the body" in as_text(made)


@pytest.mark.slow
def test_no_hand_is_too_fast_in_a_run_whose_landing_is_turned(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a free beginning, by metres alone and with toes as quick as limbs, a joint goes at
    15 m/s here, and with torques weighed at less than 10."""
    monkeypatch.setattr("hangtime.solver.objectives.tracking_cost.TOE_TIME", 0.0)
    free = replace(ADAPT_COST_WEIGHTS, came_from=0.0)
    for module in ("fitting.fit", "stages.setup"):
        monkeypatch.setattr(f"hangtime.solver.{module}.ADAPT_COST_WEIGHTS", free)
    analysis = analyse(load_recording(RUN), MotionProblem())
    fitted = fit(analysis.performance, analysis.schedule)
    flight = max(fitted.schedule.flights, key=lambda each: each.end - each.start)
    landing = next(p.name for p in fitted.schedule.phases if p.start == flight.end)
    problem = MotionProblem(pins=(Pin("Landing", landing, offset=(0.0, -0.6, 0.0), turn=pi),))
    found = adapt(fitted, problem)
    assert found.solved
    assert found.calmed is not None
    assert found.calmed.speed > FAST
    assert fastest_joint(found.motion).speed < FAST
    made = report(found, problem, Origin("run"))
    assert any("would move at" in line for line in joint_lines(made))
    assert "would move at" in as_text(made)
