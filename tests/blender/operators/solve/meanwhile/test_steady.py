"""What the artist does while a recording is read in parts, or while an answer is waited for."""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.worker_requests import PendingRequest
from hangtime.operators.recording.examine import ExamineOperator
from hangtime.operators.solve.adapt import ask_for
from hangtime.operators.solve.analyze import AnalyzeOperator
from hangtime.operators.solve.common import said
from hangtime.operators.solve.task import Task, kept_in_scene
from hangtime.solver.data.faults import ArmatureGone, Fault
from hangtime.tests.blender.operators.solve.meanwhile.changes import (
    edit,
    move,
    remove,
    rename,
    undo,
    unkey,
)

pytestmark = pytest.mark.usefixtures("_enabled", "_solving")

Disturb = Callable[[bpy.types.Object], None]


class _Examining:
    """As Blender runs it, without a window."""

    _examined, _tell_of_range = ExamineOperator._examined, ExamineOperator._tell_of_range

    def report(self, *_told: object) -> None: ...


def _asking() -> Task:
    return str((yield from ask_for(bpy.context)))


WORKS = {
    "analyze": lambda: AnalyzeOperator.task(None, bpy.context),
    "examine": lambda: ExamineOperator.task(_Examining(), bpy.context),
    "adapt": _asking,
}


@pytest.fixture
def armature(analysed: bpy.types.Object) -> bpy.types.Object:
    for mass in (60.0, 65.0):
        analysed.hangtime.mass = mass
        bpy.ops.ed.undo_push(message=f"{mass}")
    return analysed


def _contacts() -> list[str]:
    return [each.name for each in bpy.context.object.hangtime.contacts]


@pytest.mark.parametrize("name", WORKS)
@pytest.mark.parametrize(
    ("disturb", "told"),
    [
        (edit, "(edit mode); try again, in object or pose mode"),
        (rename, "(its bones)"),
        (move, "(its place)"),
        (undo, "undone or redone meanwhile"),
    ],
)
def test_what_changes_while_it_is_read_is_told_and_contacts_stay(
    armature: bpy.types.Object, name: str, disturb: Disturb, told: str
) -> None:
    """Read further in edit mode it stood at rest, and contacts with all edits went."""
    before = _contacts()
    task = kept_in_scene(bpy.context, WORKS[name]())
    list(islice(task, 2))
    disturb(armature)
    with pytest.raises(Fault) as fault:
        complete(task)
    assert told in said(fault.value)
    assert _contacts() == before


@pytest.mark.parametrize("name", ["analyze", "examine"])
@pytest.mark.parametrize("disturb", [edit, undo, unkey])
def test_while_the_worker_is_waited_for_the_artist_goes_on(
    armature: bpy.types.Object, name: str, disturb: Disturb
) -> None:
    task = kept_in_scene(bpy.context, WORKS[name]())
    job = next(part for part in task if isinstance(part, PendingRequest))
    disturb(armature)
    job.wait()
    assert complete(task)
    settings = bpy.context.object.hangtime
    assert len(settings.contacts)
    assert settings.mass == (60.0 if disturb is undo else 65.0)


@pytest.mark.parametrize("name", ["analyze", "examine"])
def test_an_armature_that_is_deleted_while_the_worker_is_waited_for_is_told(
    armature: bpy.types.Object, name: str
) -> None:
    task = kept_in_scene(bpy.context, WORKS[name]())
    job = next(part for part in task if isinstance(part, PendingRequest))
    remove(armature)
    job.wait()
    with pytest.raises(ArmatureGone):
        complete(task)
