"""What others do to the scene while a result is written, between two parts of that."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, present
from hangtime.bridge.app_handlers import add_handler
from hangtime.bridge.armature.fcurves import holder_in, keys, slot_identifier
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.properties.action import action_settings
from hangtime.bridge.rows.choices import WrittenAs
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
from hangtime.tests.helpers.clips import JUMP_FRAMES

FORMS = [form for form in WrittenAs if form is not WrittenAs.SLOT or bpy.app.version >= (4, 5)]
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


def _begun(
    armature: bpy.types.Object,
    solved: Solved,
    until: Callable[[], bool],
    form: WrittenAs = WrittenAs.ACTION,
) -> Task:
    """The writing of a result, in parts, as it is when something is reached."""
    asked, answer = solved
    session().solving = replace(Solving(), state=SolveState.SOLVING)
    options = replace(asked.result, written_as=form)
    mine = replace(asked, uid=armature.session_uid, result=options)
    task = kept_in_scene(bpy.context, write_answer(mine, answer))
    while not until():
        next(task)
    return task


def _copied() -> bool:
    """The action that becomes a result is there."""
    return any(each.name.endswith(" adapted 2") for each in bpy.data.actions)


def _shown() -> bool:
    """The result is shown, and is looked at."""
    return str(present(current_action(bpy.context.object)).name).endswith(" adapted 2")


def _whole() -> bool:
    """The result is in its form, and knows what it was made of; one part is left."""
    return _shown() and bool(action_settings(bpy.context.object.hangtime.adapted).own_key)


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


def _laid_out(armature: bpy.types.Object) -> list[object]:
    """What an armature shows, and what others could: its action and slot, its tracks with their
    strips, and the scene's end."""
    data = armature.animation_data
    tracks = [(t.name, t.mute, [(s.name, s.mute) for s in t.strips]) for t in data.nla_tracks]
    slots = {a.name: [s.identifier for s in getattr(a, "slots", ())] for a in bpy.data.actions}
    shown = (data.action, slot_identifier(armature), current_action(armature))
    settings = armature.hangtime
    kept = (settings.adapted, settings.take_strips, data.action_extrapolation)
    return [*shown, *kept, tracks, slots, bpy.context.scene.frame_end]


def _pushed_down(armature: bpy.types.Object) -> None:
    """The artist has laid what is shown into a strip."""
    _in_a_strip_besides(armature)
    armature.animation_data.action = None


def _in_a_strip_besides(armature: bpy.types.Object) -> None:
    """The artist has laid what is shown into a strip, and assigned it again."""
    data = armature.animation_data
    strip = data.nla_tracks.new().strips.new("The artist's", 1, data.action)
    if hasattr(strip, "action_slot"):
        strip.action_slot = data.action_slot


def _as_it_is(_armature: bpy.types.Object) -> None:
    """The artist has no strips."""


@pytest.mark.parametrize("lay", [_as_it_is, _pushed_down, _in_a_strip_besides])
@pytest.mark.parametrize("form", FORMS)
def test_after_a_fault_all_is_laid_out_as_it_was(
    armature: bpy.types.Object,
    solved: Solved,
    form: WrittenAs,
    lay: Callable[[bpy.types.Object], None],
) -> None:
    lay(armature)
    bpy.context.scene.frame_end = int(JUMP_FRAMES[1])
    was = _laid_out(armature)
    task = _begun(armature, solved, _whole, form)
    rename(armature)
    with pytest.raises(Fault):
        complete(task)
    assert _laid_out(armature) == was
