"""Contacts and held points as red balls; hollow where nothing pushes back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from mathutils import Matrix, Vector

from ....bridge.constraint_kinds import point
from ....bridge.constraints.motion_problem import moved
from ....bridge.rows.times import Frames
from ....solver.data.requests import PointAxes
from ..context.layer import Layer, Part
from ..context.view_context import Seen, Shown, holds
from ..geometry import palette
from ..geometry.pin_shapes import Box, Pin, shapes
from ..geometry.shapes import Label, Standing

if TYPE_CHECKING:
    from ....bridge.properties.constraint import HangtimeConstraint
    from ....bridge.properties.settings import HangtimeContact

REACH = 0.25  # m, how far a box is drawn along an axis that is not bounded
ABOVE = 0.12  # m, of a stance's words
SHIFTED = 1e-3  # Blender units


def contacts(seen: Seen) -> Layer:
    """Where the body touches, in the world."""
    chosen = seen.settings.active_contact
    pins = tuple(_contact(seen, r, i == chosen) for i, r in enumerate(seen.settings.contacts))
    labels = tuple(_labels(seen))
    content = pins, labels, seen.units
    return Layer(Part.CONTACTS, content, lambda: (*shapes(pins, seen.units), *labels))


def _contact(seen: Seen, row: HangtimeContact, chosen: bool) -> Pin:
    found = tuple(row.found_at) if moved(row) else None
    return Pin(tuple(row.at), _standing_of(row, seen.frame), False, chosen, found)


def _standing_of(row: HangtimeContact, frame: float) -> Standing:
    if not row.used:
        return Standing.OFF
    return Standing.NOW if row.start_frame <= frame <= row.end_frame else Standing.LATER


def _labels(seen: Seen) -> Iterator[Label]:
    """How far each stance has been moved."""
    for stance in seen.settings.stances:
        shift = Vector(stance.shifted).length
        if shift <= SHIFTED:
            continue
        places = [Vector(c.at) for c in seen.settings.contacts if c.phase == stance.name and c.used]
        if places:
            middle = sum(places, Vector()) / len(places)
            words = f"{stance.name}: {shift * seen.metres:.2f} m"
            middle.z += ABOVE * seen.units
            yield Label(words, tuple(middle), palette.MOVE)


def points(seen: Seen) -> Layer:
    """The points that constraints hold, in the world."""
    rows = seen.rows(point.KIND.name)
    pins = tuple(pin for row, chosen in rows for pin in _point(seen, row, chosen))
    return Layer(Part.POINTS, (pins, seen.units), lambda: shapes(pins, seen.units))


def _point(seen: Seen, row: HangtimeConstraint, chosen: bool) -> Iterator[Pin]:
    span = seen.span(row)
    recorded = _recorded_place(seen, row, span)
    place = _place(row, recorded)
    if place is None:
        return
    standing = Standing.NOW if holds(span, seen.frame) else Standing.LATER
    box = _box(seen, row, place) if row.use_bounds else None
    # bounds hold a point in no one place that it could have been moved to
    found = recorded if row.use_place and not row.use_bounds else None
    yield Pin(
        tuple(place),
        standing if row.used else Standing.OFF,
        hollow=not row.environment or row.use_bounds,
        chosen=chosen,
        found=tuple(found) if found is not None else None,
        box=box,
    )


def _place(row: HangtimeConstraint, recorded: Vector | None) -> Vector | None:
    if row.target is not None:
        return row.target.matrix_world.translation
    return Vector(row.place) if row.use_place else recorded


def _recorded_place(seen: Seen, row: HangtimeConstraint, span: Frames) -> Vector | None:
    """Where the recording has a point: at this frame, or on average where something is there."""
    bone, shown = seen.bone(row), seen.recorded
    if bone is None:
        return None
    matrix = seen.armature.matrix_world @ bone.matrix
    middle = matrix @ Vector((0.0, 0.5 * bone.length, 0.0))
    at = matrix @ Vector(row.offset) if row.use_offset else middle
    if shown is None or bone.name not in shown.traces.bones:
        return at
    return _traced(shown, bone.name, seen.frame, span, mean=row.environment) + (at - middle)


def _traced(shown: Shown, bone: str, frame: float, span: Frames, *, mean: bool) -> Vector:
    """The middle of a bone at the instant of its span that is nearest to a frame."""
    traces = shown.traces
    body, frames = traces.bones.index(bone), traces.frames
    first, last = max(span[0], frames[0]), min(span[1], frames[-1])
    start, end, now = np.searchsorted(frames, (first, last, min(max(frame, first), last)))
    final = len(frames) - 1
    if mean and start <= min(end, final):
        when = slice(start, end + 1)
        middle = 0.5 * (traces.heads[when, body] + traces.tails[when, body]).mean(axis=0)
    else:
        middle = 0.5 * (traces.heads[min(now, final), body] + traces.tails[min(now, final), body])
    return shown.matrix @ Vector(middle)


def _box(seen: Seen, row: HangtimeConstraint, place: Vector) -> Box:
    """Bounds about a place; without one of its own they count from the world's origin and floor."""
    reach = REACH * seen.units
    own = row.use_place or row.target is not None or row.environment
    zero = Vector() if own else Vector((0.0, 0.0, _floor(seen))) - place
    flags = zip(row.bound_axes, row.bound_below, row.bound_above, strict=True)
    ends = [
        _ends(low + z if on and below else None, high + z if on and above else None, reach)
        for z, low, high, (on, below, above) in zip(
            zero, row.at_least, row.at_most, flags, strict=True
        )
    ]
    return Box(_axes(seen, row), *zip(*ends, strict=True))


def _ends(low: float | None, high: float | None, reach: float) -> tuple[float, float]:
    """From where to where a box is drawn that may be open."""
    if low is None and high is None:
        return -reach, reach
    if low is None:
        return high - reach, high
    return low, low + reach if high is None else high


def _floor(seen: Seen) -> float:
    return min((row.found_at[2] for row in seen.settings.contacts), default=0.0)


def _axes(seen: Seen, row: HangtimeConstraint) -> Matrix:
    """Columns: the directions of a point's bounds; as in solver/stages/constraint_builder.py."""
    up = Vector((0.0, 0.0, 1.0))
    if row.axes == PointAxes.TRAVEL.name and len(seen.settings.stances):
        forward = Vector(seen.settings.stances[0].forward_axis)
        return Matrix((forward, up.cross(forward), up)).transposed().freeze()
    if row.axes == PointAxes.SURFACE.name:
        out = Vector(row.normal).normalized()
        along = up - out * up.dot(out)
        along = along if along.length > 0.1 else Vector((1.0, 0.0, 0.0))
        along.normalize()
        return Matrix((along, out.cross(along), out)).transposed().freeze()
    return Matrix.Identity(3).freeze()
