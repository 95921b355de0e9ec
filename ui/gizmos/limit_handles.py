"""Handles of the chosen joint limit: its ends, and a cone's axis."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...bridge.accessors import present
from ...operators.drag import rays
from ...operators.names import OperatorId
from ..overlay.context.figure_cache import FigureCache
from ..overlay.context.view_context import ViewContext
from ..overlay.geometry import palette
from ..overlay.geometry.limit_shapes import limit_frames
from ..overlay.layers.limits import chosen_limit, limit_pose
from .places import Knob, LimitHandlePlaces, Tip, handle_places
from .shown import handled, knob, paint, put

ENDS = ("lower", "upper", "half_angle")


def chosen_places(view: ViewContext, figures: FigureCache, sight: rays.Vector) -> LimitHandlePlaces:
    """Handles of the limit that is chosen. sight: (3,) unit vector towards the viewer, world."""
    limit = chosen_limit(view)
    if limit is None:
        return LimitHandlePlaces()
    pose = limit_pose(view.armature, (limit,))
    placed = limit_frames([limit], figures.of(view, view.recorded), pose)
    return handle_places(limit, *placed, np.array(view.armature.matrix_world, float), sight)


class LimitHandles(bpy.types.GizmoGroup):
    bl_idname = "HANGTIME_GGT_limits"
    bl_label = "Hangtime Joint Limits"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT"}

    def setup(self, _context: bpy.types.Context) -> None:
        self._figures = FigureCache()
        self._state: object = None  # that they were put by
        self._ends = {end: self._new(OperatorId.DRAG_LIMIT) for end in ENDS}
        for end, (_, drag) in self._ends.items():
            drag.end = end
        self._tip = self._new(OperatorId.AIM_CONE)

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """As that of PinHandles."""
        view = handled(context, "limits")
        sight = present(context.region_data).view_rotation @ Vector((0.0, 0.0, 1.0))
        state = (view.state, sight) if view is not None else None
        if state == self._state:
            return
        self._state = state
        for gizmo, _ in (*self._ends.values(), self._tip):
            gizmo.hide = True
        if view is None:
            return
        found = chosen_places(view, self._figures, np.array(sight))
        chosen = view.settings.active_constraint
        for each in found.knobs:
            _show_knob(*self._ends[each.end], each, chosen)
        if found.tip is not None:
            _show_tip(*self._tip, found.tip, chosen)

    def _new(self, operator: OperatorId) -> tuple[bpy.types.Gizmo, bpy.types.OperatorProperties]:
        gizmo = knob(self)
        paint(gizmo, palette.LIMIT)
        return gizmo, gizmo.target_set_operator(operator)


def _show_knob(
    gizmo: bpy.types.Gizmo, drag: bpy.types.OperatorProperties, knob: Knob, chosen: int
) -> None:
    put(gizmo, Vector(knob.at.tolist()))
    circle = knob.circle
    drag.constraint, drag.narrow, drag.radius = chosen, knob.narrow, circle.radius
    drag.centre, drag.zero, drag.ahead = circle.centre, circle.zero, circle.ahead


def _show_tip(
    gizmo: bpy.types.Gizmo, aim: bpy.types.OperatorProperties, tip: Tip, chosen: int
) -> None:
    put(gizmo, Vector(tip.at.tolist()))
    aim.constraint, aim.centre, aim.tip = chosen, tip.centre, tip.at
    aim.turn = Matrix(tip.turn.tolist())
