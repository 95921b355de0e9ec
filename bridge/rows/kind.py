"""What a kind of constraint declares; each is one module of bridge/constraint_kinds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

from ...solver.data.contacts import phase_title
from ..recipe_syntax.items import Kind as RecipeKind
from .row_parts import RowContext
from .stored import Fields

if TYPE_CHECKING:
    import bpy

# A stored constraint, with the fields that all share and those of its kind.
Row = Any
# A name of Blender's icons, which its stubs spell out as a literal of a thousand.
Icon = Any


class BoneUse(Enum):
    """Which bones a constraint is about."""

    NONE = "none"
    ONE = "one"
    SEVERAL = "several"
    TOUCHING = "several, of those that touch"


class NewRange(Enum):
    """When a constraint holds that was just added at a frame."""

    PHASE = "in the phase, where one is known"
    PHASE_ALWAYS = "in a phase: it holds in no other way"
    FRAME = "at the frame"


class MenuGroup(Enum):
    """Groups of the menu that adds constraints, in its order."""

    POSES = "points, poses and orientations"
    JOINTS = "limits of joints"
    CONTACTS = "contacts"
    TIME = "time"


class FieldDrawing(Protocol):
    """The sidebar's side of drawing a row's fields."""

    @property
    def layout(self) -> bpy.types.UILayout: ...

    def bone(self) -> None:
        """The one bone that the row is about."""

    def bones(self, none: str) -> None:
        """All its bones; none: what it means that there are none."""

    def phase(self) -> None:
        """The phase that it is about."""

    def when(self) -> None:
        """When it holds."""

    def optional(self, layout: bpy.types.UILayout, use: str, value: str, heading: str) -> None:
        """A value behind a checkbox, in one line."""

    def place_button(self, layout: bpy.types.UILayout) -> None:
        """The button that puts a point where it is shown."""


def range_text(row: Row) -> str:
    """When a row holds, in a few letters."""
    texts = {
        "FRAME": lambda: f"{row.first_frame:.0f}",
        "FRAMES": lambda: f"{row.first_frame:.0f}–{row.last_frame:.0f}",
        "PHASE": lambda: str(row.phase),
    }
    return texts.get(row.span, str)()


def phase_text(row: Row) -> str:
    """The phase of a row that holds in no other way."""
    return str(row.phase)


def frame_text(row: Row) -> str:
    """The frame of a row that holds in no other way."""
    return f"{row.first_frame:.0f}"


def nothing_more(_armature: bpy.types.Object, _row: Row, _bones: Sequence[str]) -> None:
    """A row that was added stays as it is."""


@dataclass(frozen=True)
class ConstraintKind:
    """A kind of constraint: how it is stored, drawn, solved for and written in a recipe.

    name, number: stored in the artist's file; neither may ever change. label, description, icon:
    what the artist sees. draw: its fields, when and whose included. fields: stored for it beside
    the shared ones. short: of the label, for names of rows. on_ground: about the nearest stance,
    not the phase. told: when it holds, in a few letters. added: what else is set in a row that was
    just added.
    """

    name: str
    number: int
    label: str
    description: str
    icon: Icon
    menu: MenuGroup
    record: Callable[[Row, RowContext], Any]
    draw: Callable[[FieldDrawing, Row], None]
    recipe: RecipeKind[Any]
    fields: Fields = field(default_factory=dict)
    bones: BoneUse = BoneUse.ONE
    range: NewRange = NewRange.PHASE
    on_ground: bool = False
    short: str = ""
    told: Callable[[Row], str] = range_text
    added: Callable[[bpy.types.Object, Row, Sequence[str]], None] = nothing_more

    @property
    def requests(self) -> str:
        """The field of the solver's Requests that `record` adds to: the recipe header's plural."""
        return f"{self.recipe.header}s"

    def row_name(self, row: Row, bones: Sequence[str], titles: Callable[[str], str]) -> str:
        """What a new row is called, before a number makes that unique."""
        if len(bones) == 1 or (bones and self.bones is BoneUse.ONE):
            return f"{titles(bones[0])} {self.short or self.label}"
        if self.bones is BoneUse.NONE and self.range is NewRange.PHASE_ALWAYS and row.phase:
            return f"{phase_title(row.phase)} {self.label}"
        return self.label
