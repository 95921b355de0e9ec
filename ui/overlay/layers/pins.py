"""Contacts and held points as red balls; hollow where nothing pushes back."""

from collections.abc import Iterator

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ....bridge.constraint_kinds import point
from ....bridge.constraints.motion_problem import moved
from ....bridge.properties.constraint import HangtimeConstraint
from ....bridge.properties.contact import HangtimeContact
from ....bridge.rows.phases import listed, roles
from ....bridge.rows.times import Frames
from ....solver.data.requests import PointAxes
from ..context.layer import IDENTITY, Layer, Part, xyz
from ..context.view_context import ShownMotion, ViewContext, holds
from ..geometry import palette
from ..geometry.pin_shapes import Box, Pin, shapes
from ..geometry.shapes import Label, Standing

REACH = 0.25  # m, how far a box is drawn along an axis that is not bounded
ABOVE = 0.12  # m, of a stance's words
SHIFTED = 1e-3  # Blender units


def contacts(view: ViewContext) -> Layer:
    """The contacts, in the world."""
    chosen = view.settings.active_contact
    rows = [each for each in enumerate(view.settings.contacts) if not each[1].surplus]
    pins = tuple(_contact(view, row, i == chosen) for i, row in rows)
    labels = tuple(_labels(view))
    content = pins, labels, view.units
    return Layer(Part.CONTACTS, content, lambda: (*shapes(pins, view.units), *labels), IDENTITY)


def _contact(view: ViewContext, row: HangtimeContact, chosen: bool) -> Pin:
    found = tuple(row.found_at) if moved(row) else None
    return Pin(tuple(row.at), _standing_of(row, view.recorded_frame), False, chosen, found)


def _standing_of(row: HangtimeContact, frame: float) -> Standing:
    if not row.used:
        return Standing.OFF
    return Standing.NOW if row.start_frame <= frame <= row.end_frame else Standing.LATER


def _labels(view: ViewContext) -> Iterator[Label]:
    """The distance by which each stance has been moved."""
    shifts = [(stance, Vector(stance.shifted).length) for stance in view.settings.stances]
    shifted = [each for each in shifts if each[1] > SHIFTED]
    called = roles(view.settings) if shifted else {}
    for stance, shift in shifted:
        places = [Vector(c.at) for c in view.settings.contacts if c.phase == stance.name and c.used]
        if places:
            middle = sum(places, Vector()) / len(places)
            words = f"{called.get(stance.name, stance.name)}: {shift * view.metres:.2f} m"
            middle.z += ABOVE * view.units
            yield Label(words, xyz(middle), palette.MOVE)


def points(view: ViewContext) -> Layer:
    """The points that constraints hold, in the world."""
    rows = view.rows(point.KIND.name)
    pins = tuple(pin for row, chosen in rows for pin in _point(view, row, chosen))
    return Layer(Part.POINTS, (pins, view.units), lambda: shapes(pins, view.units), IDENTITY)


def _point(view: ViewContext, row: HangtimeConstraint, chosen: bool) -> Iterator[Pin]:
    span = view.span(row)
    recorded = _recorded_place(view, row, span)
    place = _place(row, recorded)
    if place is None:
        return
    standing = Standing.NOW if holds(span, view.recorded_frame) else Standing.LATER
    box = _box(view, row, place) if row.use_bounds else None
    # bounds hold a point in no one place that it could have been moved to
    found = recorded if row.use_place and not row.use_bounds else None
    yield Pin(
        xyz(place),
        standing if row.used else Standing.OFF,
        hollow=not row.environment or row.use_bounds,
        chosen=chosen,
        found=xyz(found) if found is not None else None,
        box=box,
    )


def _place(row: HangtimeConstraint, recorded: Vector | None) -> Vector | None:
    if row.target is not None:
        target: bpy.types.Object = row.target
        return target.matrix_world.translation
    return Vector(row.place) if row.use_place else recorded


def _recorded_place(view: ViewContext, row: HangtimeConstraint, span: Frames) -> Vector | None:
    """The point's place in the recording: at this frame, or on average where something is there."""
    bone, shown = view.bone(row), view.recorded
    if bone is None:
        return None
    matrix = view.armature.matrix_world @ bone.matrix
    middle = matrix @ Vector((0.0, 0.5 * bone.length, 0.0))
    at = matrix @ Vector(row.offset) if row.use_offset else middle
    if shown is None or bone.name not in shown.traces.bones:
        return at
    return _traced(shown, bone.name, view.frame, span, mean=row.environment) + (at - middle)


def _traced(shown: ShownMotion, bone: str, frame: float, span: Frames, *, mean: bool) -> Vector:
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


def _box(view: ViewContext, row: HangtimeConstraint, place: Vector) -> Box:
    """Bounds about a place; without one of its own they count from the world's origin and floor."""
    reach = REACH * view.units
    own = row.use_place or row.target is not None or row.environment
    zero = Vector() if own else Vector((0.0, 0.0, _floor(view))) - place
    flags = zip(row.bound_axes, row.bound_below, row.bound_above, strict=True)
    ends = [
        _ends(low + z if on and below else None, high + z if on and above else None, reach)
        for z, low, high, (on, below, above) in zip(
            xyz(zero), row.at_least, row.at_most, flags, strict=True
        )
    ]
    return Box(_axes(view, row), *zip(*ends, strict=True))


def _ends(low: float | None, high: float | None, reach: float) -> tuple[float, float]:
    """From where to where a box is drawn that may be open."""
    if low is None:
        return (-reach, reach) if high is None else (high - reach, high)
    return low, low + reach if high is None else high


def _floor(view: ViewContext) -> float:
    return min((row.found_at[2] for row in listed(view.settings)), default=0.0)


def _axes(view: ViewContext, row: HangtimeConstraint) -> Matrix:
    """Columns: the directions of a point's bounds; as in solver/constraints."""
    up = Vector((0.0, 0.0, 1.0))
    if row.axes == PointAxes.TRAVEL.name and len(view.settings.stances):
        forward = Vector(view.settings.stances[0].forward_axis)
        return _frame(forward, up)
    if row.axes == PointAxes.SURFACE.name:
        out = Vector(row.normal).normalized()
        along = up - out * up.dot(out)
        along = along if along.length > 0.1 else Vector((1.0, 0.0, 0.0))
        along.normalize()
        return _frame(along, out)
    return Matrix.Identity(3).freeze()


def _frame(one: Vector, three: Vector) -> Matrix:
    """Columns: unit vectors at right angles, the second across both of those given."""
    two = three.cross(one)
    assert isinstance(two, Vector)  # of vectors with two components it would be a number
    return Matrix((one.to_tuple(), two.to_tuple(), three.to_tuple())).transposed().freeze()
