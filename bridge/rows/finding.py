"""What is wrong with a recording, as it was examined last; stored with the armature."""

from __future__ import annotations

import bpy

from .row import hidden
from .stored import boolean, number, text


class HangtimeFinding(bpy.types.PropertyGroup):
    """A finding; `name` is its kind's word.

    frames: JSON, [first, last] of each place. remedy, other: JSON of repairs (bridge/repairs), ""
    where there is none. mass: kg, that would fit the size; 0 where this is not about it. surplus: a
    linked row, which an override cannot drop, of what was not found.
    """

    amount: hidden(number())
    unit: hidden(text())
    frames: hidden(text())
    part: hidden(text())
    remedy: hidden(text())
    other: hidden(text())
    mass: hidden(number())
    surplus: hidden(boolean())

    def let_go(self) -> None:
        """Have it count for nothing."""
        self.surplus = True


CLASSES = (HangtimeFinding,)
