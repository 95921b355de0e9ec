"""What a drag of a pin leaves where it ends, without a mouse."""

from __future__ import annotations

from types import FunctionType, SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import point
from hangtime.operators.drag.drag_state import Axis, PinDrag
from hangtime.operators.drag.follow_mixin import FollowedDrag
from hangtime.operators.drag.mouse import Press
from hangtime.operators.drag.pin_operator import DragPinOperator
from hangtime.tests.blender.helpers.rows import added, make_stances
from hangtime.tests.blender.helpers.solids import add_row, make_box

pytestmark = pytest.mark.usefixtures("_enabled")

OWN = {
    name: value
    for name, value in vars(DragPinOperator).items()
    if isinstance(value, FunctionType | property)
}
# Blender makes instances of operators itself, and only in a window.
Pin = type("Pin", (FollowedDrag,), OWN)


@pytest.fixture
def rig() -> bpy.types.Object:
    """With a contact on the ground before and after a flight."""
    return make_stances((0.0, 1.0, 0.0))


def held(armature: bpy.types.Object, contact: int = -1, constraint: int = -1) -> FollowedDrag:
    """The drag of a pin that the mouse has taken hold of."""
    drag = Pin()
    drag._armature, drag.contact, drag.constraint = armature, contact, constraint
    drag.properties = SimpleNamespace(is_property_set=lambda _: False)
    drag._metres, drag._press = 1.0, Press((0.0, 0.0), slack=3.0, dragging=True)
    drag._was, drag._drag = drag._remembered(), PinDrag(tuple(drag._place))
    drag._choose()
    return drag


def test_a_drag_that_moves_nothing_leaves_a_contact_on_what_it_stands_on(
    rig: bpy.types.Object,
) -> None:
    crate = make_box("Crate")
    add_row(rig, crate)
    bpy.ops.hangtime.drag_pin(contact=1, shift=(0.5, 0.0, 0.5), ground="Crate")
    row = rig.hangtime.contacts[1]
    was = tuple(row.at)
    drag = held(rig, contact=1)
    drag._drag.key(Axis.Z)
    drag.put_by(0.2)
    assert row.on is None
    drag.put_by(0.0)
    assert not drag.let_go()
    assert (row.on, tuple(row.at)) == (crate, was)


def test_a_drag_that_moves_nothing_gives_a_point_no_place(rig: bpy.types.Object) -> None:
    row = added(rig, point.KIND, "foot", use_place=False)
    drag = held(rig, constraint=0)
    drag.put_by(0.0)
    assert not drag.let_go()
    assert not row.use_place


def test_it_is_said_where_typed_numbers_lead(rig: bpy.types.Object) -> None:
    added(rig, point.KIND, "foot")
    drag = held(rig, contact=1)
    assert "metres along it, or forward" in drag.key_hints
    drag.put_by(0.3)
    assert drag._drag.shift == pytest.approx((0.0, 0.3, 0.0))
    drag = held(rig, constraint=0)
    assert "metres along it, or along X" in drag.key_hints
    drag.put_by(0.3)
    assert drag._drag.shift == pytest.approx((0.3, 0.0, 0.0))
