"""Where something unseen carries the body there is no flight, stored as in the solver."""

from __future__ import annotations

import json

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.constraints.motion_problem import problem_of
from hangtime.bridge.rows.phases import phases_of
from hangtime.tests.blender.helpers.rows import make_rig

FIRST, LAST = 1.0, 24.0

pytestmark = pytest.mark.usefixtures("_enabled")


def test_a_pin_behind_unseen_support_names_the_phase_that_the_solver_has() -> None:
    armature = make_rig()
    settings = armature.hangtime
    (flight,) = (phase for phase in phases_of(settings) if not phase.is_ground)
    settings.unseen = json.dumps([[flight.start, flight.end]])
    settings.contacts[-1].at[0] += 0.1
    (phase,) = phases_of(settings)
    problem = problem_of(settings, read_recorded(armature, FIRST, LAST))
    assert phase.name == "ground 1"
    assert {pin.phase for pin in problem.pins} == {"ground 1"}
