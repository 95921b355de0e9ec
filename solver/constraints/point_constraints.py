"""Point constraints: bounds on a body's point relative to a place or a path (thesis 3.3)."""

from collections.abc import Callable

import numpy as np

from ..analysis.timeline import Timeline
from ..arrays import FloatArray
from ..body.kinematics import BodyPoint
from ..data.constants import UP
from ..data.requests import Path, PointAxes, PointRequest
from ..numerics.rotations import perpendicular, unit
from ..transcription.constraint import Bounds, Constraint
from ..transcription.constraint_functions import PointPosition
from ..transcription.contact_pins import interpolate_places
from .evaluation_context import EvaluationContext


def point_constraint(request: PointRequest, context: EvaluationContext) -> Constraint:
    """Raises StillBone, UnknownPhaseIn, BadTiming."""
    body = context.body(request.name, request.bone)
    span = context.interval(request.name, request.when)
    point = context.point(body, request.offset)
    axes = point_axes(request, context, span)
    bounds = request.bounds or ((0.0, 0.0),) * 3
    lower = np.array([-np.inf if low is None else low for low, _ in bounds])
    upper = np.array([np.inf if high is None else high for _, high in bounds])
    kept = np.isfinite(lower) | np.isfinite(upper)
    function = PointPosition(point, point_place(request, context, point, span), axes[:, kept])
    exact = bool((lower == upper)[kept].all())
    limits = Bounds(lower[kept], upper[kept])
    return Constraint(request.name, function, limits, *span, per_span=1 if exact else 2)


def is_bounded(request: PointRequest) -> bool:
    """Whether a point has inequality bounds, which are constraints even of an environment point."""
    return any(bound not in ((0.0, 0.0), (None, None)) for bound in request.bounds or ())


def point_axes(
    request: PointRequest, context: EvaluationContext, span: tuple[float, float]
) -> FloatArray:
    """(3, 3) columns: directions of a point's bounds and displacement, world; span s."""
    match request.axes:
        case PointAxes.WORLD:
            return np.eye(3)
        case PointAxes.TRAVEL:
            return context.travel(0.5 * sum(span))
        case PointAxes.SURFACE:
            out = UP if request.normal is None else unit(np.array(request.normal, dtype=float))
            ahead = context.travel(0.5 * sum(span))[:, 0]
            along = ahead - out * (ahead @ out)
            along = unit(along) if np.linalg.norm(along) > 0.1 else perpendicular(out)
            return np.stack([along, np.cross(out, along), out], axis=1)


def point_place(
    request: PointRequest, context: EvaluationContext, point: BodyPoint, span: tuple[float, float]
) -> Callable[[FloatArray], FloatArray]:
    """Target place of a point, as a function of instants (U,) s: (U, 3) m, world."""
    shift = point_axes(request, context, span) @ np.array(request.relative, dtype=float)
    if request.path is not None:
        follow = path_places(request.path, context.timeline)
        return lambda times: follow(times) + shift
    if request.place is not None:
        fixed = np.array(request.place, dtype=float) + shift
        return lambda times: np.tile(fixed, (len(times), 1))
    if request.environment:
        times = np.linspace(*span, 50)
        mean = _reference_place(context, point, times).mean(axis=0) + shift
        return lambda times: np.tile(mean, (len(times), 1))
    if request.bounds is not None:
        # Bounds without a place are absolute: "the toe at least 0.3 m above the floor".
        floor = np.array([0.0, 0.0, context.schedule.floor_m]) + shift
        return lambda times: np.tile(floor, (len(times), 1))
    return lambda times: _reference_place(context, point, times) + shift


def _reference_place(context: EvaluationContext, point: BodyPoint, times: FloatArray) -> FloatArray:
    old = context.reference_times(times)
    motion = context.reference
    return np.asarray(motion.pose(old).points([point])[:, 0] + motion.com(old))


def path_places(path: Path, timeline: Timeline) -> Callable[[FloatArray], FloatArray]:
    """Path as a function of instants (U,) s: (U, 3) m; see contact_pins.interpolate_places."""
    at, places = path_instants(path, timeline), np.array(path.places)
    return lambda times: interpolate_places(at, places, times)


def path_instants(path: Path, timeline: Timeline) -> FloatArray:
    """(T,) s, new time, of a path's frames: what moves keeps the scene's clock, however the
    motion's phases are retimed."""
    return np.asarray((np.array(path.frames) - timeline.first_frame) / timeline.rate)
