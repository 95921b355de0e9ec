"""What is made from a result has its contacts, which are kept with it, until its take is edited."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.properties.of_actions.known_contacts import (
    SolvedContacts,
    keep_contacts,
    known_at,
    known_contacts,
)
from hangtime.solver.data.contacts import Contact, ContactSchedule, KnownContacts
from hangtime.solver.data.scene import SceneObject, SceneRole

SLOWER = 1.5
CUT = 0.51  # frames; contacts that the range cuts off end on a whole frame

pytestmark = pytest.mark.usefixtures("_enabled")


def analysed(armature: bpy.types.Object) -> dict[str, tuple[float, float]]:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    rows = armature.hangtime.contacts
    return {row.name: (row.start_frame, row.end_frame) for row in rows}


@pytest.mark.slow
def test_a_result_of_a_result_has_the_same_contacts(adapted: bpy.types.Object) -> None:
    (known,) = known_contacts(current_action(adapted))
    assert bpy.ops.hangtime.start_from(result=True) == {"FINISHED"}
    settings = adapted.hangtime
    settings.use_range = True
    settings.first_frame, settings.last_frame = round(known.first), round(known.last)
    now = analysed(adapted)
    assert len(now) == len(known.contacts)
    for point, start, end in known.contacts:
        own = [span for name, span in now.items() if name.startswith(point)]
        assert any(span == pytest.approx((start, end), abs=CUT) for span in own), point
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    (again,) = known_contacts(current_action(adapted))
    told = [span for _, *span in again.contacts]
    assert told == [pytest.approx(span, abs=CUT) for _, *span in known.contacts]


@pytest.mark.slow
def test_a_take_that_was_retimed_since_is_looked_at(adapted: bpy.types.Object) -> None:
    action = current_action(adapted)
    (known,) = known_contacts(action)
    assert bpy.ops.hangtime.start_from(result=True) == {"FINISHED"}
    for curve in all_curves(action):
        for key in curve.keyframe_points:
            for point in (key.handle_left, key.handle_right, key.co):
                point.x = known.first + SLOWER * (point.x - known.first)
    adapted.hangtime.last_frame = round(known.first + SLOWER * (known.last - known.first))
    landed = max(start for _, start, _ in known.contacts)
    left = max(end for _, _, end in known.contacts if end < landed)
    now = [end for _, end in analysed(adapted).values()]
    assert max(now) > left + 20.0


def solved(first: float, last: float, *touches: tuple[str, float, float]) -> SolvedContacts:
    """Contacts between frames of a motion at one frame a second."""
    contacts = (
        Contact(point, point, "Foot", np.zeros(3), start - first, end - first, np.zeros(3))
        for point, start, end in touches
    )
    schedule = ContactSchedule(tuple(contacts), last - first, 0.0)
    return SolvedContacts(schedule, np.arange(first, last + 1.0), 1.0, ())


def test_a_cycle_has_its_contacts_in_every_one() -> None:
    action = bpy.data.actions.new("Loop")
    keep_contacts(action, solved(1.0, 21.0, ("Left toe", 3.0, 9.0)))
    assert [each.first for each in known_at(action, (1.0, 40.0), None)] == [1.0]
    action.use_frame_range = action.use_cyclic = True
    action.frame_start, action.frame_end = 1.0, 21.0
    known = known_at(action, (1.0, 40.0), None)
    assert [each.first for each in known][:3] == [-19.0, 1.0, 21.0]
    assert known[2].contacts == (("Left toe", 23.0, 29.0),)


BEFORE = KnownContacts(1.0, 120.0, (("Left toe", 3.0, 60.0), ("Left toe", 90.0, 120.0)))


def test_an_adaptation_replaces_what_was_known_of_its_frames_alone() -> None:
    made = bpy.data.actions.new("Second")
    own = solved(40.0, 83.0, ("Right toe", 50.0, 70.0))
    keep_contacts(made, own, (BEFORE,), 3.0)
    before, now, after = known_contacts(made)
    assert before == KnownContacts(1.0, 40.0, (("Left toe", 3.0, 40.0),))
    assert (now,) == own.known
    assert after == KnownContacts(83.0, 123.0, (("Left toe", 93.0, 123.0),))


def test_of_contacts_on_what_moves_nothing_is_known_there() -> None:
    made = bpy.data.actions.new("Second")
    own = solved(40.0, 83.0, ("Right toe", 50.0, 70.0))
    (contact,) = own.schedule.contacts
    on = replace(own.schedule, contacts=(replace(contact, on="Cart"),))
    nothing, turned = np.zeros((0, 3)), np.tile(np.eye(3), (2, 1, 1))
    frames, places = np.array([1.0, 100.0]), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    cart = SceneObject(
        "Cart", SceneRole.GROUND, nothing, nothing.astype(int), frames, places, turned
    )
    assert cart.moves
    keep_contacts(made, replace(own, schedule=on, scene=(cart,)), (BEFORE,), 3.0)
    assert [(each.first, each.last) for each in known_contacts(made)] == [
        (1.0, 40.0),
        (83.0, 123.0),
    ]
