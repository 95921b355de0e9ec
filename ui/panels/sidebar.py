"""Bases and helpers of the sidebar's panels."""

import bpy

from ...bridge.accessors import present
from ...bridge.properties.options.result import HangtimeResultOptions
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.rows.kind import Icon, Row
from ...operators.names import CATEGORY, OperatorId
from ...operators.solve.common import chosen_armature
from ...operators.solve.session import session

# Operators whose work is told in the panel Solve, and beside a pin that was let go of.
OF_SOLVES = (
    OperatorId.ADAPT,
    OperatorId.UPDATE,
    OperatorId.REFINE,
    OperatorId.USE_BEST,
    OperatorId.FIT,
)
EMPTY_ROWS = 2  # as high as the buttons that fill a list


class SidebarPanel(bpy.types.Panel):
    """Base: a panel of the extension's tab. Drawing shows what is stored and computes nothing."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY


class ArmaturePanel(SidebarPanel):
    """Base: a panel about the chosen armature."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return chosen_armature(context) is not None


def settings_in(context: bpy.types.Context) -> HangtimeSettings:
    """The chosen armature's settings; a panel's poll has found that there is one."""
    return settings_of(present(chosen_armature(context)))


def split(panel: bpy.types.Panel) -> bpy.types.UILayout:
    """A panel's layout with labels left and values right, as in Blender's own panels."""
    layout = present(panel.layout)
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def optional(
    layout: bpy.types.UILayout,
    owner: HangtimeSettings | HangtimeResultOptions | Row,
    use: str,
    heading: str,
    *values: str,
) -> None:
    """Values in one line behind the tick `use` that switches them on."""
    line = layout.row(heading=heading)
    line.prop(owner, use, text="")
    fields = line.row(align=True)
    fields.active = getattr(owner, use)
    for value in values:
        fields.prop(owner, value, text="")


def lines(layout: bpy.types.UILayout, text: str, icon: Icon = "NONE") -> None:
    """Several lines of text, close together; the icon stands before the first."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    for index, line in enumerate(text.splitlines()):
        column.label(text=line, icon=icon if index == 0 or icon == "NONE" else "BLANK1")


def draw_list(
    layout: bpy.types.UILayout,
    kind: type[bpy.types.UIList],
    settings: HangtimeSettings,
    name: str,
    rows: int = 5,
) -> bpy.types.UILayout:
    """A list of the settings' collection of this name, low while it is empty; returns the column of
    buttons beside it."""
    rows = rows if len(getattr(settings, name)) else EMPTY_ROWS
    line = layout.row()
    line.use_property_split = False
    active = f"active_{name.removesuffix('s')}"
    line.template_list(kind.bl_idname, "", settings, name, settings, active, rows=rows)
    return line.column(align=True)


def draw_at_work(layout: bpy.types.UILayout, *of: str) -> bool:
    """While one of these operators is at work: how far, and a button to cancel; whether one is."""
    solving = session().solving
    if solving is None or solving.of not in of:
        return False
    row = layout.row(align=True)
    draw_grey(row, f"{solving.doing.capitalize()}, {100.0 * solving.share:.0f} %")
    row.operator(OperatorId.CANCEL, text="", icon="X")
    return True


def draw_grey(row: bpy.types.UILayout, text: str) -> None:
    """A button that does nothing, in the place of the one that was pressed.

    Of the button under the mouse Blender keeps the state while its operator is the same: the
    pressed one itself would stay grey afterwards. A progress bar would stay a bar.
    """
    grey = row.row(align=True)
    grey.enabled = False
    grey.operator(OperatorId.CANCEL, text=text)
