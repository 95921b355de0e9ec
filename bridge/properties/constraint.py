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
from ..rows.choices import Instant, Span
from ..rows.row import (
    HIDDEN,
    MET,
    NAME,
    OVERRIDABLE,
    OVERRIDABLE_LIST,
    STATUS,
    USED,
    HangtimeBone,
    asked,
    chosen,
    hidden,
)
from ..rows.stored import choice, frame, text

KIND_ITEMS = [(kind.name, kind.label, "", kind.number) for kind in KINDS.values()]


def _phases(
    row: HangtimeConstraint, _context: bpy.types.Context, _typed: str
) -> tuple[str | tuple[str, str], ...]:
    """Their names; of stances with what they are called in the list of contacts."""
    settings = attached(row.id_data)
    called = phases.roles(settings)
    names = phases.names(settings)
    return tuple((name, called[name]) if name in called else name for name in names)


class HangtimeConstraint(bpy.types.PropertyGroup):
    """A row of the constraints' list; `name` is the artist's, by which it is reported."""

    if TYPE_CHECKING:
        # The fields of its kind, see below.
        def __getattr__(self, name: str) -> Any: ...
        def __setattr__(self, name: str, value: Any) -> None: ...

    COMPUTED = ("use_normal",)  # from what else is stored

    name: chosen(NAME)
    kind: bpy.props.EnumProperty(
        name="Kind", items=KIND_ITEMS, options=HIDDEN, override=OVERRIDABLE
    )
    used: asked(USED)
    met: hidden(MET)
    status: hidden(STATUS)

    # Whose: the first is what single-bone kinds are about.
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)

    # When.
    span: asked(choice("When", Span, "During what it holds", default=Span.ALWAYS.name))
    phase: asked(
        text(
            "Phase",
            "Phase of the clip, as Analyze named it, or a Hold",
            search=_phases,
            search_options={"SUGGESTION"},
        )
    )
    instant: asked(choice("At", Instant, "Throughout the phase, or at one instant of it"))
    first_frame: asked(frame("First", "First frame at which it holds"))
    last_frame: asked(frame("Last", "Last frame at which it holds"))


# Blender reads a class's properties off its annotations.
HangtimeConstraint.__annotations__.update(
    {name: asked(stored) for name, stored in stored_fields().items()}
)

CLASSES = (HangtimeConstraint,)
