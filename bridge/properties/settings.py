"""What the extension stores in the artist's file: on the scene and on armatures.

Lengths are in Blender units, world; frames are the scene's; angles in rad.
"""

from __future__ import annotations

from math import pi

import bpy

from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.problem import MassTable
from ...solver.data.solver_options import ShapeSource
from ..accessors import attached
from ..rows.choices import Moves
from ..rows.finding import HangtimeFinding
from ..rows.row import HIDDEN, OVERRIDABLE, OVERRIDABLE_LIST, chosen, declared, hidden
from ..rows.stored import angle, boolean, choice, number, target, text, vector, whole
from . import stances
from .body_change import HangtimeBodyChange
from .constraint import HangtimeConstraint
from .contact import HangtimeContact, HangtimeStance
from .options.keys import HangtimeKeys
from .options.loop import HangtimeLoop
from .options.result import HangtimeResultOptions
from .surface import HangtimeSurface
from .view import HangtimeView

_TABLES = {
    MassTable.THESIS: ("Boxes", "Mass fractions of the thesis, each segment a uniform box"),
    MassTable.DE_LEVA: ("De Leva 1996", "Mass, centres and radii of gyration measured on men"),
}


def _is_armature(_owner: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return bool(candidate.type == "ARMATURE")


# Blender evaluates a class's annotations apart from this module's names, so that a lambda among
# them would not find any: callbacks are functions.


def _get_active_stance(settings: HangtimeSettings) -> int:
    return stances.active_stance_index(settings)


def _set_active_stance(settings: HangtimeSettings, index: int) -> None:
    stances.choose_stance(settings, index)


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

    COMPUTED = ("active_stance", "moves")  # from what else is stored

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
        boolean("Custom Height", "State the performer's height instead of the measured one")
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
    analysed_motion: hidden(text())  # its sketch; "" where no one kept it
    analysed_rate: hidden(number())  # frames/s of the scene then; 0 where no one kept it
    # First and last scene frame that were analysed; both 0 where no one kept them.
    analysed_span: hidden(vector(size=2))
    analysed_state: hidden(text())  # JSON: its parts, see bridge/repairs; "" where no one kept it
    # Names of its contacts, and the digest: lines. Without them an override could not tell its own
    # contacts from what was found in its library since.
    analysed_contacts: hidden(text())
    unseen: hidden(text())  # JSON: [first, last frame] of each span that something unseen carries
    repairs: hidden(text())  # JSON: those that count, see bridge/repairs
    findings: bpy.props.CollectionProperty(type=HangtimeFinding, override=OVERRIDABLE_LIST)
    examined: hidden(text())  # digest
    examination_stale: hidden(boolean())
    feet: hidden(text())  # JSON: the repairs that they were looked at with, and the feet's faults
    contacts: bpy.props.CollectionProperty(type=HangtimeContact, override=OVERRIDABLE_LIST)
    active_contact: hidden(whole("Contact", "Contact at work"))
    stances: bpy.props.CollectionProperty(type=HangtimeStance, override=OVERRIDABLE_LIST)
    active_stance: hidden(
        whole("Stance", "Stance at work", get=_get_active_stance, set=_set_active_stance)
    )
    # As `moves` was in earlier versions, whose files and scripts have it.
    whole_stance: hidden(boolean(default=True), update=stances.take_whole_stance)
    moving: hidden(text())  # chosen of `moves`; "": as of `whole_stance`
    moves: chosen(
        choice(
            "Moves",
            Moves,
            "What goes with a contact that is moved: nothing; its foot, heel and toe of one step; "
            "or its whole stance. Automatic: the foot of a step, as in a walk; of a landing or "
            "a take-off the whole stance",
            get=stances.get_moves,
            set=stances.set_moves,
        )
    )

    constraints: bpy.props.CollectionProperty(type=HangtimeConstraint, override=OVERRIDABLE_LIST)
    active_constraint: hidden(whole("Constraint", "Constraint at work"))
    surfaces: bpy.props.CollectionProperty(type=HangtimeSurface, override=OVERRIDABLE_LIST)
    active_surface: hidden(whole("Surface", "Surface at work"))
    body_changes: bpy.props.CollectionProperty(type=HangtimeBodyChange, override=OVERRIDABLE_LIST)
    active_body_change: hidden(whole("Body Change", "Body change at work"))
    use_new_mass: chosen(
        boolean("Other Mass", "Perform the motion with another mass than the recording's")
    )
    new_mass: chosen(
        number("New Mass (kg)", "The new total mass", default=70.0, min=10.0, max=300.0)
    )
    gravity: chosen(
        number(
            "Gravity (m/s²)",
            "Of the place where the motion is performed; 1.62 m/s² on the Moon. Forces are told in "
            "body weights on Earth all the same",
            default=STANDARD_GRAVITY,
            min=0.1,
            max=50.0,
            precision=3,
        )
    )

    requests: chosen(
        target(
            "Requests",
            "A text with limits, poses, torques, loads and whatever else a recipe may ask "
            "for beside what the panels have; see Recipes on the manual's page Scripting",
            type=bpy.types.Text,
        )
    )

    method: bpy.props.EnumProperty(
        name="Method",
        description="How the quick solution goes about it",
        items=[
            ("IMPLICIT", "Without Torques", "The nearest motion in shape and forces; fastest"),
            (
                "IMPLICIT_TORQUES",
                "With Torques",
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
    shapes: bpy.props.EnumProperty(
        name="Shapes",
        description="What the solid shapes of the body are made from",
        items=[
            (
                ShapeSource.MESH.name,
                "From the Mesh",
                "As thick as the mesh that the armature deforms, where there is one",
            ),
            (ShapeSource.BONES.name, "From the Bones", "As thick as mass and length make a person"),
        ],
        override=OVERRIDABLE,
    )
    shapes_told: hidden(text())  # what the last analysis found of the mesh
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
        name="Minimize",
        description="What Refine minimizes, beside staying close",
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
            "How much staying near the quick solution counts, beside what is minimized",
            default=1.0,
            min=0.0,
            soft_max=10.0,
        )
    )

    good_enough: chosen(
        number(
            "Good Enough (mm)",
            "A contact that no motion holds exactly may be off its place by this; the report tells "
            "by how much it is. One that is further off is let go",
            default=2.0,
            min=0.0,
            soft_max=10.0,
            max=100.0,
        )
    )

    result: bpy.props.PointerProperty(type=HangtimeResultOptions, override=OVERRIDABLE)
    result_keys: bpy.props.PointerProperty(type=HangtimeKeys, override=OVERRIDABLE)
    loop: bpy.props.PointerProperty(type=HangtimeLoop, override=OVERRIDABLE)
    adapted: hidden(target(type=bpy.types.Action))
    source: hidden(target(type=bpy.types.Action))  # a result to start from; none: the recording
    take_strips: hidden(text())  # JSON: the armature's, see marked_strips.py
    own_extrapolation: hidden(text())  # the artist's, of assigned actions, while a result has its
    status: hidden(text())


def _pin_active(scene: HangtimeScene, context: bpy.types.Context) -> None:
    """What is pinned is what the sidebar is about: the active armature, else the last one."""
    active = context.view_layer.objects.active if context.view_layer is not None else None
    if scene.pinned and active is not None and active.type == "ARMATURE":
        scene.armature = active


class HangtimeScene(bpy.types.PropertyGroup):
    """Which armature the sidebar is about, and what is shown of it.

    armature: the pinned one; else the one that was worked on last, which counts while no armature
    is active.
    """

    pinned: declared(
        boolean(
            "Pin",
            "Keep the sidebar on this armature, whichever one is active",
            update=_pin_active,
        )
    )
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
            "The armature that carries the recording",
            poll=_is_armature,
        )
    )
    own_end: declared(whole(), options=HIDDEN)  # its last frame before results made it longer
    lengthened_to: declared(whole(), options=HIDDEN)  # by them


def settings_of(armature: bpy.types.Object) -> HangtimeSettings:
    """The edit that an armature carries, or what an empty marks."""
    settings: HangtimeSettings = attached(armature)
    return settings


def scene_settings(scene: bpy.types.Scene | None) -> HangtimeScene:
    """Of `context.scene`, which the stubs leave optional."""
    settings: HangtimeScene = attached(scene)
    return settings
