"""Hands count as contacts where they rest on the ground, and only there."""

import numpy as np
from hangtime.solver.analysis.performance import contact_points, find_contacts, perform
from hangtime.solver.body.character import build_character
from hangtime.tests.helpers.clips import load_recording


def test_no_hand_touches_in_a_jump() -> None:
    recording = load_recording("forward_jump_116cm.bvh")
    performance = perform(recording, build_character(recording))
    assert not [c for c in find_contacts(performance).contacts if "hand" in c.point]


def test_a_hand_on_the_ground_is_a_contact_at_its_palm() -> None:
    """The jump with the left hand's track laid on the floor for half a second of its stance."""
    recording = load_recording("forward_jump_116cm.bvh")
    character = build_character(recording)
    performance = perform(recording, character)
    hand = next(i for i, b in enumerate(character.bodies) if b.name == "left hand")
    down = slice(20, 80)
    palm = performance.rotations[down, hand] @ (0.5 * character.bodies[hand].tip)
    performance.centres[down, hand] = np.array([0.3, 0.9, 0.0]) - palm
    found = [c for c in find_contacts(performance).contacts if c.point == "Left hand"]
    assert len(found) == 1
    np.testing.assert_allclose(found[0].place, [0.3, 0.9, 0.0], atol=1e-6)
    np.testing.assert_allclose([found[0].start, found[0].end], recording.times[[20, 79]], atol=0.02)
    track = contact_points(performance)[0]["Left hand"].track[down]
    np.testing.assert_allclose(track, np.broadcast_to([0.3, 0.9, 0.0], track.shape), atol=1e-9)
