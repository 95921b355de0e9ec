"""What the extension stores of each constraint: one class for all their kinds.

Lengths are in Blender units, world unless said otherwise; frames are the scene's; angles in rad.
What only some kinds store is declared by their modules (bridge/constraint_kinds).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..accessors import attached
from ..constraint_kinds import KINDS, stored_fields
from ..rows import phases
from ..rows.choices import Instant, Met, Span
from ..rows.row import ASKED, HIDDEN, OVERRIDABLE, OVERRIDABLE_LIST, HangtimeBone, items
from ..rows.stored import PropertyType, Stored

KIND_ITEMS = [(kind.name, kind.label, "", kind.number) for kind in KINDS.values()]


def _phases(row: HangtimeConstraint, _context: bpy.types.Context, _typed: str) -> tuple[str, ...]:
    return phases.names(attached(row.id_data))


class HangtimeConstraint(bpy.types.PropertyGroup):
    """A row of the constraints' list; `name` is the artist's, by which it is reported."""

    if TYPE_CHECKING:
        # The fields of its kind, see below.
        def __getattr__(self, name: str) -> Any: ...
        def __setattr__(self, name: str, value: Any) -> None: ...

    name: bpy.props.StringProperty(
        name="Name", description="Your name for it, by which it is reported", override=OVERRIDABLE
    )
    kind: bpy.props.EnumProperty(
        name="Kind", items=KIND_ITEMS, options=HIDDEN, override=OVERRIDABLE
    )
    used: bpy.props.BoolProperty(
        name="Use", description="Whether this counts", default=True, **ASKED
    )
    met: bpy.props.EnumProperty(name="Met", items=items(Met), options=HIDDEN, override=OVERRIDABLE)
    status: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)  # a line to be drawn

    # Whose: the first is what single-bone kinds are about.
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)

    # When.
    span: bpy.props.EnumProperty(
        name="When",
        description="During what it holds",
        items=items(Span),
        default=Span.ALWAYS.name,
        **ASKED,
    )
    phase: bpy.props.StringProperty(
        name="Phase",
        description="Phase of the clip, as Analyze named it, or a Hold",
        search=_phases,
        search_options={"SUGGESTION"},
        **ASKED,
    )
    instant: bpy.props.EnumProperty(
        name="At",
        description="Throughout the phase, or at one instant of it",
        items=items(Instant),
        **ASKED,
    )
    first_frame: bpy.props.FloatProperty(
        name="First",
        description="First frame at which it holds",
        precision=1,
        step=100,
        **ASKED,
    )
    last_frame: bpy.props.FloatProperty(
        name="Last",
        description="Last frame at which it holds",
        precision=1,
        step=100,
        **ASKED,
    )


def _property(stored: Stored) -> Any:
    """Blender's property of a declaration."""
    options = dict(stored.options)
    if stored.type is PropertyType.OBJECT:
        options["type"] = bpy.types.Object
    return getattr(bpy.props, stored.type.value)(**options, **ASKED)


# Blender reads a class's properties off its annotations.
HangtimeConstraint.__annotations__.update(
    {name: _property(stored) for name, stored in stored_fields().items()}
)

CLASSES = (HangtimeConstraint,)
