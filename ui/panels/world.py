"""World: what is solid around the performer, and whether limbs keep out of it."""

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import HangtimeSettings, scene_settings
from ...bridge.properties.surface import HangtimeSurface
from ...bridge.rows.choices import SurfaceRole
from ...bridge.scene.members import is_gone
from ...operators.lists.offered_support import offered, sized
from ...operators.lists.row_lists import RowList
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from ...solver.data.solver_options import ShapeSource
from ..drawing.wrapping import wrapped
from .lists import MET_ICONS, SurfaceList
from .menus import AddSurfaceMenu
from .sidebar import ArmaturePanel, draw_list, lines, settings_in, split

GONE = "Not in the scene any more"
UNSEEN = "Something unseen carries the body"


class WorldPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_world"
    bl_label = "World"
    bl_order = 7

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = split(self), settings_in(context)
        side = draw_list(layout, SurfaceList, settings, "surfaces", rows=3)
        side.menu(AddSurfaceMenu.bl_idname, text="", icon="ADD")
        side.operator(OperatorId.REMOVE_SURFACE, text="", icon="REMOVE")
        side.separator()
        side.operator(OperatorId.SELECT_SURFACE, text="", icon="RESTRICT_SELECT_OFF")
        _draw_offer(layout, context)
        index = RowList.SURFACES.chosen(settings)
        if index >= 0:
            _draw_surface(layout, context, settings.surfaces[index])
        _draw_switches(layout, settings, context)


def _draw_offer(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """What would carry the body where the analysis found nothing that does."""
    offer = offered(chosen_armature(context))
    if offer:
        lines(layout, wrapped(context, UNSEEN), icon="QUESTION")
    if offer.boxes:
        text = f"Add Box Here ({', '.join(sized(box) for box in offer.boxes)})"
        layout.operator(OperatorId.ADD_SUPPORT_BOX, text=text, icon="MESH_CUBE")
    if offer.contacts:
        points = dict.fromkeys(contact.point for contact in offer.contacts)
        text = f"Let Them Touch ({', '.join(points)})"
        layout.operator(OperatorId.ADD_OFFERED_CONTACTS, text=text, icon="VIEW_PAN")
    if offer.holds:
        bones = dict.fromkeys(hold.bone for hold in offer.holds)
        layout.operator(
            OperatorId.ADD_HOLDS, text=f"Hold On Here ({', '.join(bones)})", icon="PINNED"
        )


def _draw_surface(
    layout: bpy.types.UILayout, context: bpy.types.Context, row: HangtimeSurface
) -> None:
    if is_gone(row, present(context.scene)):
        layout.label(text=GONE, icon="ERROR")
    elif row.status:
        lines(layout, wrapped(context, row.status), icon=MET_ICONS[row.met])
    layout.prop(row, "collection" if row.collection is not None else "object")
    roles = layout.row()
    roles.use_property_split = False  # beside a label "Obstacle" is cut off
    roles.prop(row, "role", expand=True)
    if row.role == SurfaceRole.CLEAR.name:
        layout.prop(row, "clearance")


def _draw_switches(
    layout: bpy.types.UILayout, settings: HangtimeSettings, context: bpy.types.Context
) -> None:
    layout.prop(settings, "keep_out")
    shapes = layout.column()
    shapes.active = settings.keep_out
    shapes.prop(settings, "shapes")
    if settings.shapes == ShapeSource.MESH.name and settings.shapes_told:
        lines(shapes, wrapped(context, settings.shapes_told, icons=0))
    layout.prop(scene_settings(context.scene), "snap")
