"""A finding's remedy, switched on and off."""

from __future__ import annotations

import bpy

from ...solver.doctor.finding import FindingKind
from ...solver.doctor.stretch import CUTTING, cuts, longest_stretch
from ..accessors import present, shown_range
from ..armature.actions import recorded_action
from ..properties.settings import settings_of
from ..rows.finding import HangtimeFinding
from .placed_armature import repair
from .stored import applied, finding_of, findings, repairs_in


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
    if remedy.trims:
        _leave_out(armature, row, used=used)
        return
    repairs = applied(settings).without(remedy)
    repair(armature, repairs.without(rival).joined(remedy) if used else repairs)


def _leave_out(armature: bpy.types.Object, row: HangtimeFinding, *, used: bool) -> None:
    """Frames at the ends, by the frame range: of one that the artist chose the longest part without
    a fault is kept, else of all frames. A rest pose stays left out where what is after it is let in
    again."""
    settings = settings_of(armature)
    first, last = map(int, shown_range(armature, present(recorded_action(armature))))
    start, end = first, last
    if settings.use_range:
        start, end = settings.first_frame, settings.last_frame
    cutting = [each for each in map(finding_of, findings(settings)) if each.kind in CUTTING]
    rest = [each for each in cutting if each.kind is FindingKind.BIND_POSE]
    is_rest = row.name == FindingKind.BIND_POSE.value
    if used:
        spoilt = rest if is_rest else cutting
        inside = longest_stretch((start, end), spoilt)
        kept = inside if inside[0] < inside[1] else longest_stretch((first, last), spoilt)
        start, end = map(round, kept)
    else:
        left = (first, last) if is_rest else longest_stretch((first, last), rest)
        befores, afters = zip(*(cut for each in cutting for cut in cuts(each)), strict=True)
        start = round(left[0]) if start in afters else start
        end = round(left[1]) if end in befores else end
    settings.first_frame, settings.last_frame = start, end
    settings.use_range = (start, end) != (first, last)
