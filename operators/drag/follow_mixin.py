"""Modal drag of contacts and points: the motion follows as a ghost; letting go adapts."""

from contextlib import suppress
from functools import partial

import bpy

from ...bridge.accessors import present
from ...bridge.armature.incremental import Incremental
from ...bridge.armature.poses import require_unstretched
from ...bridge.properties.settings import settings_of
from ...bridge.repairs.analysed_state import require_in_place
from ...bridge.repairs.analysis_key import analysis_is_of
from ...bridge.scene.members import present_members
from ...bridge.worker_client import shared
from ...solver.data.faults import (
    ChangedMeanwhile,
    Fault,
    RateChanged,
    SpanChanged,
    TimeStretched,
)
from ...solver.data.status import DragStatus
from ...solver.worker.protocol import Answer, Failed, Followed, Progress
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.adapt import ask_for, followed_problem, unanalysed
from ..solve.common import failed, required_armature, said
from ..solve.live import clear_header, live, redraw_viewports, redraw_views
from ..solve.session import Asked, session
from ..solve.task import clear_status, closes
from ..words.failure_text import Failure
from ..words.report_text import deeper, higher
from .mouse import BACK, CONFIRM, GIVEN, Press
from .typed_number import TypedNumber

LOST = "no motion follows there; the ghost stays where it last could"
ELSEWHERE = "Drag in a 3D viewport"
TAKEN_AWAY = "The drag has ended: its armature is gone"
LOOK_EVERY = 0.01  # s; a look costs little, and the ghost waits for the next one
# The recording is another than was analysed, or is shown otherwise than it is keyed.
VOIDS = (ChangedMeanwhile, RateChanged, SpanChanged, TimeStretched)
# s, at most, for which the first move of the mouse waits for its ghost, which mostly takes a third:
# Blender draws then, and a ghost that comes later is seen a whole drawing later.
TOGETHER = 0.12


class FollowedDrag(PolledOperator):
    """Mixin of modal operators that drag contacts or points in a 3D viewport."""

    release_confirm: bpy.props.BoolProperty(options=GIVEN)
    adapt: bpy.props.BoolProperty(
        name="Adapt", description="Adapt the motion once the mouse lets go", default=True
    )
    _void = False  # whether a fault is one of `VOIDS`

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return unanalysed(context)

    # -- what is dragged -----------------------------------------------------------------------

    def take(self, context: bpy.types.Context) -> str | None:
        """The mouse takes hold; why it cannot, or None."""
        raise NotImplementedError

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """The mouse is elsewhere."""
        raise NotImplementedError

    def put_by(self, number: float) -> None:
        """Moves it by a number that is typed, from where it was taken."""
        raise NotImplementedError

    def press(self, _event: bpy.types.Event) -> bool:
        """A key was pressed; whether it means something."""
        return False

    @property
    def held(self) -> str:
        """Name of the contact that the mouse holds; "" of none."""
        raise NotImplementedError

    def put_back(self) -> None:
        """All is as it was."""
        raise NotImplementedError

    def let_go(self) -> bool:
        """The mouse lets go; whether anything has been dragged."""
        raise NotImplementedError

    def chosen(self) -> bool:
        """It was clicked, not dragged; whether that has chosen anything."""
        return False

    @property
    def key_hints(self) -> str:
        """What the status bar says of keys."""
        raise NotImplementedError

    def text(self) -> str:
        """The displacement, for the header."""
        raise NotImplementedError

    # -- Blender's way -------------------------------------------------------------------------

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        self._armature = required_armature(context)
        self._press = Press.of(context, event, click=self.release_confirm)
        try:
            if self._press.dragging:  # a click on a handle chooses it all the same
                self._require_as_analysed(context)
        except Fault as fault:
            return self.refuse(said(fault))
        why = ELSEWHERE if context.region_data is None else self.take(context)
        if why is not None:
            return self.refuse(why)
        self._moved, self._share = True, 0.0
        self._idle = self._told = False  # Blender; anything by the worker
        self._fault = self._shown = ""
        self._typed = TypedNumber()
        self._task = self._follow(context)
        self._area, self._window = present(context.area), present(context.window)
        manager = present(context.window_manager)
        self._timer = manager.event_timer_add(LOOK_EVERY, window=context.window)
        session().running.append(self)
        session().status_bar.say(self.key_hints)
        manager.modal_handler_add(self)
        self._look()
        self._show()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        if self not in session().running:
            return {"CANCELLED"}
        goes_on = False
        try:
            if context.region_data is None:  # its viewport is gone, or another workspace is shown
                return self._back()
            result = self._react(context, event)
            goes_on = True
        except ReferenceError:  # a script took the armature away from under us
            live().clear()
            return self.refuse(TAKEN_AWAY)
        finally:
            if not goes_on:  # also after a mistake of ours, or every button stayed grey
                self.leave()
        return result

    def _react(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        pressed = event.value == "PRESS"
        if event.type in BACK and pressed:
            return self._back()
        ends = event.type == "LEFTMOUSE" and event.value == self._confirming
        if ends or (event.type in CONFIRM and pressed):
            return self._end()
        if event.type == "INBETWEEN_MOUSEMOVE":
            # The worker goes on with where the mouse is, which follows: with the first of these it
            # would go on with where it was before the last drawing.
            return {"RUNNING_MODAL"}
        if pressed and self._typed.key(event.type, event.ascii):
            self._press.dragging = keyed = True
        else:
            keyed = pressed and self.press(event)
        moved = event.type == "MOUSEMOVE" and self._press.drags(context, event)
        if keyed or (moved and not self._typed):
            if self._typed or self._press.over_bar:  # over a bar the mouse leads nowhere
                self.put_by(self._typed.value)
            else:
                self.pull(context, event)
            self._moved = True
            redraw_views()  # the sidebar's numbers go with the ghost, which waits for no drawing
        self._idle = event.type == "TIMER"
        self._look()  # at every event, for a timer's comes after all is drawn
        self._show()
        return {"RUNNING_MODAL"}

    def cancel(self, _context: bpy.types.Context) -> None:
        """Blender calls this when it opens another file, closes the window or quits meanwhile: all
        is as before the drag, which nobody can adapt any more."""
        if self in session().running:
            try:
                with suppress(ReferenceError):  # the armature is gone, with all that has moved
                    self.put_back()
            finally:
                self.leave()
                live().clear()

    def leave(self) -> None:
        """Nothing of the drag remains but where things are."""
        running = session().running
        if self in running:
            running.remove(self)
            shared().drop()
            self._task.close()
            present(bpy.context.window_manager).event_timer_remove(self._timer)
            clear_header(self._area)
            redraw_viewports()
            clear_status(window_closes=closes(self._window))

    @property
    def _confirming(self) -> str:
        return "RELEASE" if self.release_confirm else "PRESS"

    def _back(self) -> OperatorResult:
        self.put_back()
        self.leave()
        live().clear()
        return {"CANCELLED"}

    def _end(self) -> OperatorResult:
        # The pin is not where it would be found, and its move would be kept; a click moves nothing.
        if self._void and self._press.dragging:
            self._back()
            return self.refuse(self._fault, "WARNING")
        moved = self.let_go()
        self.leave()
        if moved and self.adapt:
            # Once this operator has ended, so that each has an undo step of its own.
            bpy.app.timers.register(partial(_adapt, self._area.as_pointer()), first_interval=0.0)
        else:
            live().clear()
        return {"FINISHED"} if moved or self.chosen() else {"CANCELLED"}

    # -- the motion that follows ---------------------------------------------------------------

    def _require_as_analysed(self, context: bpy.types.Context) -> None:
        """What can be told without reading. Raises TimeStretched, ChangedMeanwhile."""
        require_unstretched(present(context.scene))
        require_in_place(self._armature)

    def _follow(self, context: bpy.types.Context) -> Incremental[None]:
        """Has the worker follow what is dragged, from the press on, though a click shows no ghost:
        of recording and scene as they were read last. They are read again, in parts, once it has
        told anything, for the first ghost waits for no reading. Raises TimeStretched,
        ChangedMeanwhile where it is another recording or elsewhere, AimedBone.
        """
        self._require_as_analysed(context)
        reading, asked = ask_for(context), self._read_before(context)
        if asked is None:
            asked = yield from reading
        stream, waits = shared().follow(asked.recording), True
        while True:
            try:
                if self._idle and self._told:  # not at each of the mouse's moves, which would lag
                    next(reading)
            except StopIteration as end:
                if end.value is not None:  # surfaces may be elsewhere than they were
                    asked, self._moved = end.value, True
            session().dragged = asked
            if self._moved:  # before the news, after which the worker goes on with it
                self._moved = False
                problem = followed_problem(settings_of(self._armature), asked, self.held)
                stream.want(problem, ahead=not self._press.dragging)
            for message in stream.news():
                self._hear(message)
            if waits and self._press.dragging:
                waits = False
                for message in stream.first_news(TOGETHER):
                    self._hear(message)
            yield None

    def _read_before(self, context: bpy.types.Context) -> Asked | None:
        """What was read last, where it was of this armature, its analysis and these surfaces."""
        asked, settings = session().dragged, settings_of(self._armature)
        if asked is None or asked.uid != self._armature.session_uid:
            return None
        there = {(m.name, m.role) for m in present_members(settings, present(context.scene))}
        same = {(thing.whole, thing.role) for thing in asked.scene.objects} == there
        return asked if same and analysis_is_of(settings, asked.recording) else None

    def _hear(self, message: Progress | Answer) -> None:
        self._told = True
        if isinstance(message, Progress):
            self._share = message.share
        elif isinstance(message, Failed):
            self._failed(message.fault)
        elif isinstance(message, Followed):
            self._fault = ""
            live().show(self._armature.name, message)

    def _look(self) -> None:
        """A part of the work; what cannot be followed is said, in the panel as Adapt would, and the
        drag goes on without."""
        try:
            next(self._task)
        except Fault as fault:
            self._void = isinstance(fault, VOIDS)
            session().failure = self._failed(fault)
            redraw_viewports()  # the panel, too
        except StopIteration:
            pass  # after such a fault

    def _failed(self, fault: Fault) -> Failure:
        """The header says what to do, and no ghost shows."""
        failure = failed(fault, self._armature.session_uid, OperatorId.ADAPT)
        self._fault = failure.cure_first
        live().clear()
        return failure

    def _show(self) -> None:
        typed = f"[{self._typed}] " if self._typed else ""
        found = f" · {self._fault}" if self._fault else self._found()
        text = typed + self.text() + found  # numbers first: what is wrong may be cut off
        if text != self._shown:  # drawing the header again costs more than a look
            self._shown = text
            self._area.header_text_set(text)

    def _found(self) -> str:
        seen = live().seen
        if not self._press.dragging:
            return ""
        if seen is None:
            return f" · fitting the physics, {100.0 * self._share:.0f} %"
        if seen.status is DragStatus.DIVERGED:
            return f" · {LOST}"
        summary = seen.summary
        return (
            f" · crouch {deeper(summary.deeper_cm)}, apex {higher(summary.higher_cm)}, "
            f"force up to {summary.peak_bw:.1f} BW"
        )


def _adapt(pointer: int) -> None:
    """Letting go finishes the solve. pointer: of the area where the mouse was."""
    for window in present(bpy.context.window_manager).windows:
        areas = [a for a in window.screen.areas if a.type == "VIEW_3D"]
        for area in sorted(areas, key=lambda a: a.as_pointer() != pointer):
            region = next(r for r in area.regions if r.type == "WINDOW")
            with bpy.context.temp_override(window=window, area=area, region=region):
                adapt = bpy.ops.hangtime.adapt  # type: ignore[attr-defined]  # our own
                if adapt.poll():
                    adapt("INVOKE_DEFAULT")
                    return
    live().clear()
