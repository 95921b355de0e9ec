"""Gripping arms reach for a bar as arms can: the guess of a hang, and what is solved from it."""

import numpy as np
import pytest
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import Hold, PointRequest, Requests, When
from hangtime.solver.inverse_kinematics.arm_ik import reach_grips
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.fitted_hop import fitted_hop

APEX = 89.0  # scene frame
HANGING = When(phase="hanging")
APART = 0.2  # m, of a hand from the middle
NEARLY = np.radians(10.0)  # beyond a range; a guess needs no better


def hang(height: float) -> MotionProblem:
    """Who jumps up to a bar, `height` m over the pelvis at the apex and a little ahead."""
    fitted = fitted_hop().motion
    pelvis = fitted.joint_centres(np.array([(APEX - 20.0) / 120.0]))[0, 0]
    forward = np.diff(fitted.com(np.array([0.4, 0.75])), axis=0)[0] * [1.0, 1.0, 0.0]
    forward /= np.linalg.norm(forward)
    across = np.cross([0.0, 0.0, 1.0], forward)
    hands = []
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        place = pelvis + [0.0, 0.0, height] + 0.1 * forward + sign * APART * across
        place = tuple(place.tolist())
        hands.append(
            PointRequest(
                f"{side} bar", f"{side}Hand", HANGING, place=place, environment=True, grip=True
            )
        )
    hold = Hold("hanging", APEX, 0.5, ends=True)
    return MotionProblem(requests=Requests(points=tuple(hands), holds=(hold,)))


@pytest.mark.slow
def test_arms_reach_for_a_bar_within_their_ranges() -> None:
    setup = set_up(fitted_hop(), hang(0.8))
    human, start = setup.human, setup.start
    assert human is not None
    unturned = Motion(start.transcription, start.x, start.places)
    guess = reach_grips(unturned, setup.target_places, human.ranges)
    grips = [i for i, c in enumerate(guess.transcription.contacts) if c.friction is None]
    held = guess.transcription.contacts[grips[0]].contact
    times = np.linspace(held.start, held.end, 30)
    for i in grips:
        point = guess.transcription.contacts[i].point
        off = guess.contact_points(times)[:, point] - setup.target_places[i]
        assert np.linalg.norm(off, axis=1).max() < 0.1
    turned = guess.joint_rotations(times)
    for each in human.ranges:
        assert each.beyond(turned[:, each.body]).max() < NEARLY, each.name


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.8, 0.95, 1.1])
def test_who_hangs_from_a_bar_is_found(height: float) -> None:
    """Elbows that the guess had folded the wrong way found no way back."""
    assert adapt(fitted_hop(), hang(height)).solved
