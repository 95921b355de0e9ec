"""Conditions under which handles are shown, and their looks."""

import bpy
from mathutils import Matrix, Vector

from ...bridge.accessors import current_action
from ...operators.solve.session import session
from ..drawing.editor import view_3d
from ..drawing.sketch import Colour
from ..overlay.context.redraw import view_now
from ..overlay.context.view_context import ViewContext
from ..overlay.geometry import palette

HIGHLIGHT: Colour = palette.WITHIN
KNOB = 0.1  # radius of a handle, as a share of the size of gizmos in the preferences


def handled(context: bpy.types.Context, switch: str) -> ViewContext | None:
    """The context that handles are shown in; None where nothing can be dragged now, or the switch
    of what they sit on is off."""
    space = view_3d(context)
    if space is None or not (space.show_gizmo and space.show_gizmo_context):
        return None
    if session().solving is not None:
        return None
    view = view_now(context)
    if view is None or view.armature.mode == "EDIT" or not view.armature.is_editable:
        return None
    due = getattr(view.options, switch) and current_action(view.armature) is not None
    return view if due else None


def new_gizmo(group: bpy.types.GizmoGroup, kind: str, **own: object) -> bpy.types.Gizmo:
    """A gizmo of a kind, with values of properties that only this kind has."""
    gizmo = group.gizmos.new(kind)
    for name, value in own.items():
        setattr(gizmo, name, value)
    return gizmo


def knob(group: bpy.types.GizmoGroup) -> bpy.types.Gizmo:
    """A disc that faces the viewer and has the same size on the screen wherever it is."""
    gizmo = new_gizmo(
        group, "GIZMO_GT_move_3d", draw_style="RING_2D", draw_options={"FILL_SELECT", "ALIGN_VIEW"}
    )
    gizmo.scale_basis = KNOB
    gizmo.line_width = 2.0
    return gizmo


def paint(gizmo: bpy.types.Gizmo, colour: Colour) -> None:
    """A new gizmo's looks: hidden until it is put somewhere; while dragged it stays to be seen."""
    gizmo.hide = True
    gizmo.use_draw_modal = True
    gizmo.color, gizmo.alpha = colour[:3], colour[3]
    gizmo.color_highlight, gizmo.alpha_highlight = HIGHLIGHT[:3], HIGHLIGHT[3]


def put(gizmo: bpy.types.Gizmo, at: Vector, size: float = 1.0) -> None:
    gizmo.matrix_basis = Matrix.Translation(at) @ Matrix.Scale(size, 4)
    gizmo.hide = False
