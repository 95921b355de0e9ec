"""Cooperative multitasking of long operators: parts and a worker, so that Blender never freezes."""

from collections.abc import Generator, Mapping
from contextlib import AbstractContextManager, nullcontext
from time import perf_counter
from typing import TypeVar

import bpy

from ...bridge.accessors import present
from ...bridge.armature.incremental import at_once
from ...bridge.repairs.unreadable import unreadable_texts
from ...bridge.worker_client import shared
from ...bridge.worker_requests import PendingRequest
from ...solver.data.faults import Fault, UndoneMeanwhile
from ...solver.worker.protocol import Failed, Progress
from ..operator_types import OperatorResult
from .common import FaultyOperator, ReadyOperator, chosen_armature, failed, said
from .live import editors, redraw_viewports
from .meanwhile.replaced import before_replaced, end_with
from .session import session
from .solving import SolveState, Solving

LOOK_EVERY = 0.02  # s
LOOK_AGAIN = 0.1  # s
BUDGET = 0.012  # s of work at each look
STATUS = "Hangtime: {} (Esc cancels)"
TAKEN_AWAY = "Stopped, because the scene changed meanwhile; nothing was written. Try again"

A = TypeVar("A")
Task = Generator[PendingRequest | float | None, None, str]
"""Work in parts; where it yields a job it waits for that, and a number is how much of the current
state's work is done. Returns what to tell the artist."""


def answered(job: PendingRequest, kind: type[A]) -> Generator[PendingRequest, None, A]:
    """Waits in a task for the answer of this kind. Raises the fault of a job that fails."""
    while job.answer is None:
        yield job
    if isinstance(job.answer, Failed):
        raise job.answer.fault
    assert isinstance(job.answer, kind)
    return job.answer


def kept_in_scene(context: bpy.types.Context, task: Task) -> Task:
    """The same work in the context's scene and view layer, also while another scene is shown.

    It ends before an undo frees what a part keeps for the next one; while a job is waited for,
    tasks keep no curves, bones and settings, and go on. Raises ReferenceError where the scene is
    gone, and UndoneMeanwhile.
    """
    scene, layer = present(context.scene).session_uid, present(context.view_layer).name
    job: PendingRequest | float | None = None
    undone: list[Fault] = []

    def stop() -> None:
        if not (undone or isinstance(job, PendingRequest)):
            undone.append(UndoneMeanwhile())
            with _in_scene_if_there(scene, layer):
                end_with(task, undone[0])

    try:
        with before_replaced(stop):
            while True:
                for fault in undone:
                    raise fault
                with _in_scene(scene, layer):
                    try:
                        job = next(task)
                    except StopIteration as end:
                        return str(end.value)
                yield job
    finally:
        with _in_scene_if_there(scene, layer):
            task.close()


def _in_scene_if_there(uid: int, layer: str) -> AbstractContextManager[object]:
    there = any(each.session_uid == uid for each in bpy.data.scenes)
    return _in_scene(uid, layer) if there else nullcontext()


def _in_scene(uid: int, layer: str) -> AbstractContextManager[object]:
    """Context of a scene (its number in this session) and its layer of that name, or its first."""
    scene = next((each for each in bpy.data.scenes if each.session_uid == uid), None)
    if scene is None:
        raise ReferenceError
    layers = scene.view_layers
    return bpy.context.temp_override(scene=scene, view_layer=layers.get(layer) or layers[0])


class TaskOperator(ReadyOperator, FaultyOperator):
    """Mixin: `task` does the work; waits for it in scripts, looks now and then in the interface."""

    def task(self, context: bpy.types.Context) -> Task:
        """The work. Raises any Fault, having changed nothing but what `Solving.analysed` tells."""
        raise NotImplementedError

    def run(self, context: bpy.types.Context) -> OperatorResult:
        solving = session().solving = self._begun()
        task = kept_in_scene(context, self.task(context))
        finished = False
        try:
            with at_once():
                while True:
                    job = next(task)
                    if isinstance(job, PendingRequest):
                        job.wait()
        except StopIteration as end:
            finished = True
            self._finish(end.value)
            return {"FINISHED"}
        finally:
            session().solving = None
            if not finished:
                task.close()
                if solving.state is SolveState.SOLVING and shared().busy:  # interrupted
                    shared().close()

    def _begun(self) -> Solving:
        return Solving(type(self).bl_idname, label=type(self).bl_label, looks=self.looks())

    def looks(self) -> Mapping[SolveState, float]:
        """How often each state after reading looks at every frame, as of `Solving`."""
        return {}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._solving = session().solving = self._begun()
        session().failure = None
        armature = chosen_armature(context)
        self._uid = armature.session_uid if armature is not None else 0
        self._task = kept_in_scene(context, self.task(context))
        manager = present(context.window_manager)
        self._timer = manager.event_timer_add(LOOK_EVERY, window=context.window)
        self._window, self._shown = context.window, ""
        session().running.append(self)
        self._show()
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, _context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        if event.value == "PRESS" and event.type == "ESC" and self in session().running:
            self.leave()
            self.report({"INFO"}, self._solving.cancelled)
        if self not in session().running:  # it may have been ended from outside, too
            return self._ended()
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if self._solving.passes(event.type) else {"RUNNING_MODAL"}
        return self._work()

    def _finish(self, told: str) -> None:
        """The work is done, which is told; and what did not count meanwhile, as it was no text of
        ours."""
        self.report({"INFO"}, told)
        armature = chosen_armature(bpy.context)
        for fault in unreadable_texts(armature) if armature is not None else ():
            self.report({"WARNING"}, said(fault))

    def _work(self) -> OperatorResult:
        """As many parts as fit into a look."""
        until = perf_counter() + BUDGET
        goes_on = False
        try:
            while perf_counter() < until:
                job = next(self._task)
                if isinstance(job, float):
                    self._solving.did(job)
                elif job is not None and not self._heard(job):
                    break
            self._show()
            goes_on = True
        except StopIteration as end:
            self._finish(end.value)
            return {"FINISHED"}
        except Fault as fault:
            self._solving.written = False  # a result goes with its fault
            # the report vanishes when the mouse moves
            failure = session().failure = failed(fault, self._uid, type(self).bl_idname)
            # An error's pop-up would hide the panel, which says more.
            self.refuse(failure.short, "WARNING")
            return self._ended()
        except ReferenceError:  # an undo took the armature away from under us
            return self.refuse(TAKEN_AWAY)
        finally:
            if not goes_on:  # also after a mistake of ours, or every button stayed grey
                self.leave()
        return {"RUNNING_MODAL"}

    def _ended(self) -> OperatorResult:
        """Of work that ended before its end: a step to undo where something of it stays."""
        return {"FINISHED"} if self._solving.has_result else {"CANCELLED"}

    def _heard(self, job: PendingRequest) -> bool:
        """Takes in a job's news; whether its answer is among them."""
        for message in job.news():
            if isinstance(message, Progress):
                self._solving.heard(message)
        return job.answer is not None

    def cancel(self, _context: bpy.types.Context) -> None:
        """Blender calls this when it opens another file, closes the window or quits meanwhile; what
        the task has to put back waits where the window is being closed."""
        self._leave(window_closes=closes(self._window))

    def leave(self) -> None:
        """Nothing of the work remains; a solve under way is dropped."""
        self._leave(window_closes=False)

    def _leave(self, *, window_closes: bool) -> None:
        running = session().running
        if self not in running:
            return
        running.remove(self)
        session().solving = None
        shared().drop()
        if window_closes:
            bpy.app.timers.register(self._task.close, first_interval=0.0)
        else:
            self._task.close()
        clear_status(window_closes=window_closes)
        present(bpy.context.window_manager).event_timer_remove(self._timer)
        _redraw()
        bpy.app.timers.register(settle, first_interval=LOOK_AGAIN)

    def _show(self) -> None:
        """Only what is new: drawing the sidebar again costs more than a look."""
        text = self._solving.text
        if text != self._shown:
            self._shown = text
            session().status_bar.say(STATUS.format(text))
            _redraw()


def closes(window: bpy.types.Window) -> bool:
    """Whether a window is being closed, while no context may be overridden, or Blender ends with a
    segmentation fault (4.3)."""
    return window not in list(present(bpy.context.window_manager).windows)


def clear_status(*, window_closes: bool) -> None:
    """Blender's own hints again in the status bar: once a window that is being closed is gone, else
    at once, for another file may have these workspaces, renumbered."""
    if window_closes:
        bpy.app.timers.register(settle, first_interval=0.0)
    else:
        session().status_bar.clear()


def settle() -> None:
    """After work has ended, also by its window being closed, in which nothing may be said then.

    What was drawn as it ended is what was before: buttons change their kind a redraw later, and
    what was found shows in the viewport.
    """
    if not session().running:
        session().status_bar.clear()
    redraw_viewports()


def take_best() -> bool:
    """Has the solve under way end with the motion as it stands; whether there was one to end."""
    solving = session().solving
    if solving is None or not solving.can_stop or not shared().busy:
        return False
    solving.stop()
    shared().as_it_stands()
    return True


def _redraw() -> None:
    """The sidebar shows how far a solve is."""
    for area in editors("VIEW_3D"):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()
