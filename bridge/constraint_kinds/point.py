"""Point: a point of a bone is held at, or within bounds of, a place."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import TYPE_CHECKING

from ...solver.data.faults import AsksNothing
from ...solver.data.requests import Bound, PointAxes, PointRequest
from ..recipe_syntax.items import BONE, WHEN, Kind, vector
from ..recipe_syntax.points import ENVIRONMENT, PATH, POINT_AXES
from ..rows.kind import ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row
from ..rows.row_parts import RowContext, bone_of, direction_of, offset_of, ordered_bound, scaled
from ..rows.stored import OFFSET, Stored, boolean, booleans, choice, position, target, text
from ..rows.stored import vector as stored_vector
from ..rows.times import when_of

if TYPE_CHECKING:
    import bpy


class AxesLabel(Enum):
    """The axes of bounds, as the artist reads them; the names are PointAxes'."""

    WORLD = "World"
    TRAVEL = "Travel"
    SURFACE = "Surface"


AXIS_LABELS = {
    PointAxes.WORLD.name: ("X", "Y", "Z"),
    PointAxes.TRAVEL.name: ("Forward", "Left", "Up"),
    PointAxes.SURFACE.name: ("Along", "Across", "Out"),
}


USUAL_NORMAL = (0.0, 0.0, 1.0)
OWN, NOT_OWN = "OWN", "NOT_OWN"  # what is stored of the choice of Custom Normal


def _record(row: Row, context: RowContext) -> PointRequest:
    path = context.paths.get(row.name)
    own_place = row.use_place and path is None
    return PointRequest(
        row.name,
        bone_of(row, context),
        when_of(row, context.clip),
        offset=offset_of(row, context),
        place=scaled(row.place, context.metres) if own_place else None,
        path=path,
        axes=PointAxes[row.axes],
        normal=direction_of(row, row.normal) if _has_normal(row) else None,
        bounds=_bounds(row, context) if row.use_bounds else None,
        environment=row.environment,
        grip=row.environment and row.grip,
    )


def _has_normal(row: Row) -> bool:
    """Whether the artist says where the surface faces."""
    return _is_along_surface(row) or bool(row.environment and row.use_normal)


def _get_use_normal(row: Row) -> bool:
    """As chosen; files of earlier versions have the normal alone, which counted."""
    return bool(row.own_normal == OWN if row.own_normal else tuple(row.normal) != USUAL_NORMAL)


def _set_use_normal(row: Row, chosen: bool) -> None:
    row.own_normal = OWN if chosen else NOT_OWN


def _is_along_surface(row: Row) -> bool:
    return bool(row.use_bounds and row.axes == PointAxes.SURFACE.name)


def _bounds(row: Row, context: RowContext) -> tuple[Bound, Bound, Bound]:
    sides = zip(
        row.bound_axes, row.bound_below, row.bound_above, row.at_least, row.at_most, strict=True
    )
    x, y, z = (
        ordered_bound(
            row,
            context.metres * low if bounded and below else None,
            context.metres * high if bounded and above else None,
        )
        for bounded, below, above, low, high in sides
    )
    if (x, y, z) == ((None, None),) * 3:
        raise AsksNothing(row.name)
    return x, y, z


def _draw(fields: FieldDrawing, row: Row) -> None:
    layout = fields.layout
    fields.bone()
    layout.prop(row, "use_offset")
    if row.use_offset:
        layout.column(align=True).prop(row, "offset")
    layout.prop(row, "target")
    place = layout.column()
    place.active = row.target is None
    place.prop(row, "use_place")
    if row.use_place and row.target is None:
        place.column(align=True).prop(row, "place")
        fields.place_button(place)
    fields.when()
    layout.prop(row, "use_bounds")
    if row.use_bounds:
        _draw_bounds(layout, row)
    layout.prop(row, "environment")
    if row.environment:
        layout.prop(row, "grip")
        if not _is_along_surface(row):  # whose normal is shown above
            layout.prop(row, "use_normal")
            if row.use_normal:
                layout.column(align=True).prop(row, "normal")


def _draw_bounds(layout: bpy.types.UILayout, row: Row) -> None:
    layout.prop(row, "axes")
    if row.axes == PointAxes.SURFACE.name:
        layout.column(align=True).prop(row, "normal")
    table = layout.column(align=True)
    table.use_property_split = False
    head = table.row(align=True)
    for title in ("", "At Least", "At Most"):
        head.label(text=title)
    for axis, name in enumerate(AXIS_LABELS[row.axes]):
        line = table.row(align=True)
        line.prop(row, "bound_axes", index=axis, text=name, toggle=True)
        for use, value in (("bound_below", "at_least"), ("bound_above", "at_most")):
            cell = line.row(align=True)
            cell.active = row.bound_axes[axis]
            cell.prop(row, use, index=axis, text="")
            field = cell.row(align=True)
            field.active = getattr(row, use)[axis]
            field.prop(row, value, index=axis, text="")
    if not row.use_place and row.target is None and not row.environment:
        layout.label(text="From the floor and the world's origin", icon="INFO")


def put_where_shown(armature: bpy.types.Object, row: Row, *, keep_offset: bool = False) -> None:
    """Lets a point be at the place where it is shown now: the middle of its bone.

    keep_offset: where the artist chose the point in the bone, that one.
    """
    import bpy  # late: kinds load without Blender
    from mathutils import Vector

    graph = bpy.context.evaluated_depsgraph_get()
    posed = armature.evaluated_get(graph)
    assert posed.pose is not None
    bone = posed.pose.bones[row.bones[0].name]
    if not (keep_offset and row.use_offset):
        # Said as an offset, because the solver's own middle is that of the body, not of the bone.
        row.use_offset, row.offset = True, (0.0, 0.5 * bone.bone.length, 0.0)
    row.use_place = True
    row.place = posed.matrix_world @ bone.matrix @ Vector(row.offset)


def _added(armature: bpy.types.Object, row: Row, bones: Sequence[str]) -> None:
    if bones:
        put_where_shown(armature, row)


def _along_axes(name: str, description: str) -> Stored:
    return stored_vector(name, description, unit="LENGTH", subtype="XYZ")


KIND = ConstraintKind(
    name="POINT",
    number=0,
    label="Point",
    description="Hold a point of a bone at a place, or within bounds of one",
    icon="PINNED",
    menu=MenuGroup.POSES,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "point",
        PointRequest,
        (BONE, WHEN, vector("offset"), vector("place"), PATH, POINT_AXES, ENVIRONMENT),
        needs=(("bone",),),
        excludes=(("place", "path"),),
    ),
    range=NewRange.FRAME,
    added=_added,
    fields={
        "use_place": boolean(
            "Custom Place",
            "Hold the point at a place of yours instead of where the recording has it",
        ),
        "place": position("Place", "Where the point shall be, in the world"),
        "use_offset": boolean("Custom Point", "Choose the point of the bone instead of its middle"),
        "offset": OFFSET,
        "target": target("Target", "An object that the point follows, wherever it moves"),
        "environment": boolean(
            "Pushes Back",
            "Something is there that pushes back with a force, such as a bar or a wall",
        ),
        "grip": boolean("Grip", "It can be held on to, so that it pulls too"),
        "use_normal": boolean(
            "Custom Normal",
            "Say where what pushes back faces; else as the face of World that is there, or up",
            get=_get_use_normal,
            set=_set_use_normal,
        ),
        "own_normal": text(),  # chosen of `use_normal`; "": nothing yet
        "axes": choice("Axes", AxesLabel, "The axes of the bounds"),
        "normal": stored_vector(
            "Normal", "Out of the surface", subtype="DIRECTION", default=USUAL_NORMAL
        ),
        "use_bounds": boolean(
            "Bounds", "Keep the point within bounds about the place instead of exactly there"
        ),
        "bound_axes": booleans(
            "Bounded", "Along which axes the point is bounded; it is free along the others"
        ),
        "bound_below": booleans("Bounded Below", "Along which axes there is a least value"),
        "bound_above": booleans("Bounded Above", "Along which axes there is a greatest value"),
        "at_least": _along_axes("At Least", "Least distance from the place along each axis"),
        "at_most": _along_axes("At Most", "Greatest distance from the place along each axis"),
    },
)
