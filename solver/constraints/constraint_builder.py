"""Constraint builder: the artist's requests as constraints, each under the artist's name."""

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..data.faults import NothingTouches, WrongAngle
from ..data.requests import ForceRequest, Requests, TorqueLimit
from ..objectives.least_squares import LeastSquares
from ..transcription.constraint import Bounds, Constraint
from ..transcription.constraint_functions import PeakForce
from ..transcription.sampling import Instants, State
from ..transcription.torque_constraint import TorqueFunction
from ..transcription.transcription import Transcription
from .evaluation_context import EvaluationContext, touches
from .joint_constraints import (
    bend_limit,
    cone_limit,
    orientation_constraint,
    pose_constraint,
    pose_function,
    twist_limit,
)
from .point_constraints import is_bounded, point_constraint

# N·m, of muscles that are to give none: a sixtieth of what holding an arm out takes. A spline has
# one acceleration a knot, so it follows a free swing only so nearly: with 0.05 the solve takes
# twice as long for a motion that looks the same.
LEAST_TORQUE = 0.2


def build_constraints(
    requests: Requests, context: EvaluationContext, transcription: Transcription
) -> tuple[Constraint, ...]:
    """Every constraint that requests ask for, in the order of their kinds.

    transcription: with the contacts of the result. Raises the faults of EvaluationContext and
    WrongAngle, NothingTouches, BadTiming.
    """
    made: list[Constraint] = []
    free = [r for r in requests.points if not r.environment or is_bounded(r)]
    made += [point_constraint(r, context) for r in free]
    made += [bend_limit(r, context) for r in requests.angles]
    made += [cone_limit(r, context) for r in requests.cones]
    made += [twist_limit(r, context) for r in requests.twists]
    made += [_torque_limit(r, context, transcription) for r in requests.torques]
    made += [pose_constraint(r, context) for r in requests.poses if r.weight is None]
    made += [orientation_constraint(r, context) for r in requests.orientations]
    made += [_peak_limit(r, context, transcription) for r in requests.forces if r.peak is not None]
    return tuple(made)


def _torque_limit(
    request: TorqueLimit, context: EvaluationContext, transcription: Transcription
) -> Constraint:
    bodies = [context.jointed(request.name, bone) for bone in request.bones]
    span = context.interval(request.name, request.when)
    joints: list[list[int]] = []
    for body in bodies:
        joint = context.character.joints[body]
        mine = list(range(joint.first, joint.dofs.stop))
        if request.dof is not None:
            if request.dof >= len(mine):
                raise WrongAngle(request.name, context.character.bodies[body].bone, len(mine))
            mine = mine[request.dof : request.dof + 1]
        joints.append(mine)
    if request.bound is None:
        peaks = (request.share or 0.0) * _peak_torques(context, joints, span)
    else:
        peaks = np.full(len(joints), request.bound)
    angles = [angle for mine in joints for angle in mine]
    bounds = np.repeat(np.maximum(peaks, LEAST_TORQUE), [len(mine) for mine in joints])
    function = TorqueFunction(context.character, transcription.points, angles, of_muscles=True)
    unit_nm = context.character.mass * STANDARD_GRAVITY
    middle, half = request.value / unit_nm, bounds / unit_nm
    return Constraint(request.name, function, Bounds(middle - half, middle + half), *span)


def _peak_torques(
    context: EvaluationContext, joints: Sequence[Sequence[int]], span: tuple[float, float]
) -> FloatArray:
    """(J,) the fit's largest muscle torque about any angle of each of J joints, given by their
    angles, during a span of the new time, s; N·m."""
    motion = context.fitted
    t = motion.transcription
    angles = [angle for mine in joints for angle in mine]
    function = TorqueFunction(t.character, t.points, angles, of_muscles=True)
    times = np.unique(context.reference_times(np.linspace(*span, 400)))
    state = State(t.character, t.layout, Instants(t.basis, times), motion.x)
    largest = np.abs(function.value(state)).max(axis=0) * t.character.mass * STANDARD_GRAVITY
    ends = np.cumsum([len(mine) for mine in joints])
    return np.array([each.max() for each in np.split(largest, ends[:-1])])


def _peak_limit(
    request: ForceRequest, context: EvaluationContext, transcription: Transcription
) -> Constraint:
    span = context.interval(request.name, request.when)
    points = sorted(
        {c.point for c in transcription.contacts if touches(request.touching, c.contact)}
    )
    if not points:
        raise NothingTouches(request.name, request.touching)
    function = PeakForce(np.array(points, dtype=int))
    return Constraint(request.name, function, Bounds.scalar(None, request.peak), *span)


def preferred_poses(
    requests: Requests, context: EvaluationContext, t: Transcription
) -> list[LeastSquares]:
    """Soft constraints: preferred poses as terms of an objective on transcription t."""
    terms = []
    for request in requests.preferred:
        start, end = context.interval(request.name, request.when)
        near = (t.node_times >= start) & (t.node_times <= end)
        if not near.any():  # a single instant: the nodes of its span
            near = t.node_spans == t.basis.spans(np.array([start]))[0]
        weights = np.where(near, t.node_weights, 0.0)
        function, scale = pose_function(request, context), request.weight or 0.0
        target = np.zeros((len(weights), len(function.which)))
        terms.append(LeastSquares(t, function, target, scale, weights))
    return terms
