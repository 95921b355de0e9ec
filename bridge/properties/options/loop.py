"""Whether results repeat, and what carries them; with the armature."""

from __future__ import annotations

import bpy

from ...rows.choices import LoopRoot
from ...rows.row import OVERRIDABLE, chosen
from ...rows.stored import boolean

_LABELS = {
    LoopRoot.HIPS: ("Hips", "The hips travel; each repetition goes on from where the last ended"),
    LoopRoot.IN_PLACE: (
        "In Place",
        "The travel is left out at its mean speed, as games want it that move the character",
    ),
    LoopRoot.ROOT_BONE: (
        "Root Bone",
        "The topmost bone above the hips travels at the mean speed, and the body sways about it",
    ),
}


class HangtimeLoop(bpy.types.PropertyGroup):
    """Of the next analysis and results."""

    use: chosen(
        boolean(
            "Loop",
            "Make one cycle that repeats: pose, speed and force at its end are those at its start. "
            "Analyze moves the frame range to a whole cycle",
        )
    )
    root: bpy.props.EnumProperty(
        name="Travel",
        description="What carries the distance that a cycle covers",
        items=[(root.name, *words) for root, words in _LABELS.items()],
        default=LoopRoot.HIPS.name,
        override=OVERRIDABLE,
    )


CLASSES = (HangtimeLoop,)
