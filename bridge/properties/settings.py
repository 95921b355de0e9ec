"""What the extension stores in the artist's file: on the scene, on armatures and on actions.

Lengths are in Blender units, world; frames are the scene's; angles in rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import bpy

from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.problem import MassTable
from ..accessors import attached
from ..rows.row import CLASSES as ROW_CLASSES
from ..rows.row import (
    HIDDEN,
    OVERRIDABLE,
    OVERRIDABLE_LIST,
    HangtimeBoneMark,
    chosen,
    declared,
    hidden,
)
from ..rows.stored import angle, boolean, frame, number, position, target, text, vector, whole
from . import stances
from .body_change import CLASSES as BODY_CHANGE_CLASSES
from .body_change import HangtimeBodyChange
from .constraint import CLASSES as CONSTRAINT_CLASSES
from .constraint import HangtimeConstraint
from .keys import CLASSES as KEYS_CLASSES
from .keys import HangtimeKeys
from .loop import CLASSES as LOOP_CLASSES
from .loop import HangtimeLoop
from .result import CLASSES as RESULT_CLASSES
from .result import HangtimeResultOptions
from .surface import CLASSES as SURFACE_CLASSES
from .surface import HangtimeSurface, has_faces
from .view import CLASSES as VIEW_CLASSES
from .view import HangtimeView

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

    COMPUTED = ("place",)  # from what else is stored

    point: hidden(text())
    bone: hidden(text("Bone"))
    phase: hidden(text("Phase"))
    found_start: hidden(number())
    found_end: hidden(number())
    found_at: hidden(vector())
    at: hidden(vector())

    added: hidden(boolean())  # by the artist
    used: chosen(boolean("Touches", "Whether this contact counts; off removes it", default=True))
    start_frame: chosen(frame("Start", "Frame at which the point begins to carry"))
    end_frame: chosen(frame("End", "Frame at which the point ceases to carry"))
    place: chosen(
        position(
            "Place",
            "Where the point shall touch, in the world. Its whole stance moves along "
            "while Move Whole Stance is on",
            get=_get_place,
            set=_set_place,
        )
    )
    empty: chosen(target("Empty", "Where this empty is, the point shall touch", poll=_is_empty))
    on: chosen(
        target(
            "On",
            "The ground that the point stands on, vertically below or above its place; "
            "it must be among the surfaces. Dragging the pin there chooses it",
            poll=has_faces,
        )
    )


def _shift(axis: int, name: str, description: str) -> Any:
    """A stance's shift along one of its axes."""

    def get(stance: HangtimeStance) -> float:
        return float(stance.shifted[axis])

    def put(stance: HangtimeStance, to: float) -> None:
        shifted = list(stance.shifted)
        shifted[axis] = to
        stances.shift_stance(attached(stance.id_data), stance, shifted)

    options = {"unit": "LENGTH", "subtype": "DISTANCE", "step": 1}
    return chosen(number(name, description, get=get, set=put, **options))


def _get_turn(stance: HangtimeStance) -> float:
    return float(stance.turned)


def _set_turn(stance: HangtimeStance, to: float) -> None:
    stances.turn_stance(attached(stance.id_data), stance, to)


class HangtimeStance(bpy.types.PropertyGroup):
    """A stance, which is all contacts of a ground phase; `name` is the phase's ("ground 2")."""

    COMPUTED = ("forward", "left", "up", "turn")

    forward_axis: hidden(vector())
    shifted: hidden(vector())
    turned: hidden(number())

    forward: _shift(0, "Forward", "Move the stance along the jump's travel")
    left: _shift(1, "Left", "Move the stance to the left of the jump's travel")
    up: _shift(2, "Up", "Raise or lower the stance")
    turn: chosen(
        angle(
            "Turn",
            "Turn the stance about the vertical, counter-clockwise seen from above",
            get=_get_turn,
            set=_set_turn,
        )
    )


class HangtimePart(bpy.types.PropertyGroup):
    """A part of the body and the bone that moves it; `name` is the part ("left foot").

    found: the bone that was found by itself; another one in `bone` is the artist's choice.
    evidence: what told that it is this one, as of `Evidence`.
    """

    bone: chosen(text("Bone", "The bone that moves this part of the body"))
    found: hidden(text())
    evidence: hidden(text())
    needed: hidden(boolean())


class HangtimeSettings(bpy.types.PropertyGroup):
    """An armature's edit; of an empty that marks a contact, whose contact it marks."""

    marks: hidden(target(poll=_is_armature))

    mass: chosen(number("Mass (kg)", "The performer's mass", default=70.0, min=10.0, max=300.0))
    mass_table: bpy.props.EnumProperty(
        name="Mass Table",
        description="How the mass is shared among the parts of the body",
        items=[(table.name, *words) for table, words in _TABLES.items()],
        default=MassTable.THESIS.name,
        override=OVERRIDABLE,
    )
    measured_height: hidden(number())
    use_height: chosen(
        boolean("Own Height", "State the performer's height instead of the measured one")
    )
    height: chosen(
        number(
            "Height (m)",
            "The performer's true height; the physics takes place at this size",
            default=1.75,
            min=0.5,
            max=3.0,
        )
    )
    use_range: chosen(boolean("Frame Range", "Adapt some frames only instead of the whole action"))
    first_frame: chosen(whole("First", "First frame that counts", default=1))
    last_frame: chosen(whole("Last", "Last frame that counts", default=250))

    parts: bpy.props.CollectionProperty(type=HangtimePart, override=OVERRIDABLE_LIST)
    convention: hidden(text())  # by which the bones are named

    fit_quality: hidden(text())
    analysed: hidden(text())  # digest
    contacts: bpy.props.CollectionProperty(type=HangtimeContact, override=OVERRIDABLE_LIST)
    active_contact: hidden(whole())
    stances: bpy.props.CollectionProperty(type=HangtimeStance, override=OVERRIDABLE_LIST)
    whole_stance: chosen(
        boolean(
            "Move Whole Stance",
            "Moving a contact moves every contact of its phase, so that heels and toes "
            "stay as far apart as the feet are long",
            default=True,
        )
    )

    constraints: bpy.props.CollectionProperty(type=HangtimeConstraint, override=OVERRIDABLE_LIST)
    active_constraint: hidden(whole())
    surfaces: bpy.props.CollectionProperty(type=HangtimeSurface, override=OVERRIDABLE_LIST)
    active_surface: hidden(whole())
    body_changes: bpy.props.CollectionProperty(type=HangtimeBodyChange, override=OVERRIDABLE_LIST)
    active_body_change: hidden(whole())
    use_new_mass: chosen(
        boolean("Other Mass", "Perform the motion with another mass than the recording's")
    )
    new_mass: chosen(
        number("New Mass (kg)", "The new total mass", default=70.0, min=10.0, max=300.0)
    )
    gravity: chosen(
        number(
            "Gravity (m/s²)",
            "Of the place where the motion is performed; 1.62 m/s² on the Moon",
            default=STANDARD_GRAVITY,
            min=0.1,
            max=50.0,
            precision=3,
        )
    )

    requests: chosen(
        target(
            "Requests",
            "A text with limits, poses, torques, loads and whatever else a recipe may "
            "hold; see the manual's page of recipes",
            type=bpy.types.Text,
        )
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
    keep_times: chosen(
        boolean(
            "Keep Times",
            "Every phase lasts as long as recorded, where no Timing says otherwise. Else a jump to "
            "a landing that was moved takes the time, and is as big, as suits it",
        )
    )
    keep_out: chosen(
        boolean(
            "Keep Out",
            "Limbs keep out of each other, of the floor and of the surfaces, as far as they do in "
            "the recording",
            default=True,
        )
    )
    human_ranges: chosen(
        boolean(
            "Human Ranges",
            "Joints keep to what a person's can do, or to what they do in the recording where that "
            "is more. Off for a character that is no human",
            default=True,
        )
    )
    hard_ranges: chosen(
        boolean(
            "Hard",
            "No joint goes beyond its range; what asks for that is reported as not met. Else "
            "joints go beyond where nothing else meets what you ask for",
        )
    )
    wider_ranges: chosen(
        angle("Wider", "How much further than a person's joints may go", min=0.0, max=pi)
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
    stay_close: chosen(
        number(
            "Stay Close",
            "How much staying near the quick solution counts, beside what is lessened",
            default=1.0,
            min=0.0,
            soft_max=10.0,
        )
    )

    result: bpy.props.PointerProperty(type=HangtimeResultOptions, override=OVERRIDABLE)
    result_keys: bpy.props.PointerProperty(type=HangtimeKeys, override=OVERRIDABLE)
    loop: bpy.props.PointerProperty(type=HangtimeLoop, override=OVERRIDABLE)
    adapted: hidden(target(type=bpy.types.Action))
    source: hidden(target(type=bpy.types.Action))  # a result to start from; none: the recording
    status: hidden(text())


class HangtimeScene(bpy.types.PropertyGroup):
    """Which armature the sidebar is about, and what is shown of it."""

    view: declared(target(type=HangtimeView))
    snap: declared(
        boolean(
            "Snap to Surfaces",
            "While a contact is dragged it lands on the ground's faces; Ctrl lets go of them",
            default=True,
        )
    )

    armature: declared(
        target(
            "Armature",
            "The armature that carries the recording; the active one where none is chosen",
            poll=_is_armature,
        )
    )


class HangtimeAction(bpy.types.PropertyGroup):
    """Of an adapted action: the take that it was made from, how, and what was found.

    edit: what was asked for, and the artist's changes to that since. next_edit: of a take from
    which nothing is made yet. asked_key, take_key, own_key: digests of the settings, of the take's
    keys and of its own when it was made. spans: the frames of all adaptations that it holds.
    """

    recording: declared(target(type=bpy.types.Action), options=HIDDEN)
    edit: bpy.props.PointerProperty(type=HangtimeSettings, options=HIDDEN)
    next_edit: bpy.props.PointerProperty(type=HangtimeSettings, options=HIDDEN)
    asked_key: declared(text(), options=HIDDEN)
    take_key: declared(text(), options=HIDDEN)
    own_key: declared(text(), options=HIDDEN)
    spans: declared(text(), options=HIDDEN)
    stale: declared(text(), options=HIDDEN)  # why it is not what would be made now
    polished: declared(boolean(), options=HIDDEN)  # edited by hand since
    performer: declared(target(), options=HIDDEN)
    accepted: declared(boolean(), options=HIDDEN)
    report: declared(text(), options=HIDDEN)  # the report's text
    times: declared(text(), options=HIDDEN)  # its time map: recorded frames, adapted frames
    overlaps: declared(text(), options=HIDDEN)  # what is in what: of the recording, of itself


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
    *SURFACE_CLASSES,
    *VIEW_CLASSES,
    *RESULT_CLASSES,
    *KEYS_CLASSES,
    *LOOP_CLASSES,
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
