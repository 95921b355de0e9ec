"""What would carry a body that something unseen carries, added by one click."""

from __future__ import annotations

from dataclasses import replace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.operators.lists.offered_support import offered
from hangtime.operators.solve.session import session
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import AddedContact, MotionProblem
from hangtime.solver.data.requests import PointRequest, When
from hangtime.solver.unseen.offered import OfferedSupport

pytestmark = pytest.mark.usefixtures("_enabled")

JOINT = PointRequest(
    *("Left hand holds on", "LeftHand", When(frames=(10.0, 40.0)), (0.0, 0.0, 0.0)),
    environment=True,
    grip=True,
)
MIDDLE = PointRequest(
    *("Right hand holds on", "RightHand", When(frames=(12.0, 30.0))), environment=True, grip=True
)


def asked(armature: bpy.types.Object) -> MotionProblem:
    return problem_of(armature.hangtime, read_recorded(armature, None, None))


def test_hands_hold_on_where_and_when_the_analysis_says(analysed: bpy.types.Object) -> None:
    """The same Points that the command line prints."""
    session().support = (analysed.session_uid, OfferedSupport(holds=(JOINT, MIDDLE)))
    assert bpy.ops.hangtime.add_holds() == {"FINISHED"}
    assert asked(analysed).requests.points == (JOINT, MIDDLE)
    assert not bpy.ops.hangtime.add_holds.poll()


def test_a_hand_that_has_such_a_point_needs_none() -> None:
    hangs = UnseenSupport(1.0, 40.0, holds=(JOINT, MIDDLE))
    assert OfferedSupport.of([hangs]).holds == (JOINT, MIDDLE)
    earlier = replace(JOINT, when=When(frames=(1.0, 9.0)))
    free = replace(MIDDLE, environment=False)
    assert OfferedSupport.of([hangs], [earlier, free]).holds == (JOINT, MIDDLE)
    assert OfferedSupport.of([hangs], [replace(JOINT, name="Bar")]).holds == (MIDDLE,)


def test_contacts_are_added_in_their_frames_and_the_rest_stays_offered(
    analysed: bpy.types.Object,
) -> None:
    touches = AddedContact("Left hand", 120.0, 150.0), AddedContact("Right hand", 130.0, 140.0)
    session().support = (analysed.session_uid, OfferedSupport(contacts=touches, holds=(JOINT,)))
    assert bpy.ops.hangtime.add_offered_contacts() == {"FINISHED"}
    assert asked(analysed).added == touches
    assert offered(analysed) == OfferedSupport(holds=(JOINT,))
    session().support = None
