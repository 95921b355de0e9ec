"""Adding, copying and aiming rows of the lists of constraints and of body changes.

Works on the property groups of bridge/properties/constraint.py; frames are the scene's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy

from ...solver.body.anatomy import Side, split_side
from ..properties.body_change import HangtimeBodyChange
from ..properties.constraint import HangtimeConstraint
from ..properties.settings import HangtimeSettings, settings_of
from ..rows.choices import BodyKind, Span
from ..rows.kind import BoneUse, ConstraintKind, NewRange
from ..rows.phases import PhaseSpan, listed, phases_of

AROUND = 5  # frames to either side of the playhead, where no phase is known


def add_constraint(
    armature: bpy.types.Object, kind: ConstraintKind, bones: Sequence[str], frame: float
) -> HangtimeConstraint:
    """A new row at the end of the list, chosen, about these bones and about when `frame` is.

    A point is to be where it is shown now. Bones that cannot count for the kind are left out.
    """
    settings = settings_of(armature)
    row: HangtimeConstraint = settings.constraints.add()
    row.kind = kind.name
    if kind.bones is BoneUse.TOUCHING:
        touching = {contact.bone for contact in listed(settings)}
        bones = [bone for bone in bones if bone in touching]
    if kind.bones is BoneUse.NONE:
        bones = ()
    set_bones(row, bones)
    if kind.bones is BoneUse.ONE and not bones:
        row.bones.add()  # to be chosen
    aim_at(settings, row, kind, frame)
    row.name = free_name(settings, kind.row_name(row, bones, title))
    kind.added(armature, row, bones)
    settings.active_constraint = len(settings.constraints) - 1
    return row


def add_body_change(
    settings: HangtimeSettings, kind: BodyKind, bones: Sequence[str]
) -> HangtimeBodyChange:
    """A new row at the end of the list, chosen."""
    row: HangtimeBodyChange = settings.body_changes.add()
    row.kind = kind.name
    set_bones(row, bones)
    if not bones:
        row.bones.add()
    of = f"{title(bones[0])} " if len(bones) == 1 else ""
    row.name = free_name(settings, f"{of}{_changed(kind, one=bool(of))}")
    settings.active_body_change = len(settings.body_changes) - 1
    return row


def _changed(kind: BodyKind, *, one: bool) -> str:
    """What a row changes, of one bone or of several."""
    match kind:
        case BodyKind.LOAD:
            return "Weight"
        case BodyKind.LIMB:
            return "Length" if one else "Limb"
        case BodyKind.SHAPE:
            return "Shape"


def set_bones(row: HangtimeConstraint | HangtimeBodyChange, bones: Iterable[str]) -> None:
    """Makes a row about these bones."""
    row.bones.clear()
    for bone in bones:
        row.bones.add().name = bone


def free_name(settings: HangtimeSettings, wanted: str) -> str:
    """The name, with a number where a constraint, body change or contact has it already."""
    lists = (settings.constraints, settings.body_changes, listed(settings))
    taken = {row.name for rows in lists for row in rows}
    name, number = wanted, 1
    while name in taken:
        number += 1
        name = f"{wanted} {number}"
    return name


def title(bone: str) -> str:
    """A bone's name for people: "mixamorig:LeftHand" and "hand.L" are the left hand."""
    side, word = split_side(bone)
    if side is Side.MIDDLE:
        return bone.rpartition(":")[2].replace("_", " ")
    return f"{side.value} {word}".title()


# ---------------------------------------------------------------- when


def aim_at(
    settings: HangtimeSettings, row: HangtimeConstraint, kind: ConstraintKind, frame: float
) -> None:
    """Lets a row hold about when `frame` is: then alone, in its phase, or some frames around."""
    phases = phases_of(settings)
    phase = _ground_near(phases, frame) if kind.on_ground else phase_at(phases, frame)
    row.first_frame, row.last_frame = frame - AROUND, frame + AROUND
    row.pose_frame = frame
    row.phase = phase.name if phase is not None else ""
    if kind.range is NewRange.FRAME:
        row.span, row.first_frame = Span.FRAME.name, frame
    elif phase is not None or kind.range is NewRange.PHASE_ALWAYS:
        row.span = Span.PHASE.name
    else:
        row.span = Span.FRAMES.name


def phase_at(phases: Iterable[PhaseSpan], frame: float) -> PhaseSpan | None:
    """The phase at a scene frame, the later one where two meet."""
    return next((p for p in reversed(tuple(phases)) if p.start <= frame <= p.end), None)


def _ground_near(phases: Iterable[PhaseSpan], frame: float) -> PhaseSpan | None:
    ground = [p for p in phases if p.is_ground]
    return min(ground, key=lambda p: max(p.start - frame, frame - p.end, 0.0), default=None)


def hold_during(row: HangtimeConstraint, first: float, last: float) -> None:
    """Lets a row hold from frame to frame, or at one where they are the same."""
    row.first_frame, row.last_frame = first, last
    row.span = Span.FRAME.name if first == last else Span.FRAMES.name


def hold_in(row: HangtimeConstraint, phase: str) -> None:
    """Lets a row hold during a phase."""
    row.span, row.phase = Span.PHASE.name, phase


def hold_throughout(row: HangtimeConstraint) -> None:
    """Lets a row hold during the whole clip."""
    row.span = Span.ALWAYS.name


# ---------------------------------------------------------------- copies


def copy_row(
    row: HangtimeConstraint | HangtimeBodyChange, to: HangtimeConstraint | HangtimeBodyChange
) -> None:
    """Makes `to` ask for the same as `row`, under its own name."""
    computed = ("rna_type", "name", "bones", "met", "status")
    for prop in row.bl_rna.properties:
        if prop.identifier not in computed and not prop.is_readonly:
            setattr(to, prop.identifier, getattr(row, prop.identifier))
    set_bones(to, [bone.name for bone in row.bones])
