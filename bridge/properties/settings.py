"""What the extension stores in the artist's file: on the scene, on armatures and on actions.

Lengths are in Blender units, world; frames are the scene's; angles in rad.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.problem import MassTable
from ..accessors import attached
from ..rows.row import CLASSES as ROW_CLASSES
from ..rows.row import OVERRIDABLE, OVERRIDABLE_LIST, HangtimeBoneMark
from . import stances
from .body_change import CLASSES as BODY_CHANGE_CLASSES
from .body_change import HangtimeBodyChange
from .constraint import CLASSES as CONSTRAINT_CLASSES
from .constraint import HangtimeConstraint
from .view import CLASSES as VIEW_CLASSES
from .view import HangtimeView

_HIDDEN = {"HIDDEN"}
_TABLES = {
    MassTable.THESIS: ("Boxes", "Mass fractions of the thesis, each segment a uniform box"),
    MassTable.DE_LEVA: ("De Leva 1996", "Mass, centres and radii of gyration measured on men"),
}


def _is_armature(_owner: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return bool(candidate.type == "ARMATURE")


def _is_empty(_owner: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return bool(candidate.type == "EMPTY")


# Blender evaluates a class's annotations apart from this module's names, so that a lambda among
# them would not find any: callbacks are functions.


def _get_place(row: HangtimeContact) -> Sequence[float]:
    return tuple(row.at)


def _set_place(row: HangtimeContact, to: Sequence[float]) -> None:
    stances.place(attached(row.id_data), row, to)


class HangtimeContact(bpy.types.PropertyGroup):
    """A contact as it was found and as the artist wants it; `name` is its own ("Left heel 2")."""

    point: bpy.props.StringProperty(options=_HIDDEN, override=OVERRIDABLE)
    bone: bpy.props.StringProperty(name="Bone", options=_HIDDEN, override=OVERRIDABLE)
    phase: bpy.props.StringProperty(name="Phase", options=_HIDDEN, override=OVERRIDABLE)
    found_start: bpy.props.FloatProperty(options=_HIDDEN, override=OVERRIDABLE)
    found_end: bpy.props.FloatProperty(options=_HIDDEN, override=OVERRIDABLE)
    found_at: bpy.props.FloatVectorProperty(size=3, options=_HIDDEN, override=OVERRIDABLE)
    at: bpy.props.FloatVectorProperty(size=3, options=_HIDDEN, override=OVERRIDABLE)

    added: bpy.props.BoolProperty(options=_HIDDEN, override=OVERRIDABLE)  # by the artist
    used: bpy.props.BoolProperty(
        name="Touches",
        description="Whether this contact counts; off removes it",
        default=True,
        override=OVERRIDABLE,
    )
    start_frame: bpy.props.FloatProperty(
        name="Start",
        description="Frame at which the point begins to carry",
        precision=1,
        step=100,
        override=OVERRIDABLE,
    )
    end_frame: bpy.props.FloatProperty(
        name="End",
        description="Frame at which the point ceases to carry",
        precision=1,
        step=100,
        override=OVERRIDABLE,
    )
    place: bpy.props.FloatVectorProperty(
        name="Place",
        description="Where the point shall touch, in the world. Its whole stance moves along "
        "while Move Whole Stance is on",
        size=3,
        subtype="TRANSLATION",
        unit="LENGTH",
        get=_get_place,
        set=_set_place,
        override=OVERRIDABLE,
    )
    empty: bpy.props.PointerProperty(
        name="Empty",
        description="Where this empty is, the point shall touch",
        type=bpy.types.Object,
        poll=_is_empty,
        override=OVERRIDABLE,
    )


def _shift(axis: int) -> dict[str, object]:
    """Callbacks of a stance's shift along one of its axes."""

    def get(stance: HangtimeStance) -> float:
        return float(stance.shifted[axis])

    def put(stance: HangtimeStance, to: float) -> None:
        shifted = list(stance.shifted)
        shifted[axis] = to
        stances.shift_stance(attached(stance.id_data), stance, shifted)

    return {
        "get": get,
        "set": put,
        "unit": "LENGTH",
        "subtype": "DISTANCE",
        "step": 1,
        "override": OVERRIDABLE,
    }


def _get_turn(stance: HangtimeStance) -> float:
    return float(stance.turned)


def _set_turn(stance: HangtimeStance, to: float) -> None:
    stances.turn_stance(attached(stance.id_data), stance, to)


class HangtimeStance(bpy.types.PropertyGroup):
    """A stance, which is all contacts of a ground phase; `name` is the phase's ("ground 2")."""

    forward_axis: bpy.props.FloatVectorProperty(size=3, options=_HIDDEN, override=OVERRIDABLE)
    shifted: bpy.props.FloatVectorProperty(size=3, options=_HIDDEN, override=OVERRIDABLE)
    turned: bpy.props.FloatProperty(options=_HIDDEN, override=OVERRIDABLE)

    forward: bpy.props.FloatProperty(
        name="Forward", description="Move the stance along the jump's travel", **_shift(0)
    )
    left: bpy.props.FloatProperty(
        name="Left", description="Move the stance to the left of the jump's travel", **_shift(1)
    )
    up: bpy.props.FloatProperty(name="Up", description="Raise or lower the stance", **_shift(2))
    turn: bpy.props.FloatProperty(
        name="Turn",
        description="Turn the stance about the vertical, counter-clockwise seen from above",
        subtype="ANGLE",
        get=_get_turn,
        set=_set_turn,
        override=OVERRIDABLE,
    )


class HangtimePart(bpy.types.PropertyGroup):
    """A part of the body and the bone that moves it; `name` is the part ("left foot").

    found: the bone that was found by itself; another one in `bone` is the artist's choice.
    """

    bone: bpy.props.StringProperty(
        name="Bone", description="The bone that moves this part of the body", override=OVERRIDABLE
    )
    found: bpy.props.StringProperty(options=_HIDDEN, override=OVERRIDABLE)
    needed: bpy.props.BoolProperty(options=_HIDDEN, override=OVERRIDABLE)


class HangtimeSettings(bpy.types.PropertyGroup):
    """An armature's edit; of an empty that marks a contact, whose contact it marks."""

    marks: bpy.props.PointerProperty(
        type=bpy.types.Object, options=_HIDDEN, poll=_is_armature, override=OVERRIDABLE
    )

    mass: bpy.props.FloatProperty(
        name="Mass (kg)",
        description="The performer's mass",
        default=70.0,
        min=10.0,
        max=300.0,
        override=OVERRIDABLE,
    )
    mass_table: bpy.props.EnumProperty(
        name="Mass Table",
        description="How the mass is shared among the parts of the body",
        items=[(table.name, *words) for table, words in _TABLES.items()],
        default=MassTable.THESIS.name,
        override=OVERRIDABLE,
    )
    measured_height: bpy.props.FloatProperty(options=_HIDDEN, override=OVERRIDABLE)
    use_height: bpy.props.BoolProperty(
        name="Own Height",
        description="State the performer's height instead of the measured one",
        override=OVERRIDABLE,
    )
    height: bpy.props.FloatProperty(
        name="Height (m)",
        description="The performer's true height; the physics takes place at this size",
        default=1.75,
        min=0.5,
        max=3.0,
        override=OVERRIDABLE,
    )
    use_range: bpy.props.BoolProperty(
        name="Frame Range",
        description="Adapt some frames only instead of the whole action",
        override=OVERRIDABLE,
    )
    first_frame: bpy.props.IntProperty(
        name="First", description="First frame that counts", default=1, override=OVERRIDABLE
    )
    last_frame: bpy.props.IntProperty(
        name="Last", description="Last frame that counts", default=250, override=OVERRIDABLE
    )

    parts: bpy.props.CollectionProperty(type=HangtimePart, override=OVERRIDABLE_LIST)

    fit_quality: bpy.props.StringProperty(options=_HIDDEN, override=OVERRIDABLE)
    analysed: bpy.props.StringProperty(options=_HIDDEN, override=OVERRIDABLE)  # digest
    contacts: bpy.props.CollectionProperty(type=HangtimeContact, override=OVERRIDABLE_LIST)
    active_contact: bpy.props.IntProperty(options=_HIDDEN, override=OVERRIDABLE)
    stances: bpy.props.CollectionProperty(type=HangtimeStance, override=OVERRIDABLE_LIST)
    whole_stance: bpy.props.BoolProperty(
        name="Move Whole Stance",
        description="Moving a contact moves every contact of its phase, so that heels and toes "
        "stay as far apart as the feet are long",
        default=True,
        override=OVERRIDABLE,
    )

    constraints: bpy.props.CollectionProperty(type=HangtimeConstraint, override=OVERRIDABLE_LIST)
    active_constraint: bpy.props.IntProperty(options=_HIDDEN, override=OVERRIDABLE)
    body_changes: bpy.props.CollectionProperty(type=HangtimeBodyChange, override=OVERRIDABLE_LIST)
    active_body_change: bpy.props.IntProperty(options=_HIDDEN, override=OVERRIDABLE)
    use_new_mass: bpy.props.BoolProperty(
        name="Other Mass",
        description="Perform the motion with another mass than the recording's",
        override=OVERRIDABLE,
    )
    new_mass: bpy.props.FloatProperty(
        name="New Mass (kg)",
        default=70.0,
        min=10.0,
        max=300.0,
        description="The new total mass",
        override=OVERRIDABLE,
    )
    gravity: bpy.props.FloatProperty(
        name="Gravity (m/s²)",
        description="Of the place where the motion is performed; 1.62 m/s² on the Moon",
        default=STANDARD_GRAVITY,
        min=0.1,
        max=50.0,
        precision=3,
        override=OVERRIDABLE,
    )

    requests: bpy.props.PointerProperty(
        name="Requests",
        description="A text with limits, poses, torques, loads and whatever else a recipe may "
        "hold; see the manual's page of recipes",
        type=bpy.types.Text,
        override=OVERRIDABLE,
    )

    method: bpy.props.EnumProperty(
        name="Method",
        description="How the quick solution goes about it",
        items=[
            ("IMPLICIT", "Movement and Forces", "The nearest motion in shape and forces; fastest"),
            (
                "IMPLICIT_TORQUES",
                "Movement, Forces and Torques",
                "The nearest motion in shape, forces and the torques of all joints",
            ),
        ],
        override=OVERRIDABLE,
    )
    objective: bpy.props.EnumProperty(
        name="Lessen",
        description="What Refine lessens, beside staying close",
        items=[
            ("TORQUE_SMOOTHNESS", "Jerky Torques", "Muscles that change evenly"),
            ("TORQUE_OUTPUT", "Torque", "Muscles that work less hard"),
            ("POWER", "Power", "Less work in less time"),
            ("MASS_DISPLACEMENT", "Moved Mass", "Bodies stay nearer to where they were"),
            ("ANGLE_DISPLACEMENT", "Changed Pose", "Joints stay nearer to what they were"),
            ("ANGLE_SMOOTHNESS", "Jerky Joints", "Joints that move evenly"),
            ("TOTAL_CHANGE", "All Change", "Poses, torques and forces stay near the recording's"),
        ],
        override=OVERRIDABLE,
    )
    stay_close: bpy.props.FloatProperty(
        name="Stay Close",
        description="How much staying near the quick solution counts, beside what is lessened",
        default=1.0,
        min=0.0,
        soft_max=10.0,
        override=OVERRIDABLE,
    )

    adapted: bpy.props.PointerProperty(type=bpy.types.Action, options=_HIDDEN, override=OVERRIDABLE)
    status: bpy.props.StringProperty(options=_HIDDEN, override=OVERRIDABLE)


class HangtimeScene(bpy.types.PropertyGroup):
    """Which armature the sidebar is about, and what is shown of it."""

    view: bpy.props.PointerProperty(type=HangtimeView)

    armature: bpy.props.PointerProperty(
        name="Armature",
        description="The armature that carries the recording; the active one where none is chosen",
        type=bpy.types.Object,
        poll=_is_armature,
    )


class HangtimeAction(bpy.types.PropertyGroup):
    """Of an adapted action: the recording that it was made from, and what was found."""

    recording: bpy.props.PointerProperty(type=bpy.types.Action, options=_HIDDEN)
    performer: bpy.props.PointerProperty(type=bpy.types.Object, options=_HIDDEN)
    accepted: bpy.props.BoolProperty(options=_HIDDEN)
    report: bpy.props.StringProperty(options=_HIDDEN)  # the report's text


def settings_of(armature: bpy.types.Object) -> HangtimeSettings:
    """The edit that an armature carries, or what an empty marks."""
    settings: HangtimeSettings = attached(armature)
    return settings


def scene_settings(scene: bpy.types.Scene | None) -> HangtimeScene:
    """Of `context.scene`, which the stubs leave optional."""
    settings: HangtimeScene = attached(scene)
    return settings


def action_settings(action: bpy.types.Action) -> HangtimeAction:
    """Of an adapted action; empty for others."""
    settings: HangtimeAction = attached(action)
    return settings


CLASSES = (
    *ROW_CLASSES,
    *CONSTRAINT_CLASSES,
    *BODY_CHANGE_CLASSES,
    *VIEW_CLASSES,
    HangtimePart,
    HangtimeContact,
    HangtimeStance,
    HangtimeSettings,
    HangtimeScene,
    HangtimeAction,
)
CARRIERS = {
    bpy.types.Scene: HangtimeScene,
    bpy.types.Object: HangtimeSettings,
    bpy.types.Action: HangtimeAction,
    bpy.types.Bone: HangtimeBoneMark,
}
