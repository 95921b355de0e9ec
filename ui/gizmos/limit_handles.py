"""Handles of the chosen joint limit: its ends, and a cone's axis."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...bridge.accessors import present
from ...operators.drag import rays
from ...operators.names import OperatorId
from ..drawing.cache import ContentCache
from ..overlay.context.figure_cache import FigureCache
from ..overlay.context.view_context import ViewContext
from ..overlay.geometry import palette
from ..overlay.geometry.limit_shapes import limit_frames
from ..overlay.layers.limits import chosen_limit, chosen_row, limit_pose, posed_bones
from .places import Knob, LimitHandlePlaces, Tip, handle_places
from .shown import handled, knob, paint, put

ENDS = ("lower", "upper", "half_angle")


class PlaceCache:
    """Places of handles, worked out again where what they depend on has changed."""

    def __init__(self) -> None:
        self._figures = FigureCache()
        self._cache: ContentCache[LimitHandlePlaces] = ContentCache()

    def of(self, view: ViewContext, sight: rays.Vector) -> LimitHandlePlaces:
        """Of the limit that is chosen. sight: (3,) unit vector towards the viewer, world."""
        limit = chosen_limit(view)
        if limit is None:
            return LimitHandlePlaces()
        stands, shown = np.array(view.armature.matrix_world, float), view.recorded
        pose, key = posed_bones(view.armature).tobytes(), shown.key if shown is not None else None
        content = view.armature.name_full, limit, pose, stands.tobytes(), sight.tobytes(), key

        def places() -> LimitHandlePlaces:
            figure = self._figures.of(view, shown)
            placed = limit_frames([limit], figure, limit_pose(view.armature, (limit,)))
            return handle_places(limit, *placed, stands, sight)

        return self._cache.get("handles", content, places)


class LimitHandles(bpy.types.GizmoGroup):
    bl_idname = "HANGTIME_GGT_limits"
    bl_label = "Hangtime Joint Limits"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D", "PERSISTENT"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Blender asks several times a redraw: whether there is a limit, not where."""
        view = handled(context)
        return view is not None and view.options.limits and chosen_row(view.settings) is not None

    def setup(self, _context: bpy.types.Context) -> None:
        self._places = PlaceCache()
        self._ends = {end: self._new(OperatorId.DRAG_LIMIT) for end in ENDS}
        for end, (_, drag) in self._ends.items():
            drag.end = end
        self._tip = self._new(OperatorId.AIM_CONE)

    def draw_prepare(self, context: bpy.types.Context) -> None:
        """Blender calls this before each redraw; nothing else is told of undo or of scripts."""
        for gizmo, _ in (*self._ends.values(), self._tip):
            gizmo.hide = True
        view = handled(context)
        if view is None:
            return
        sight = present(context.region_data).view_rotation @ Vector((0.0, 0.0, 1.0))
        found = self._places.of(view, np.array(sight))
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
