"""Points that stand are looked at where Blender shows them."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.constraints.standing import missed_contacts
from hangtime.operators.words.headline import missed_line
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import BEYOND
from hangtime.solver.data.reports.keys import MissedContact
from hangtime.tests.helpers.clips import JUMP_FRAMES
from hangtime.ui.panels.solve import beside_warning

pytestmark = pytest.mark.usefixtures("_enabled")


def missed(armature: bpy.types.Object) -> tuple[MissedContact, ...]:
    take = read_recorded(armature, *JUMP_FRAMES, BEYOND)
    schedule = analyse(take, MotionProblem(frames=JUMP_FRAMES)).schedule
    return complete(missed_contacts(armature, schedule, kept(armature.hangtime.adapted).traces))


@pytest.mark.slow
def test_a_leg_that_is_longer_than_solved_is_told_by_its_points(
    adapted: bpy.types.Object,
) -> None:
    assert missed(adapted) == ()
    adapted.pose.bones["LeftLeg"].scale.y = 1.05
    found = missed(adapted)
    assert {each.name for each in found} == {
        "Left heel 1",
        "Left toe 1",
        "Left heel 2",
        "Left toe 2",
    }
    assert all(10.0 < each.mm < 30.0 for each in found)
    assert found[0].mm == max(each.mm for each in found)
    worst = found[0]
    assert missed_line(found).startswith(
        f"The keys do not show what was solved: {worst.name} is up to {worst.mm:.1f} mm off "
        f"(frame {worst.frame:g}), "
    )
    cure = "Lengths change with the scale of LeftLeg: make it one number"
    assert f", and 1 more. {cure}" in missed_line(found)


def test_an_armature_that_grows_is_told_as_the_cause(adapted: bpy.types.Object) -> None:
    first, last = JUMP_FRAMES
    for frame, size in ((first, 1.0), (last, 1.1)):
        adapted.scale = (size, size, size)
        adapted.keyframe_insert("scale", frame=frame)
    assert f"the scale of {adapted.name}: make it one number" in missed_line(missed(adapted))


def test_what_a_result_warns_of_is_not_said_again_below_the_warning(
    adapted: bpy.types.Object,
) -> None:
    settings, warning = adapted.hangtime, "The keys do not show what was solved"
    told = settings.status.splitlines()
    settings.status = "\n".join([warning, *told])
    assert beside_warning(adapted) == [warning, *told]
    settings.adapted.hangtime.warning = warning
    assert beside_warning(adapted) == told
