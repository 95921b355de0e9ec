"""Joint limits (bend, cone, twist), poses and orientations as constraints (thesis 3.3)."""

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.faults import NoSuchPoseFrame
from ..data.requests import (
    AngleLimit,
    ConeLimit,
    OrientationRequest,
    PoseRequest,
    Reference,
    TwistLimit,
)
from ..numerics.rotations import axis_rotation, perpendicular, unit
from ..transcription.constraint import Bounds, Constraint
from ..transcription.constraint_functions import BodyOrientation, JointAngles, OrientationDistance
from ..transcription.joint_measures import (
    BendAngle,
    ConeAngle,
    TwistAngle,
    bend_angle,
    cone_angle,
)
from .evaluation_context import EvaluationContext


def bend_limit(request: AngleLimit, context: EvaluationContext) -> Constraint:
    """Raises StillBone, RootHasNoJoint, UnknownPhaseIn, BadTiming."""
    body = context.jointed(request.name, request.bone)
    function = bend_function(context, body)
    span = context.interval(request.name, request.when)
    return Constraint(request.name, function, Bounds.scalar(request.lower, request.upper), *span)


def bend_function(context: EvaluationContext, body: int) -> BendAngle:
    """Flexion angle of a body's joint, positive the way it bends in the fit."""
    times = np.linspace(0.0, context.reference.duration, 200)
    return bend_angle(context.character, body, context.reference.angles(times))


def cone_limit(request: ConeLimit, context: EvaluationContext) -> Constraint:
    """Raises StillBone, RootHasNoJoint, UnknownPhaseIn, BadTiming."""
    body = context.jointed(request.name, request.bone)
    span = context.interval(request.name, request.when)
    function = cone_function(request, context, body, span)
    return Constraint(request.name, function, Bounds.scalar(None, request.half_angle), *span)


def cone_function(
    request: ConeLimit, context: EvaluationContext, body: int, span: tuple[float, float]
) -> ConeAngle:
    """Cone about the request's axis, or about the bone's mean direction in the fit; span s."""
    if request.axis is None:
        joint, along = context.character.joints[body], unit(context.character.bodies[body].tip)
        times = context.reference_times(np.linspace(*span, 100))
        turned = joint.axes.rotation(context.reference.angles(times)[:, joint.dofs]) @ along
        axis = unit(turned.mean(axis=0))
    else:
        axis = unit(np.array(request.axis, dtype=float))
    return cone_angle(context.character, body, axis, request.stretch)


def twist_limit(request: TwistLimit, context: EvaluationContext) -> Constraint:
    """Raises StillBone, RootHasNoJoint, UnknownPhaseIn, BadTiming."""
    body = context.jointed(request.name, request.bone)
    function = TwistAngle(context.character.joints[body], unit(context.character.bodies[body].tip))
    span = context.interval(request.name, request.when)
    return Constraint(request.name, function, Bounds.scalar(request.lower, request.upper), *span)


def pose_constraint(request: PoseRequest, context: EvaluationContext) -> Constraint:
    """Raises StillBone, RootHasNoJoint, UnknownPhaseIn, BadTiming, NoSuchPoseFrame."""
    span = context.interval(request.name, request.when)
    function = pose_function(request, context)
    slack = np.full(len(function.which), request.slack)
    return Constraint(request.name, function, Bounds(-slack, slack), *span, per_span=1)


def pose_function(request: PoseRequest, context: EvaluationContext) -> JointAngles:
    """Joint angles against those of a frame of the fit (None: the same instant), or of rest.

    The root's own orientation is no part of a pose; see BodyOrientation. Raises StillBone,
    RootHasNoJoint, NoSuchPoseFrame.
    """
    bodies = [context.jointed(request.name, bone) for bone in request.bones]
    bodies = bodies or list(range(1, len(context.character.bodies)))
    bones = [each.bone for each in context.character.bodies]
    joints = [context.character.joints[body] for body in bodies if bones[body] not in request.apart]
    which = np.concatenate([np.arange(j.first, j.dofs.stop) for j in joints])
    if request.reference is Reference.REST:
        rest = [joint.axes.angles(np.eye(3)[None])[0] for joint in joints]
        return _fixed_angles(which, np.concatenate(rest), context)
    if request.frame is not None:
        at = (request.frame - context.timeline.first_frame) / context.timeline.rate
        if not -1e-6 <= at <= context.reference.duration + 1e-6:
            raise NoSuchPoseFrame(request.name, request.frame, *_adapted_frames(context))
        return _fixed_angles(which, context.reference.angles(np.array([at]))[0, which], context)
    return JointAngles(
        which, lambda times: context.reference.angles(context.reference_times(times))[:, which]
    )


def _adapted_frames(context: EvaluationContext) -> tuple[float, float]:
    """The first and the last one."""
    first = context.timeline.first_frame
    return first, float(round(first + context.reference.duration * context.timeline.rate))


def _fixed_angles(which: IntArray, posed: FloatArray, context: EvaluationContext) -> JointAngles:
    """Constant angles (k,) rad, each unwrapped to the turn nearest to the fit's."""

    def wanted(times: FloatArray) -> FloatArray:
        found = context.reference.angles(context.reference_times(times))[:, which]
        return np.asarray(posed + 2 * np.pi * np.round((found - posed) / (2 * np.pi)))

    return JointAngles(which, wanted)


def orientation_constraint(request: OrientationRequest, context: EvaluationContext) -> Constraint:
    """Turn about the vertical, then tilt about the leftward axis that turned with it, of a body
    against the fit.

    Raises StillBone, UnknownPhaseIn, BadTiming.
    """
    body = context.body(request.name, request.bone)
    span = context.interval(request.name, request.when)
    turn = axis_rotation(2, request.turn)
    left = turn @ context.travel(0.5 * sum(span))[:, 1]
    frame = np.stack([left, perpendicular(left), np.cross(left, perpendicular(left))], axis=1)
    tilted = frame @ axis_rotation(0, request.tilt) @ frame.T @ turn

    def wanted(times: FloatArray) -> FloatArray:
        posed = context.reference.pose(context.reference_times(times))
        return np.asarray(tilted @ posed.rotations[:, body])

    function = BodyOrientation(body, wanted)
    if request.slack == 0.0:
        none = np.zeros(3)
        return Constraint(request.name, function, Bounds(none, none), *span, per_span=1)
    within = Bounds.scalar(None, request.slack)
    return Constraint(request.name, OrientationDistance(function), within, *span, per_span=1)
