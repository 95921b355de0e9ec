"""The list of body changes, and the other mass and gravity, as the solver's record of them."""

from __future__ import annotations

from collections.abc import Sequence

from ...solver.data.requests import AddedMass, BodyChange, LimbChange, Shape, Through
from ..properties.body_change import HangtimeBodyChange
from ..properties.settings import HangtimeSettings
from ..rows.choices import BodyKind
from ..rows.row_parts import RowContext, bone_of, offset_of, some_bones

GRAVITY_DIGITS = 4  # what single precision keeps of 9.81


def body_change(
    settings: HangtimeSettings, changes: Sequence[HangtimeBodyChange], context: RowContext
) -> BodyChange:
    """What of the body and of gravity shall be another. Raises NoBoneChosen, UnknownBone."""
    loads = [row for row in changes if row.kind == BodyKind.LOAD.name]
    # A limb that stays as it is would have the result written on an armature of its own.
    limbs = [row for row in changes if row.kind == BodyKind.LIMB.name and not leaves_limb(row)]
    return BodyChange(
        mass=settings.new_mass if settings.use_new_mass else None,
        gravity=round(settings.gravity, GRAVITY_DIGITS),
        added=tuple(_load(row, context) for row in loads),
        limbs=tuple(_limb(row, context) for row in limbs),
    )


def shapes_of(changes: Sequence[HangtimeBodyChange], context: RowContext) -> tuple[Shape, ...]:
    """What of solid shapes and of joints shall be another. Raises NoBoneChosen, UnknownBone."""
    return tuple(
        Shape(row.name, some_bones(row, context), row.thickness, Through[row.through], row.human)
        for row in changes
        if row.kind == BodyKind.SHAPE.name
    )


def leaves_limb(row: HangtimeBodyChange) -> bool:
    """Whether a row is about a limb that becomes no longer, shorter, heavier or lighter."""
    return bool(row.kind == BodyKind.LIMB.name and row.length == row.mass_factor == 1.0)


def _load(row: HangtimeBodyChange, context: RowContext) -> AddedMass:
    return AddedMass(
        row.name,
        bone_of(row, context),
        mass=None if row.by_share else row.mass,
        share=row.share if row.by_share else None,
        offset=offset_of(row, context),
    )


def _limb(row: HangtimeBodyChange, context: RowContext) -> LimbChange:
    return LimbChange(row.name, some_bones(row, context), row.length, row.mass_factor)
