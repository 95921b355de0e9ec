"""The lists of constraints and body changes as the solver's requests.

Which fields of a row count for which kind is said here: each kind has one function that makes its
record. Blender units become metres; rows that are switched off are left out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import fields
from math import degrees
from typing import TYPE_CHECKING, Any

import bpy

from ...solver.data.faults import AsksNothing, CrossedBounds, NamedTwice, NameMissing
from ...solver.data.requests import (
    AngleLimit,
    BodyChange,
    Bound,
    ConeLimit,
    ConeShape,
    ForceRequest,
    Hold,
    Lift,
    OrientationRequest,
    PhaseTiming,
    PointAxes,
    PointRequest,
    PoseRequest,
    Reference,
    Requests,
    TorqueLimit,
    TwistLimit,
)
from ..armature.poses import metres_per_unit
from ..properties.kinds import (
    BodyKind,
    ConstraintKind,
    ForceShape,
    PoseSource,
    TimingBy,
    TorqueBy,
)
from .body_requests import body_change
from .row_parts import RowContext, bone_of, bones_of, direction_of, offset_of, scaled, some_bones
from .target_paths import paths_of
from .times import Clip, phase_of, when_of

if TYPE_CHECKING:
    from ..properties.body_change import HangtimeBodyChange
    from ..properties.constraint import HangtimeConstraint
    from ..properties.settings import HangtimeSettings

SHAPES = {ForceShape.EXACT: ConeShape.EXACT, ForceShape.PYRAMID: ConeShape.PYRAMID}
SOURCES = {PoseSource.FIT: Reference.FIT, PoseSource.REST: Reference.REST}


def requests_of(
    settings: HangtimeSettings,
    armature: bpy.types.Object,
    span: tuple[float, float] | None = None,
) -> Requests:
    """What the artist's lists ask for.

    span: first and last scene frame of the recording; None takes the analysed clip's. The scene's
    frame is afterwards what it was. Raises NameMissing, NamedTwice, NoBoneChosen, UnknownBone,
    NoPhaseChosen, UnknownPhaseIn, EmptyRange, CrossedBounds, AsksNothing, NoDirection.
    """
    rows = [row for row in settings.constraints if row.used]
    changes = [row for row in settings.body_changes if row.used]
    _require_names([*rows, *changes], [row.name for row in settings.contacts])
    clip = Clip.of(settings, span)
    metres = metres_per_unit(bpy.context.scene)
    own = metres * armature.matrix_world.median_scale
    scene = RowContext(armature, clip, metres, own, paths_of(rows, clip, metres))
    made: dict[str, list[Any]] = {}
    for row in rows:
        field, record = RECORDS[ConstraintKind[row.kind]]
        made.setdefault(field, []).append(record(row, scene))
    return Requests(
        **{field: tuple(records) for field, records in made.items()},
        body=body_change(settings, changes, scene),
    )


def joined(first: Requests, second: Requests) -> Requests:
    """Both; how to solve, and a mass or a gravity that both give, is the second's.

    Raises NamedTwice.
    """
    refuse_same_names([*first.names, *second.names])
    usual = BodyChange()
    mass = first.body.mass if second.body.mass is None else second.body.mass
    same = second.body.gravity == usual.gravity
    body = BodyChange(
        mass=mass,
        gravity=first.body.gravity if same else second.body.gravity,
        added=first.body.added + second.body.added,
        limbs=first.body.limbs + second.body.limbs,
    )
    lists = [f.name for f in fields(Requests) if f.name not in ("body", "solution")]
    both = {name: getattr(first, name) + getattr(second, name) for name in lists}
    return Requests(**both, body=body, solution=second.solution)


def refuse_same_names(names: Iterable[str]) -> None:
    """Raises NamedTwice."""
    for name, count in Counter(names).items():
        if count > 1:
            raise NamedTwice(name)


def _require_names(
    rows: list[HangtimeConstraint | HangtimeBodyChange], contacts: list[str]
) -> None:
    kinds = {**ConstraintKind.__members__, **BodyKind.__members__}
    for row in rows:
        if not row.name.strip():
            raise NameMissing(kinds[row.kind].value)
    names = [row.name for row in rows]
    refuse_same_names([*names, *(set(contacts) & set(names))])


# ---------------------------------------------------------------- constraints


def _point(row: HangtimeConstraint, scene: RowContext) -> PointRequest:
    path = scene.paths.get(row.name)
    own_place = row.use_place and path is None
    axes = PointAxes[row.axes]
    return PointRequest(
        row.name,
        bone_of(row, scene),
        when_of(row, scene.clip),
        offset=offset_of(row, scene),
        place=scaled(row.place, scene.metres) if own_place else None,
        path=path,
        axes=axes,
        normal=direction_of(row, row.normal),
        bounds=_bounds(row, scene) if row.use_bounds else None,
        environment=row.environment,
        grip=row.environment and row.grip,
    )


def _bounds(row: HangtimeConstraint, scene: RowContext) -> tuple[Bound, Bound, Bound]:
    sides = zip(
        row.bound_axes, row.bound_below, row.bound_above, row.at_least, row.at_most, strict=True
    )
    x, y, z = (
        _bound(
            row,
            scene.metres * low if bounded and below else None,
            scene.metres * high if bounded and above else None,
            "m",
        )
        for bounded, below, above, low, high in sides
    )
    if (x, y, z) == ((None, None),) * 3:
        raise AsksNothing(row.name)
    return x, y, z


def _bound(row: HangtimeConstraint, low: float | None, high: float | None, unit: str) -> Bound:
    if low is not None and high is not None and low > high:
        told = (degrees(low), degrees(high)) if unit == "°" else (low, high)
        raise CrossedBounds(row.name, *told, unit)
    return low, high


def _limits(row: HangtimeConstraint) -> Bound:
    """Of an angle, rad."""
    low = row.lower if row.use_lower else None
    high = row.upper if row.use_upper else None
    if low is None and high is None:
        raise AsksNothing(row.name)
    return _bound(row, low, high, "°")


def _lift(row: HangtimeConstraint, scene: RowContext) -> Lift:
    return Lift(row.name, phase_of(row, scene.clip), bones_of(row, scene))


def _angle(row: HangtimeConstraint, scene: RowContext) -> AngleLimit:
    return AngleLimit(row.name, bone_of(row, scene), *_limits(row), when_of(row, scene.clip))


def _twist(row: HangtimeConstraint, scene: RowContext) -> TwistLimit:
    return TwistLimit(row.name, bone_of(row, scene), *_limits(row), when_of(row, scene.clip))


def _cone(row: HangtimeConstraint, scene: RowContext) -> ConeLimit:
    return ConeLimit(
        row.name,
        bone_of(row, scene),
        row.half_angle,
        axis=direction_of(row, row.axis) if row.use_axis else None,
        stretch=tuple(row.stretch),
        when=when_of(row, scene.clip),
    )


def _torque(row: HangtimeConstraint, scene: RowContext) -> TorqueLimit:
    by_share = TorqueBy[row.torque_by] is TorqueBy.SHARE
    return TorqueLimit(
        row.name,
        some_bones(row, scene),
        bound=None if by_share else row.torque,
        share=row.share if by_share else None,
        value=row.torque_value,
        dof=row.dof if row.use_dof else None,
        when=when_of(row, scene.clip),
    )


def _pose(row: HangtimeConstraint, scene: RowContext) -> PoseRequest:
    source = SOURCES[PoseSource[row.source]]
    return PoseRequest(
        row.name,
        when_of(row, scene.clip),
        bones_of(row, scene),
        reference=source,
        frame=row.pose_frame if row.use_pose_frame and source is Reference.FIT else None,
        weight=None if row.hard else row.weight,
        slack=row.slack if row.hard else 0.0,
    )


def _orientation(row: HangtimeConstraint, scene: RowContext) -> OrientationRequest:
    when = when_of(row, scene.clip)
    return OrientationRequest(row.name, bone_of(row, scene), when, row.turn, row.tilt, row.slack)


def _force(row: HangtimeConstraint, scene: RowContext) -> ForceRequest:
    shape = SHAPES[ForceShape[row.shape]]
    if not (row.use_peak or row.use_friction or row.use_match or shape is ConeShape.PYRAMID):
        raise AsksNothing(row.name)
    return ForceRequest(
        row.name,
        friction=row.friction if row.use_friction else None,
        shape=shape,
        peak=row.peak if row.use_peak else None,
        match=row.match if row.use_match else None,
        touching=bones_of(row, scene),
        when=when_of(row, scene.clip),
    )


def _timing(row: HangtimeConstraint, scene: RowContext) -> PhaseTiming:
    phase = phase_of(row, scene.clip)
    if TimingBy[row.timing_by] is TimingBy.FACTOR:
        return PhaseTiming(row.name, phase, factor=row.factor)
    return PhaseTiming(row.name, phase, seconds=row.seconds)


def _hold(row: HangtimeConstraint, _scene: RowContext) -> Hold:
    return Hold(row.name, row.first_frame, row.seconds, row.ends)


RECORDS: dict[ConstraintKind, tuple[str, Callable[[HangtimeConstraint, RowContext], Any]]] = {
    ConstraintKind.POINT: ("points", _point),
    ConstraintKind.LIFT: ("lifts", _lift),
    ConstraintKind.ANGLE: ("angles", _angle),
    ConstraintKind.CONE: ("cones", _cone),
    ConstraintKind.TWIST: ("twists", _twist),
    ConstraintKind.TORQUE: ("torques", _torque),
    ConstraintKind.POSE: ("poses", _pose),
    ConstraintKind.ORIENTATION: ("orientations", _orientation),
    ConstraintKind.FORCE: ("forces", _force),
    ConstraintKind.TIMING: ("timings", _timing),
    ConstraintKind.HOLD: ("holds", _hold),
}
