"""A finding's remedy, switched on and off."""

from __future__ import annotations

import bpy

from ..accessors import present, shown_range
from ..armature.actions import recorded_action
from ..properties.settings import settings_of
from ..rows.finding import HangtimeFinding
from .placed_armature import repair
from .stored import FRAMES, applied, repairs_in


def use_remedy(
    armature: bpy.types.Object, row: HangtimeFinding, *, used: bool, other: bool = False
) -> None:
    """Has a row's remedy count, or leaves it out again. other: its other one, in its stead."""
    settings = settings_of(armature)
    if row.mass:
        settings.mass = row.mass if used else row.amount
        return
    remedy, rival = repairs_in(row.remedy), repairs_in(row.other)
    if other:
        remedy, rival = rival, remedy
    if remedy.trim:
        _leave_out(armature, row, used=used)
        return
    repairs = applied(settings).without(remedy)
    repair(armature, repairs.without(rival).joined(remedy) if used else repairs)


def _leave_out(armature: bpy.types.Object, row: HangtimeFinding, *, used: bool) -> None:
    """Frames at the beginning, by the frame range."""
    settings = settings_of(armature)
    first, last = shown_range(armature, present(recorded_action(armature)))
    if used:
        if not settings.use_range:
            settings.last_frame = int(last)
        settings.first_frame = int(FRAMES.of(row.frames)[0][-1]) + 1
        settings.use_range = True
        return
    settings.first_frame = int(first)
    settings.use_range = settings.last_frame < int(last)
