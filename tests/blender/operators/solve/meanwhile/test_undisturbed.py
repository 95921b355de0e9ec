"""What others do to the scene while a result is written, between two parts of that."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import present
from hangtime.bridge.app_handlers import add_handler
from hangtime.bridge.armature.fcurves import holder_in, keys, slot_identifier
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.worker_client import shared
from hangtime.operators.solve.adapt import ask_for
from hangtime.operators.solve.common import said
from hangtime.operators.solve.session import Asked, session
from hangtime.operators.solve.solving import SolveState, Solving
from hangtime.operators.solve.task import Task, kept_in_scene
from hangtime.operators.solve.write_answer import write_answer
from hangtime.solver.data.faults import Fault
from hangtime.solver.worker.protocol import Adapted, RequestKind
from hangtime.tests.blender.conftest import opened
from hangtime.tests.blender.operators.solve.meanwhile.changes import (
    edit,
    purge,
    remove,
    rename,
    undo,
)

pytestmark = pytest.mark.usefixtures("_enabled", "_solving")

Solved = tuple[Asked, Adapted]


@pytest.fixture(scope="module")
def solved(_adapted_file: Path) -> Solved:
    """Another answer for what has a result already."""
    armature = opened(_adapted_file)
    armature.hangtime.stances["ground 2"].up = 0.1
    asked = complete(ask_for(bpy.context))
    job = shared().ask(RequestKind.ADAPT, asked.recording, asked.problem)
    job.wait()
    assert isinstance(job.answer, Adapted)
    return asked, job.answer


@pytest.fixture
def armature(_adapted_file: Path) -> bpy.types.Object:
    armature = opened(_adapted_file)
    armature.hangtime.stances["ground 2"].up = 0.1
    for count in range(2):  # an undo goes back to the first
        bpy.ops.ed.undo_push(message=f"{count}")
    return armature


def _begun(armature: bpy.types.Object, solved: Solved, until: Callable[[], bool]) -> Task:
    """The writing of a result, in parts, as it is when something is reached."""
    asked, answer = solved
    session().solving = replace(Solving(), state=SolveState.SOLVING)
    mine = replace(asked, uid=armature.session_uid)
    task = kept_in_scene(bpy.context, write_answer(mine, answer))
    while not until():
        next(task)
    return task


def _copied() -> bool:
    """The action that becomes a result is there."""
    return any(each.name.endswith(" adapted 2") for each in bpy.data.actions)


def _shown() -> bool:
    """The result is shown, and is looked at."""
    armature = bpy.context.object
    return bool(armature.animation_data.action.name.endswith(" adapted 2"))


def _keys_of(action: bpy.types.Action, armature: bpy.types.Object) -> list[bytes]:
    curves = present(holder_in(action, slot_identifier(armature))).fcurves
    return [keys(curve).tobytes() for curve in curves]


@pytest.mark.parametrize("until", [_copied, _shown])
@pytest.mark.parametrize(
    ("disturb", "told"),
    [
        (purge, "Purge"),
        (edit, "leave edit mode"),
        (rename, "its bones"),
        (remove, "was removed"),
        (undo, "undone or redone"),
    ],
)
def test_what_comes_in_between_is_told_and_leaves_nothing_of_a_result(
    armature: bpy.types.Object,
    solved: Solved,
    until: Callable[[], bool],
    disturb: Callable[[bpy.types.Object], None],
    told: str,
) -> None:
    before = armature.hangtime.adapted
    name, recording = before.name, before.hangtime.recording.name
    was = _keys_of(bpy.data.actions[recording], armature)
    before.use_fake_user = True  # or a purge takes it, too, once another is shown
    task = _begun(armature, solved, until)
    disturb(armature)
    if until is _shown and disturb is purge:  # what is shown stays
        assert complete(task).startswith("Wrote")
        return
    with pytest.raises(Fault) as fault:
        complete(task)
    assert told in said(fault.value)
    assert not _copied()
    if disturb is remove:
        return
    armature = bpy.context.object
    assert armature.hangtime.adapted.name == armature.animation_data.action.name == name
    if disturb is not rename:  # which renames what keys are of
        assert _keys_of(bpy.data.actions[recording], armature) == was


def test_what_others_made_meanwhile_stays(armature: bpy.types.Object, solved: Solved) -> None:
    def make(*_of_handler: object) -> None:
        """Another extension makes an action as soon as the frame changes."""
        if "Another's" not in bpy.data.actions:
            bpy.data.actions.new("Another's")

    task = _begun(armature, solved, _copied)
    with ExitStack() as undo:
        add_handler(undo, bpy.app.handlers.frame_change_post, make)
        while not _shown():
            next(task)
    assert "Another's" in bpy.data.actions
    rename(armature)
    with pytest.raises(Fault):
        complete(task)
    assert not _copied()
    assert "Another's" in bpy.data.actions
