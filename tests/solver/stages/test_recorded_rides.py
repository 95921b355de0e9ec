"""Recordings on ground that moves: what carries the feet along explains their support.

By Galilei a hop on a train at constant speed is the hop on still ground, seen from the train.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import Analysis, analyse
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.requests import Requests
from hangtime.solver.data.scene import SceneObject, SceneRole, SteadyMotion
from hangtime.solver.data.solver_options import HumanRanges, SolverOptions
from hangtime.solver.fitting.fit import Fit
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.worker.pipeline import fit_subject, measure
from hangtime.solver.worker.stage_clock import StageClock
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of, hop

VELOCITY = np.array([0.9, -0.4, 0.0])  # m/s
UP = np.array([0.0, 0.0, 0.35])  # m/s, of a lift


def carried(velocity: FloatArray) -> Recording:
    """The hop, carried along."""
    recording = load_recording(HOP_CLIP).window(*frames_of(HOP_CLIP, HOP))
    heads = recording.heads + recording.times[:, None, None] * velocity
    return replace(recording, heads=heads)


def train(velocity: FloatArray, **changed: object) -> SceneObject:
    """A floor of ten metres under the hop's, which moves."""
    recording = carried(velocity)
    top = float(np.mean([c.place[2] for c in hop().schedule.contacts]))
    corners = np.array([[-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0]])
    places = np.array([0.0, 0.0, top]) + recording.times[:, None] * velocity
    made = SceneObject(
        "Train",
        SceneRole.GROUND,
        corners,
        np.array([[0, 1, 2], [0, 2, 3]]),
        recording.frames,
        places,
        np.tile(np.eye(3), (len(places), 1, 1)),
    )
    return replace(made, **changed)  # type: ignore[arg-type]


@cache
def fitted(lift: bool = False) -> Fit:
    velocity = UP if lift else VELOCITY
    subject = measure(carried(velocity), MotionProblem(scene=(train(velocity),)))
    return fit_subject(subject, StageClock())


def check_schedule(found: Analysis, velocity: FloatArray) -> None:
    """The still hop's contacts, each where the train has it when its stance begins."""
    for contact, still in zip(found.schedule.contacts, hop().schedule.contacts, strict=True):
        assert (contact.name, contact.on) == (still.name, "Train")
        assert contact.start == pytest.approx(still.start, abs=0.01)
        assert contact.end == pytest.approx(still.end, abs=0.01)
        went = found.schedule.stance(contact).start * velocity
        np.testing.assert_allclose(contact.place, still.place + went, atol=0.015)


@pytest.mark.parametrize("velocity", [VELOCITY, UP], ids=["train", "lift"])
def test_ground_that_moves_explains_feet_that_go_along(velocity: FloatArray) -> None:
    assert analyse(carried(velocity), MotionProblem()).unseen
    found = analyse(carried(velocity), MotionProblem(scene=(train(velocity),)))
    check_schedule(found, velocity)


def test_a_belt_explains_feet_that_go_along_with_it() -> None:
    belt = SteadyMotion(belt=(0.9, -0.4, 0.0))
    still = train(0.0 * VELOCITY)
    ground = replace(
        still,
        frames=still.frames[:1],
        positions=still.positions[:1],
        rotations=still.rotations[:1],
        steady=belt,
    )
    check_schedule(analyse(carried(VELOCITY), MotionProblem(scene=(ground,))), VELOCITY)


@pytest.mark.parametrize(
    "changed", [{"role": SceneRole.OBSTACLE}, {"positions": train(-VELOCITY).positions}]
)
def test_ground_that_goes_elsewhere_explains_nothing(changed: dict[str, object]) -> None:
    assert analyse(carried(VELOCITY), MotionProblem(scene=(train(VELOCITY, **changed),))).unseen


@pytest.mark.slow
@pytest.mark.parametrize("lift", [False, True], ids=["train", "lift"])
def test_the_fit_rides_along(lift: bool) -> None:
    found, still = fitted(lift), fitted_hop()
    assert found.solved
    assert all(c.ride is not None for c in found.motion.transcription.contacts)
    velocity = UP if lift else VELOCITY
    times = np.linspace(0.0, still.motion.duration, 60)
    seen = found.motion.com(times) - times[:, None] * velocity
    assert np.abs(seen - still.motion.com(times)).max() < 0.02
    assert np.abs(found.motion.com(times, 1) - velocity - still.motion.com(times, 1)).max() < 0.2


@pytest.mark.slow
def test_an_edit_on_the_train_goes_on_riding() -> None:
    fit = fitted()
    pin = Pin("Landing", "ground 2", offset=(0.15, 0.0, 0.0))
    riding = Requests(solution=SolverOptions(solid=False, human=HumanRanges.OFF))
    problem = MotionProblem(scene=(train(VELOCITY),), pins=(pin,), requests=riding)
    made = adapt(fit, problem)
    assert made.solved
    setup = made.setup
    landing = setup.schedule.of_phase(setup.schedule.phases[-1])
    for contact in landing:
        i = next(k for k, c in enumerate(setup.schedule.contacts) if c.name == contact.name)
        ride = setup.target.rides[i]
        assert ride is not None
        middle = np.array([0.5 * (contact.start + contact.end)])
        point = made.motion.transcription.contacts[i].point
        reached = made.motion.contact_points(middle)[0, point]
        np.testing.assert_allclose(reached, ride.poses(middle).of(made.places[i])[0], atol=0.012)
    still = adapt(fit, replace(problem, pins=()))
    assert still.solved
    times = np.linspace(0.0, fit.motion.duration, 50)
    assert np.abs(still.motion.com(times) - fit.motion.com(times)).max() < 1e-3
