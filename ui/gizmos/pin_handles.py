"""Handles of contacts and points, and of the stance of the chosen contact."""

from dataclasses import dataclass

import bpy
from mathutils import Vector

from ...bridge.constraint_kinds import point
from ...bridge.properties.stances import active_stance, stance_contacts, stance_middle
from ...operators.names import OperatorId
from ..overlay.context.view_context import ViewContext
from ..overlay.geometry import palette
from ..overlay.geometry.shapes import faded
from .shown import handled, knob, new_gizmo, paint, put

UNSEEN = 0.0  # opacity of those that show only under the mouse
RING_MARGIN = 0.14  # m, by how much the ring is wider than the stance, of a figure of usual size
ARROW = 0.7  # length, as a share of the size of gizmos in the preferences


@dataclass(frozen=True)
class Handle:
    """Of a contact or of a point, one of which is -1. at: Blender units, world."""

    contact: int
    constraint: int
    at: Vector
    near: bool  # whether it belongs to what is chosen


def handles(view: ViewContext) -> list[Handle]:
    """Of every contact that counts and of every point with a place of its own."""
    settings = view.settings
    stance = active_stance(settings)
    phase = stance.name if stance is not None else None
    contacts = [
        Handle(i, -1, Vector(row.at), row.phase == phase)
        for i, row in enumerate(settings.contacts)
        if row.used
    ]
    points = [
        Handle(-1, i, Vector(row.place), True)
        for i, row in enumerate(settings.constraints)
        if row.kind == point.KIND.name and row.used and row.use_place and row.target is None
    ]
    return contacts + points


class PinHandles(bpy.types.GizmoGroup):
    bl_idname = "HANGTIME_GGT_pins"
    bl_label = "Hangtime Pins"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT"}

    def setup(self, _context: bpy.types.Context) -> None:
        self._pins: list[tuple[bpy.types.Gizmo, bpy.types.OperatorProperties]] = []
        self._state: object = None  # that they were put by
        self._ring = self._new_ring()
        self._arrow, self._lift = self._new_arrow()

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """Blender calls this in each redraw; nothing else is told of undo or of scripts. A poll it
        would call several times more often."""
        view = handled(context, "pins")
        state = view.state if view is not None else None
        if state == self._state:
            return
        self._state = state
        shown = handles(view) if view is not None else []
        while len(self._pins) < len(shown):
            self._pins.append(self._new_pin())
        for gizmo, _ in self._pins[len(shown) :]:
            gizmo.hide = True
        for (gizmo, drag), handle in zip(self._pins, shown, strict=False):
            put(gizmo, handle.at)
            gizmo.alpha = palette.PIN[3] if handle.near else UNSEEN
            drag.contact, drag.constraint = handle.contact, handle.constraint
        self._place_stance(view)

    def _place_stance(self, view: ViewContext | None) -> None:
        self._ring.hide = self._arrow.hide = True
        stance = active_stance(view.settings) if view is not None else None
        if view is None or stance is None:
            return
        middle = stance_middle(view.settings, stance.name)
        if middle is None:
            return
        contacts = stance_contacts(view.settings, stance.name)
        reach = max((Vector(c.at) - middle).xy.length for c in contacts) + RING_MARGIN * view.units
        put(self._ring, middle, reach)
        # in front of the feet, where it hides none of their handles
        put(self._arrow, middle + reach * Vector(stance.forward_axis))
        self._lift.contact = view.settings.active_contact

    def _new_pin(self) -> tuple[bpy.types.Gizmo, bpy.types.OperatorProperties]:
        gizmo = knob(self)
        paint(gizmo, palette.PIN)
        drag = gizmo.target_set_operator(OperatorId.DRAG_PIN)
        drag.release_confirm = True
        return gizmo, drag

    def _new_ring(self) -> bpy.types.Gizmo:
        ring = self.gizmos.new("GIZMO_GT_dial_3d")
        ring.use_draw_scale = False
        ring.line_width = 2.0
        paint(ring, faded(palette.MOVE, 0.5))
        turn = ring.target_set_operator(OperatorId.TURN_STANCE)
        turn.release_confirm = True
        return ring

    def _new_arrow(self) -> tuple[bpy.types.Gizmo, bpy.types.OperatorProperties]:
        arrow = new_gizmo(
            self, "GIZMO_GT_arrow_3d", draw_style="NORMAL", draw_options={"STEM"}, length=ARROW
        )
        paint(arrow, faded(palette.MOVE, 0.5))
        lift = arrow.target_set_operator(OperatorId.DRAG_PIN)
        lift.release_confirm = lift.whole = True
        lift.axis = "Z"
        return arrow, lift
