"""What the extension stores of each weight that is carried, each limb and shape that is changed."""

from __future__ import annotations

import bpy

from ..rows.choices import BodyKind, Through
from ..rows.row import (
    MET,
    NAME,
    OVERRIDABLE_LIST,
    STATUS,
    USED,
    HangtimeBone,
    asked,
    chosen,
    hidden,
)
from ..rows.stored import OFFSET, boolean, choice, number


class HangtimeBodyChange(bpy.types.PropertyGroup):
    """A row of the body changes' list; `name` is the artist's."""

    name: chosen(NAME)
    kind: hidden(choice("Kind", BodyKind))
    met: hidden(MET)
    status: hidden(STATUS)
    used: asked(USED)
    bones: bpy.props.CollectionProperty(type=HangtimeBone, override=OVERRIDABLE_LIST)
    by_share: asked(boolean("Share of the Body", "Give the weight as a share"))
    mass: asked(number("Mass (kg)", min=0.0, soft_max=100.0, default=10.0))
    share: asked(number("Share", subtype="FACTOR", min=0.0, soft_max=1.0, default=0.1))
    use_offset: asked(boolean("Custom Place", "Carry it elsewhere than at the bone's tail"))
    offset: asked(OFFSET)
    length: asked(number("Length", "Times as long", min=0.2, max=5.0, default=1.0))
    mass_factor: asked(number("Mass", "Times as heavy", min=0.1, max=10.0, default=1.0))
    thickness: asked(
        number(
            "Thickness", "Times as thick, where something meets it", min=0.05, max=5.0, default=1
        )
    )
    through: asked(
        choice(
            "Go Through",
            Through,
            "What these bones may go through: hair and cloth through everything, a hand and what "
            "it holds through each other",
        )
    )
    human: asked(
        boolean(
            "Human Ranges",
            "The joints of these bones keep to human ranges. Off for a tail, a hinge, a broken arm",
            default=True,
        )
    )


CLASSES = (HangtimeBodyChange,)
