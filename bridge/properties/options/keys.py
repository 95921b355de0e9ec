"""Stored choice of the keys that a result gets."""

from __future__ import annotations

from math import radians

import bpy

from ...rows.choices import KeyChoice
from ...rows.row import OVERRIDABLE, chosen
from ...rows.stored import angle, number

_LABELS = {
    KeyChoice.EVERY_FRAME: ("Every Frame", "A key on every frame: exactly what was solved"),
    KeyChoice.REDUCED: (
        "Reduced",
        "The fewest Bézier keys that stay within the error, to be edited by hand",
    ),
    KeyChoice.TAKE: ("As the Take's", "Keys where the recording has them, however far that is off"),
}


class HangtimeKeys(bpy.types.PropertyGroup):
    """Keys of the results of an armature."""

    on: bpy.props.EnumProperty(
        name="Keys",
        description="Frames of the result that get keys",
        items=[(choice.name, *words) for choice, words in _LABELS.items()],
        default=KeyChoice.EVERY_FRAME.name,
        override=OVERRIDABLE,
    )
    distance: chosen(
        number(
            "Error (mm)",
            "How far reduced keys may move a joint at any frame, in the world",
            default=2.0,
            min=0.01,
            soft_max=20.0,
        )
    )
    angle: chosen(
        angle(
            "Angle",
            "How far reduced keys may turn a bone at any frame, in the world",
            default=radians(0.2),
            min=radians(0.001),
            soft_max=radians(5.0),
        )
    )


CLASSES = (HangtimeKeys,)
