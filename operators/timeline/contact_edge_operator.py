"""Drag Contact Edge: retimes a contact or a phase by its bar in the timeline."""

from math import isnan

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.rows.phases import carried, clip_ends, listed, phases
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import chosen_armature, required_armature
from ..solve.live import redraw
from .contact_bars import Grip
from .contact_edge_state import Edge, EdgeDrag, Touch, contact_drag, phase_drag
from .timeline_bars import bars_in, frames_axis

NOTHING_TO_RETIME = "Press Analyze first: there are no contacts to retime"
FOLLOW_AFTER = 3.0  # px, at an interface scale of 1, until a click becomes a drag
FIELDS = {Edge.START: "start_frame", Edge.END: "end_frame"}
VERBS = {Edge.START: "starts", Edge.END: "ends"}
GIVES_UP = {"ESC", "RIGHTMOUSE"}
MOVES = {"MOUSEMOVE", "LEFT_CTRL", "RIGHT_CTRL", "LEFT_SHIFT", "RIGHT_SHIFT"}
EDITORS = ("DOPESHEET_EDITOR", "VIEW_3D")  # in which contacts are seen


class _OfKnownContacts(PolledOperator):
    """Mixin: needs contacts."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        known = armature is not None and bool(listed(settings_of(armature)))
        return None if known else NOTHING_TO_RETIME


class DragContactEdgeOperator(_OfKnownContacts, bpy.types.Operator):
    bl_idname = OperatorId.DRAG_CONTACT_EDGE
    bl_label = "Drag Contact Edge"
    bl_description = (
        "Change when a contact or a phase starts or ends. The next Adapt takes it into account"
    )
    bl_options = {"UNDO", "BLOCKING"}

    contact: bpy.props.StringProperty(
        name="Contact", description="Name of the contact, or of the ground phase"
    )
    edge: bpy.props.EnumProperty(
        name="Edge", description="Which end moves", items=[(e.name, e.value, "") for e in Edge]
    )
    frame: bpy.props.FloatProperty(name="Frame", description="Where the end goes")

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        drag = drag_of(settings, self.contact, Edge[self.edge])
        if drag is None:
            return self.refuse(f"There is no contact or ground phase called “{self.contact}”")
        if isnan(self.frame):
            return self.refuse("The frame where the end is to go is no number")
        drag.begin(drag.origin)
        drag.put(self.frame, fine=True)
        if abs(drag.frame - self.frame) > 0.5:
            self.report({"WARNING"}, f"It goes no further than frame {drag.frame:g}")
        write(settings, drag.edge, drag.edges)
        return {"FINISHED"} if drag.release() else {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        """Passes the event on where the mouse is at no edge, so that keys can be edited there."""
        if context.area is None or context.area.type != "DOPESHEET_EDITOR":
            return self.execute(context)
        bars = bars_in(context)
        x, y = event.mouse_region_x, event.mouse_region_y
        grip = bars.grip_at(x, y) if bars is not None else None
        settings = settings_of(required_armature(context))
        drag = drag_of(settings, grip.bar.name, grip.edge) if grip is not None else None
        if bars is None or grip is None or drag is None:
            return {"PASS_THROUGH"}
        drag.slack = FOLLOW_AFTER * bars.scale / bars.axis.per_unit
        drag.begin(bars.axis.value(x))
        self._drag, self._axis = drag, bars.axis
        armature = required_armature(context)
        self._armature, self._selected = armature.session_uid, settings.active_contact
        self._choose(settings, grip)
        self.contact, self.edge = grip.bar.name, grip.edge.name
        present(context.window).cursor_modal_set("MOVE_X")
        self._show(context)
        present(context.window_manager).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        if event.type.startswith("TIMER"):
            return {"PASS_THROUGH"}  # playback goes on
        gone = context.area is None  # the timeline, or another workspace is shown
        if gone or (event.type in GIVES_UP and event.value == "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        settings = self._settings()
        if settings is None:  # a script removed it
            self._end(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            return self._finished(context, settings)
        if event.type in MOVES:
            axis = frames_axis(present(context.region)) or self._axis
            mouse, fine = axis.value(event.mouse_region_x), event.ctrl or event.shift
            write(settings, self._drag.edge, self._drag.move(mouse, fine=fine))
            self._show(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender when it opens another file or quits meanwhile."""
        settings = self._settings()
        if settings is not None:
            write(settings, self._drag.edge, self._drag.cancel())
            settings.active_contact = self._selected
        self._end(context)

    def _finished(self, context: bpy.types.Context, settings: HangtimeSettings) -> OperatorResult:
        moved = self._drag.release()
        self.frame = self._drag.frame
        self._end(context)
        chosen = settings.active_contact != self._selected
        return {"FINISHED"} if moved or chosen else {"CANCELLED"}

    def _choose(self, settings: HangtimeSettings, grip: Grip) -> None:
        index = settings.contacts.find(grip.bar.name)
        if index >= 0 and not grip.bar.is_phase:
            settings.active_contact = index

    def _settings(self) -> HangtimeSettings | None:
        armature = next((o for o in bpy.data.objects if o.session_uid == self._armature), None)
        return settings_of(armature) if armature is not None else None

    def _show(self, context: bpy.types.Context) -> None:
        drag = self._drag
        text = f"{self.contact} {VERBS[drag.edge]} at frame {drag.frame:g} ({drag.change:+.3g})"
        present(context.area).header_text_set(f"{text}    Ctrl: tenths of a frame    Esc: cancel")
        redraw(*EDITORS)

    def _end(self, context: bpy.types.Context) -> None:
        if context.window is not None:
            context.window.cursor_modal_restore()
            redraw(*EDITORS)
        if context.area is not None:
            context.area.header_text_set(None)


class PickContactOperator(_OfKnownContacts, bpy.types.Operator):
    bl_idname = OperatorId.PICK_CONTACT
    bl_label = "Pick Contact"
    bl_description = "Choose a contact in the list by its bar in the timeline"
    bl_options = {"UNDO"}

    contact: bpy.props.StringProperty(name="Contact", description="Name of the contact")

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        index = settings.contacts.find(self.contact)
        if index < 0:
            return self.refuse(f"There is no contact called “{self.contact}”")
        settings.active_contact = index
        redraw(*EDITORS)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> OperatorResult:
        """The click goes on to what is below: keys can be selected there."""
        bars = bars_in(context)
        x, y = event.mouse_region_x, event.mouse_region_y
        bar = bars.bar_at(x, y) if bars is not None else None
        if bar is None or bar.is_phase or bar.is_doubt or bar.chosen:
            return {"PASS_THROUGH"}
        self.contact = bar.name
        return self.execute(context) | {"PASS_THROUGH"}


def drag_of(settings: HangtimeSettings, name: str, edge: Edge) -> EdgeDrag | None:
    """Of the edge of a contact that counts or of a ground phase; None where there is none such."""
    clip = present(clip_ends(settings))
    touches = [
        Touch(row.name, row.point, row.start_frame, row.end_frame)
        for row in settings.contacts
        if row.used
    ]
    if any(touch.name == name for touch in touches):
        return contact_drag(touches, name, edge, clip)
    spans = phases(carried(settings), *clip)
    stance = next((s for s in spans if s.name == name and s.is_ground), None)
    return phase_drag(touches, (stance.start, stance.end), edge, clip) if stance else None


def write(settings: HangtimeSettings, edge: Edge, frames: dict[str, float]) -> None:
    """Puts contacts' edges at frames, by the contacts' names."""
    for name, frame in frames.items():
        row = settings.contacts.get(name)
        if row is not None and getattr(row, FIELDS[edge]) != frame:
            setattr(row, FIELDS[edge], frame)
