"""Handles of the chosen joint limit: its ends, and a cone's axis."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...operators.drag import rays
from ...operators.names import GizmoGroupId, OperatorId
from ..overlay.context.figure_cache import Figures
from ..overlay.context.view_context import Seen
from ..overlay.geometry import palette
from ..overlay.geometry.limit_shapes import seen_of
from ..overlay.layers.limits import chosen_limit, pose_of
from .places import Drawn, Knob, Places, Tip, places
from .shown import handled, knob, paint, put

ENDS = ("lower", "upper", "half_angle")


def handles(seen: Seen, figures: Figures, sight: rays.Vector) -> Places:
    """Of the limit that is chosen. sight: (3,) unit vector towards the viewer, world."""
    limit = chosen_limit(seen)
    if limit is None:
        return Places()
    figure = figures.of(seen, seen.recorded)
    joints, drawn = seen_of([limit], figure, pose_of(seen.armature, (limit,)))
    at = Drawn(drawn.axes[0], drawn.origins[0], joints.turns[0])
    return places(limit, at, np.array(seen.armature.matrix_world), sight)


class LimitHandles(bpy.types.GizmoGroup):
    bl_idname = GizmoGroupId.LIMITS
    bl_label = "Hangtime Joint Limits"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        seen = handled(context)
        return seen is not None and seen.view.limits and chosen_limit(seen) is not None

    def setup(self, _context: bpy.types.Context) -> None:
        self._figures = Figures()
        self._ends = {end: self._new(OperatorId.DRAG_LIMIT) for end in ENDS}
        for end, (_, drag) in self._ends.items():
            drag.end = end
        self._tip = self._new(OperatorId.AIM_CONE)

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """Blender calls this before each redraw; nothing else is told of undo or of scripts."""
        for gizmo, _ in (*self._ends.values(), self._tip):
            gizmo.hide = True
        seen = handled(context)
        if seen is None:
            return
        sight = context.region_data.view_rotation @ Vector((0.0, 0.0, 1.0))
        found = handles(seen, self._figures, np.array(sight))
        chosen = seen.settings.active_constraint
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
    put(gizmo, Vector(knob.at))
    circle = knob.circle
    drag.constraint, drag.narrow, drag.radius = chosen, knob.narrow, circle.radius
    drag.centre, drag.zero, drag.ahead = circle.centre, circle.zero, circle.ahead


def _show_tip(
    gizmo: bpy.types.Gizmo, aim: bpy.types.OperatorProperties, tip: Tip, chosen: int
) -> None:
    put(gizmo, Vector(tip.at))
    aim.constraint, aim.centre, aim.tip = chosen, tip.centre, tip.at
    aim.turn = Matrix(tip.turn.tolist())


CLASSES = (LimitHandles,)
