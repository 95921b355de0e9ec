"""Where limbs would whirl as nobody's do torques are weighed, and that is told."""

from math import pi

import numpy as np
import pytest
from hangtime.operators.words.report_text import as_text, joint_lines
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.requests import Requests, TorqueLimit
from hangtime.solver.fitting.fit import fit
from hangtime.solver.human.limb_speed import FAST, fastest_joint, whirls
from hangtime.solver.results.report import report
from hangtime.solver.stages import implicit
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop

RUN = "BMC_run.bvh"


def test_a_recording_does_not_whirl_beside_itself() -> None:
    motion = fitted_hop().motion
    seen = motion.joint_centres(np.linspace(0.0, motion.duration, 500))
    seen = seen - motion.com(np.linspace(0.0, motion.duration, 500))[:, None]
    steps = np.linalg.norm(np.diff(seen, axis=0), axis=2) / (motion.duration / 499)
    assert fastest_joint(motion) == pytest.approx(steps.max(), rel=0.02)
    assert not whirls(motion, motion)


@pytest.mark.parametrize("torques", [(), (TorqueLimit("Weak", ("RightLeg",), bound=500.0),)])
def test_what_weighed_torques_do_not_calm_stays(
    monkeypatch: pytest.MonkeyPatch, torques: tuple[TorqueLimit, ...]
) -> None:
    """Torques are not even weighed where the artist limits some."""
    seen = list[object]()

    def whirling(motion: object, _: object) -> bool:
        seen.append(motion)
        return True

    monkeypatch.setattr(implicit, "whirls", whirling)
    problem = MotionProblem(requests=Requests(torques=torques))
    found = adapt(fitted_hop(), problem)
    assert found.solved
    assert found.whirled is None
    assert len(seen) == (0 if torques else 1)


@pytest.mark.slow
def test_arms_do_not_whirl_in_a_run_whose_landing_is_turned() -> None:
    """By metres alone a hand goes at 19 m/s here, and by itself no faster than 7."""
    analysis = analyse(load_recording(RUN), MotionProblem())
    fitted = fit(analysis.performance, analysis.schedule)
    flight = max(fitted.schedule.flights, key=lambda each: each.end - each.start)
    landing = next(p.name for p in fitted.schedule.phases if p.start == flight.end)
    problem = MotionProblem(pins=(Pin("Landing", landing, turn=0.5 * pi),))
    found = adapt(fitted, problem)
    assert found.solved
    assert found.whirled is not None
    assert found.whirled > FAST
    assert fastest_joint(found.motion) < FAST
    made = report(found, problem, Origin("run"))
    assert any("would whirl at" in line for line in joint_lines(made))
    assert "would whirl at" in as_text(made)
