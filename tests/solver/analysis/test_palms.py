"""Hands count as contacts where they rest on the ground, and only there."""

import numpy as np
import pytest
from hangtime.solver.analysis.performance import (
    Performance,
    contact_points,
    find_contacts,
    perform,
)
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import Contact
from hangtime.tests.helpers.clips import load_recording

DOWN = slice(20, 80)  # frames, from the first; half a second of the stance before the jump
PLACE = 0.3, 0.9  # m, beside the feet
TURNED = 5.0  # m/s², upwards, of a hand that swings


def jump() -> Performance:
    recording = load_recording("forward_jump_116cm.bvh")
    return perform(recording, build_character(recording))


def with_palm(heights: FloatArray | float) -> Performance:
    """The jump with the left hand's palm at a place for a while. heights: m, in these frames."""
    performance = jump()
    bodies = performance.character.bodies
    hand = next(i for i, body in enumerate(bodies) if body.name == "left hand")
    inside = performance.rotations[DOWN, hand] @ (0.5 * bodies[hand].tip)
    palm = np.array([*PLACE, 0.0]) + np.multiply.outer(heights, [0.0, 0.0, 1.0])
    performance.centres[DOWN, hand] = palm - inside
    return performance


def of_hands(performance: Performance) -> list[Contact]:
    return [c for c in find_contacts(performance).contacts if "hand" in c.point]


def test_no_hand_touches_in_a_jump() -> None:
    assert of_hands(jump()) == []


@pytest.mark.parametrize("height", [0.0, 0.04, 0.07])
def test_a_hand_on_the_ground_is_a_contact_at_its_palm(height: float) -> None:
    """Whose bone is recorded a few centimetres above the floor that the palm is on."""
    performance = with_palm(height)
    (found,) = of_hands(performance)
    assert found.point == "Left hand"
    place = [*PLACE, height]
    np.testing.assert_allclose(found.place, place, atol=1e-6)
    times = performance.times[[DOWN.start, DOWN.stop - 1]]
    np.testing.assert_allclose([found.start, found.end], times, atol=0.02)
    track = contact_points(performance)[0]["Left hand"].track[DOWN]
    np.testing.assert_allclose(track, np.broadcast_to(place, track.shape), atol=1e-9)


def test_a_hand_that_is_held_above_the_ground_or_swings_past_it_does_not_touch() -> None:
    since_lowest = jump().times[DOWN] - jump().times[DOWN].mean()
    assert of_hands(with_palm(0.12)) == []
    assert of_hands(with_palm(0.05 + 0.5 * TURNED * since_lowest**2)) == []
