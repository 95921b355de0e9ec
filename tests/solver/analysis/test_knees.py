"""Knees carry where they rest on the floor, and only there."""

import numpy as np
import pytest
from hangtime.devtools.checks.mujoco_check import check_motion
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.contacts.footfalls import footfalls
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.contacts import Touch
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.fitting.fit import fit
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.kneeling import kneeling

CLIPS = JUMP, "131_03_hop.bvh", "fair1_jumping.bvh", "cmu1_jumping_jacks.bvh", "run_2.bvh"


def knees(recording: Recording) -> list[str]:
    contacts = analyse(recording, MotionProblem()).schedule.contacts
    return [contact.name for contact in contacts if "knee" in contact.point]


@pytest.mark.parametrize("name", CLIPS)
def test_no_knee_touches_in_jumps_and_runs(name: str) -> None:
    assert knees(load_recording(name)) == []


def test_knees_on_the_floor_are_contacts_at_their_joints() -> None:
    recording = kneeling(0.07)
    analysis = analyse(recording, MotionProblem())
    assert analysis.unseen == ()
    found = {c.point: c for c in analysis.schedule.contacts}
    for side in ("Left", "Right"):
        joint = recording.heads[0, recording.index(f"{side}Leg")]
        np.testing.assert_allclose(found[f"{side} knee"].place, joint, atol=1e-6)


@pytest.mark.parametrize(("tilt", "speed"), [(20.0, 0.0), (0.0, 0.5)])
def test_knees_in_mid_air_or_that_slide_are_none(tilt: float, speed: float) -> None:
    assert knees(kneeling(speed=speed, tilt=tilt)) == []


def test_a_knee_recorded_low_keeps_its_height() -> None:
    """A sole as low is put on the floor; the joint is inside the knee."""
    contacts = analyse(kneeling(0.03), MotionProblem()).schedule.contacts
    lowest = min(c.place[2] for c in contacts if "knee" in c.point)
    assert lowest == pytest.approx(0.03, abs=1e-6)


def test_knees_carry_the_body_in_the_fit() -> None:
    """Above them is most of the weight of who kneels upright."""
    analysis = analyse(kneeling(), MotionProblem())
    fitted = fit(analysis.performance, analysis.schedule)
    assert fitted.solved
    transcription = fitted.motion.transcription
    forces = fitted.motion.forces(np.linspace(0.0, fitted.motion.duration, 20)).mean(axis=0)
    weight = transcription.character.mass * STANDARD_GRAVITY
    up = {c.contact.point: forces[c.point, 2] / weight for c in transcription.contacts}
    assert sum(up.values()) == pytest.approx(1.0, abs=0.01)
    assert up["Left knee"] + up["Right knee"] > 0.6
    left, *_ = check_motion(fitted.motion)  # by MuJoCo, between the nodes too
    assert left.worst("force", flying=False) < 1e-3
    assert left.worst("moment", flying=False) < 1e-3


def test_a_knee_is_of_its_foots_step() -> None:
    """The shank ties them together."""
    touches = [Touch("Right toe", 0.0, 2.0), Touch("Right knee", 0.5, 1.5)]
    assert footfalls(touches) == ((0, 1),)
    assert footfalls([Touch("Left toe", 0.0, 2.0), touches[1]]) == ((0,), (1,))
