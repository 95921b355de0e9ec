"""When handles are shown at all, and how they look."""

from __future__ import annotations

import bpy
from mathutils import Matrix, Vector

from ...bridge.accessors import current_action
from ...operators.solve.session import session
from ..overlay.context.view_context import Seen, look_at
from ..overlay.geometry import palette
from ..overlay.geometry.shapes import Colour

HIGHLIGHT: Colour = palette.WITHIN
KNOB = 0.1  # radius of a handle, as a share of the size of gizmos in the preferences


def handled(context: bpy.types.Context) -> Seen | None:
    """What the viewport shows; None where nothing can be dragged now."""
    space = context.space_data
    if space is None or space.type != "VIEW_3D":
        return None
    if not (space.show_gizmo and space.show_gizmo_context) or session().solving is not None:
        return None
    seen = look_at(context)
    if seen is None or seen.armature.mode == "EDIT" or not seen.armature.is_editable:
        return None
    return seen if current_action(seen.armature) is not None else None


def knob(group: bpy.types.GizmoGroup) -> bpy.types.Gizmo:
    """A disc that faces the viewer and has the same size on the screen wherever it is."""
    gizmo = group.gizmos.new("GIZMO_GT_move_3d")
    gizmo.draw_style = "RING_2D"
    gizmo.draw_options = {"FILL_SELECT", "ALIGN_VIEW"}
    gizmo.scale_basis = KNOB
    gizmo.line_width = 2.0
    return gizmo


def paint(gizmo: bpy.types.Gizmo, colour: Colour) -> None:
    """It stays to be seen while it is dragged."""
    gizmo.use_draw_modal = True
    gizmo.color, gizmo.alpha = colour[:3], colour[3]
    gizmo.color_highlight, gizmo.alpha_highlight = HIGHLIGHT[:3], HIGHLIGHT[3]


def put(gizmo: bpy.types.Gizmo, at: Vector, size: float = 1.0) -> None:
    gizmo.matrix_basis = Matrix.Translation(at) @ Matrix.Scale(size, 4)
    gizmo.hide = False
