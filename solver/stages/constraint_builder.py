"""From the artist's requests to conditions on the motion, each under the artist's name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.anatomy import Part
from ..body.character import Body, Character
from ..body.human_limits import MIN_BEND_SINE
from ..body.kinematics import BodyPoint
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Contact, ContactSchedule, Phase
from ..data.faults import BadTiming, NothingTouches, RootHasNoJoint, StillBone, WrongAngle
from ..data.recording import Recording
from ..data.requests import (
    AngleLimit,
    ConeLimit,
    ForceRequest,
    OrientationRequest,
    Path,
    PointAxes,
    PointRequest,
    PoseRequest,
    Reference,
    Requests,
    TorqueLimit,
    TwistLimit,
    When,
)
from ..data.timeline import Timeline, active_interval
from ..numerics.rotations import axis_rotation, perpendicular, unit
from ..transcription.constraint import Bounds, Constraint
from ..transcription.constraint_functions import (
    Angles,
    Bend,
    Cone,
    Orientation,
    PeakForce,
    Place,
    Twist,
)
from ..transcription.contact_pins import between
from ..transcription.motion import Motion
from ..transcription.objectives import Squares
from ..transcription.sampling import Instants, State
from ..transcription.torque_constraint import TorqueFunction, Torques
from ..transcription.transcription import Transcription

LIMP = 2.0  # N·m; what tendons and clothes hold of themselves, so zero is taken as this
DENSE = 240.0  # Hz, at which the start is sampled


@dataclass(frozen=True)
class EvaluationContext:
    """What requests are understood in: the fit, and the timeline that the result will have.

    fitted: the fit, which gives peaks; reference: the same with the body as it is asked for,
    which gives places and poses. phases: the recording's, on the new time, by which requests name
    them; schedule: what touches when in the result. travel: (3, 3) columns forward, left, up at
    an instant.
    """

    recording: Recording
    fitted: Motion
    reference: Motion
    phases: tuple[Phase, ...]
    schedule: ContactSchedule
    timeline: Timeline
    travel: Callable[[float], FloatArray]

    @property
    def character(self) -> Character:
        return self.reference.transcription.character

    @cached_property
    def apex(self) -> FloatArray:
        """(T, 2) instants and heights of the centre of mass."""
        times = np.linspace(0.0, self.timeline.duration, int(self.timeline.duration * DENSE) + 2)
        heights = self.reference.com(self.reference_times(times))[:, 2]
        return np.stack([times, heights], axis=1)

    def interval(self, name: str, when: When) -> tuple[float, float]:
        """Start and end, s. Raises UnknownPhaseIn, BadTiming."""
        return active_interval(name, when, self.timeline, self.phases, self.apex)

    def body(self, name: str, bone: str) -> int:
        """Raises StillBone."""
        known = tuple(body.bone for body in self.character.bodies)
        if bone not in known:
            raise StillBone(name, bone, known)
        return known.index(bone)

    def jointed(self, name: str, bone: str) -> int:
        """A body with a joint to a parent. Raises StillBone, RootHasNoJoint."""
        body = self.body(name, bone)
        if self.character.joints[body].parent < 0:
            raise RootHasNoJoint(name, bone)
        return body

    def point(self, body: int, offset: tuple[float, float, float] | None) -> BodyPoint:
        """A point of a body, given in its bone's axes from the bone's head; None: its middle."""
        if offset is None:
            return BodyPoint(body, 0.5 * self.character.bodies[body].tip)
        bone = self.recording.bones[self.recording.index(self.character.bodies[body].bone)]
        return BodyPoint(body, bone.rotation @ np.array(offset))

    def reference_times(self, times: FloatArray) -> FloatArray:
        """The fit's instants of the new motion's."""
        return self.timeline.to_old(times)


def conditions(
    requests: Requests, scene: EvaluationContext, transcription: Transcription
) -> tuple[Constraint, ...]:
    """Every condition, in the order of the records' kinds, on a motion that touches as the
    transcription has it. Raises the faults of Scene."""
    made: list[Constraint] = []
    made += [_point(r, scene) for r in requests.points if not r.environment or _loose(r)]
    made += [_bend(r, scene) for r in requests.angles]
    made += [_cone(r, scene) for r in requests.cones]
    made += [_twist(r, scene) for r in requests.twists]
    made += [_torque(r, scene, transcription) for r in requests.torques]
    made += [_pose(r, scene) for r in requests.poses if r.weight is None]
    made += [_orientation(r, scene) for r in requests.orientations]
    made += [_peak(r, scene, transcription) for r in requests.forces if r.peak is not None]
    return tuple(made)


def _limits(lower: float | None, upper: float | None) -> Bounds:
    return Bounds(
        np.array([-np.inf if lower is None else lower]),
        np.array([np.inf if upper is None else upper]),
    )


# ---------------------------------------------------------------- joints


def _bend(request: AngleLimit, scene: EvaluationContext) -> Constraint:
    body = scene.jointed(request.name, request.bone)
    measure = bend_measure(scene, body)
    span = scene.interval(request.name, request.when)
    return Constraint(request.name, measure, _limits(request.lower, request.upper), *span)


def bend_measure(scene: EvaluationContext, body: int) -> Bend:
    """How far a body's joint is bent, positive the way it bends in the fit."""
    character = scene.character
    joint, parent = character.joints[body], character.bodies[character.joints[body].parent]
    along = unit(character.bodies[body].tip)
    straight = unit(parent.tip)
    times = np.linspace(0.0, scene.reference.duration, 200)
    turned = joint.axes.rotation(scene.reference.angles(times)[:, joint.dofs]) @ along
    mean = turned.mean(axis=0)
    across = mean - straight * (mean @ straight)
    if np.linalg.norm(across) < MIN_BEND_SINE:
        across = _expected_flexion(character.bodies[body], straight)
    return Bend(joint, along, straight, unit(across))


def _expected_flexion(body: Body, straight: FloatArray) -> FloatArray:
    """Knees bend backwards, everything else forwards; at right angles to the straight limb."""
    forward = body.box_rotation[:, 1]
    forward = -forward if body.part is Part.SHANK else forward
    across = forward - straight * (forward @ straight)
    return across if np.linalg.norm(across) > MIN_BEND_SINE else perpendicular(straight)


def _cone(request: ConeLimit, scene: EvaluationContext) -> Constraint:
    body = scene.jointed(request.name, request.bone)
    span = scene.interval(request.name, request.when)
    measure = cone_measure(request, scene, body, span)
    return Constraint(request.name, measure, _limits(None, request.half_angle), *span)


def cone_measure(
    request: ConeLimit, scene: EvaluationContext, body: int, span: tuple[float, float]
) -> Cone:
    """The cone of a request about its axis, or about the bone's mean direction in the fit."""
    character = scene.character
    joint, along = character.joints[body], unit(character.bodies[body].tip)
    if request.axis is None:
        times = scene.reference_times(np.linspace(*span, 100))
        turned = joint.axes.rotation(scene.reference.angles(times)[:, joint.dofs]) @ along
        axis = unit(turned.mean(axis=0))
    else:
        axis = unit(np.array(request.axis, dtype=float))
    sideways = character.bodies[0].box_rotation[:, 0]
    first = sideways - axis * (sideways @ axis)
    first = unit(first) if np.linalg.norm(first) > 0.3 else perpendicular(axis)
    frame = np.stack([axis, first, np.cross(axis, first)])
    return Cone(joint, along, frame, np.array(request.stretch, dtype=float))


def _twist(request: TwistLimit, scene: EvaluationContext) -> Constraint:
    body = scene.jointed(request.name, request.bone)
    measure = Twist(scene.character.joints[body], unit(scene.character.bodies[body].tip))
    span = scene.interval(request.name, request.when)
    return Constraint(request.name, measure, _limits(request.lower, request.upper), *span)


# ---------------------------------------------------------------- torques


def _torque(
    request: TorqueLimit, scene: EvaluationContext, transcription: Transcription
) -> Constraint:
    bodies = [scene.jointed(request.name, bone) for bone in request.bones]
    span = scene.interval(request.name, request.when)
    angles, bounds = [], []
    for body in bodies:
        joint = scene.character.joints[body]
        mine = list(range(joint.first, joint.dofs.stop))
        if request.dof is not None:
            if request.dof >= len(mine):
                raise WrongAngle(request.name, scene.character.bodies[body].bone, len(mine))
            mine = mine[request.dof : request.dof + 1]
        bound = request.bound
        if bound is None:
            bound = (request.share or 0.0) * _peak_torque(scene, mine, span)
        angles += mine
        bounds += [max(bound, LIMP)] * len(mine)
    measure = Torques(TorqueFunction(scene.character, transcription.points, angles))
    unit_nm = scene.character.mass * STANDARD_GRAVITY
    middle, half = request.value / unit_nm, np.array(bounds) / unit_nm
    return Constraint(request.name, measure, Bounds(middle - half, middle + half), *span)


def _peak_torque(
    scene: EvaluationContext, angles: Sequence[int], span: tuple[float, float]
) -> float:
    """The largest torque of the fit at joint angles during a span of the new time, N·m."""
    motion = scene.fitted
    t = motion.transcription
    function = TorqueFunction(t.character, t.points, angles)
    times = np.unique(scene.reference_times(np.linspace(*span, 400)))
    state = State(t.character, t.layout, Instants(t.basis, times), motion.x)
    return float(np.abs(function.value(state)).max()) * t.character.mass * STANDARD_GRAVITY


# ---------------------------------------------------------------- poses


def _pose(request: PoseRequest, scene: EvaluationContext) -> Constraint:
    span = scene.interval(request.name, request.when)
    measure = pose_measure(request, scene)
    slack = np.full(len(measure.which), request.slack)
    return Constraint(request.name, measure, Bounds(-slack, slack), *span, per_span=1)


def pose_measure(request: PoseRequest, scene: EvaluationContext) -> Angles:
    """Joint angles against those of a frame of the fit (None: the same instant), or of rest.

    The root's own orientation is no part of a pose; see Orientation.
    """
    bodies = [scene.jointed(request.name, bone) for bone in request.bones]
    bodies = bodies or list(range(1, len(scene.character.bodies)))
    joints = [scene.character.joints[body] for body in bodies]
    which = np.concatenate([np.arange(j.first, j.dofs.stop) for j in joints])
    if request.reference is Reference.REST:
        rest = [joint.axes.angles(np.eye(3)[None])[0] for joint in joints]
        return _fixed_angles(which, np.concatenate(rest), scene)
    if request.frame is not None:
        at = (request.frame - scene.timeline.first_frame) / scene.timeline.rate
        if not -1e-6 <= at <= scene.reference.duration + 1e-6:
            raise BadTiming(request.name, 0.0)
        return _fixed_angles(which, scene.reference.angles(np.array([at]))[0, which], scene)
    return Angles(
        which, lambda times: scene.reference.angles(scene.reference_times(times))[:, which]
    )


def _fixed_angles(which: IntArray, posed: FloatArray, scene: EvaluationContext) -> Angles:
    """Wanted angles, the turn of each nearest to the fit's."""

    def wanted(times: FloatArray) -> FloatArray:
        found = scene.reference.angles(scene.reference_times(times))[:, which]
        return np.asarray(posed + 2 * np.pi * np.round((found - posed) / (2 * np.pi)))

    return Angles(which, wanted)


def preferred_poses(
    requests: Requests, scene: EvaluationContext, t: Transcription
) -> list[Squares]:
    """What misses the poses that are only preferred, as terms of a goal."""
    terms = []
    for request in requests.preferred:
        start, end = scene.interval(request.name, request.when)
        near = (t.node_times >= start) & (t.node_times <= end)
        if not near.any():  # a single instant: the nodes of its span
            near = t.node_spans == t.basis.spans(np.array([start]))[0]
        weights = np.where(near, t.node_weights, 0.0)
        measure, scale = pose_measure(request, scene), request.weight or 0.0
        target = np.zeros((len(weights), len(measure.which)))
        terms.append(Squares(t, measure, target, scale, weights))
    return terms


def _orientation(request: OrientationRequest, scene: EvaluationContext) -> Constraint:
    body = scene.body(request.name, request.bone)
    span = scene.interval(request.name, request.when)
    turn = axis_rotation(2, request.turn)
    left = turn @ scene.travel(0.5 * sum(span))[:, 1]
    frame = np.stack([left, perpendicular(left), np.cross(left, perpendicular(left))], axis=1)
    tilted = frame @ axis_rotation(0, request.tilt) @ frame.T @ turn

    def wanted(times: FloatArray) -> FloatArray:
        posed = scene.reference.pose(scene.reference_times(times))
        return np.asarray(tilted @ posed.rotations[:, body])

    slack = np.full(3, request.slack)
    return Constraint(
        request.name, Orientation(body, wanted), Bounds(-slack, slack), *span, per_span=1
    )


# ---------------------------------------------------------------- points and forces


def _point(request: PointRequest, scene: EvaluationContext) -> Constraint:
    body = scene.body(request.name, request.bone)
    span = scene.interval(request.name, request.when)
    point = scene.point(body, request.offset)
    axes = point_axes(request, scene, span)
    bounds = request.bounds or ((0.0, 0.0),) * 3
    lower = np.array([-np.inf if low is None else low for low, _ in bounds])
    upper = np.array([np.inf if high is None else high for _, high in bounds])
    kept = np.isfinite(lower) | np.isfinite(upper)
    measure = Place(point, point_place(request, scene, point, span), axes[:, kept])
    exact = bool((lower == upper)[kept].all())
    limits = Bounds(lower[kept], upper[kept])
    return Constraint(request.name, measure, limits, *span, per_span=1 if exact else 2)


def _loose(request: PointRequest) -> bool:
    """Whether a point has bounds that hold it in no one place, which are conditions even where
    the world pushes at it."""
    return any(bound not in ((0.0, 0.0), (None, None)) for bound in request.bounds or ())


def point_axes(
    request: PointRequest, scene: EvaluationContext, span: tuple[float, float]
) -> FloatArray:
    """(3, 3) columns: the directions of a point's bounds and displacement."""
    match request.axes:
        case PointAxes.WORLD:
            return np.eye(3)
        case PointAxes.TRAVEL:
            return scene.travel(0.5 * sum(span))
        case PointAxes.SURFACE:
            out = unit(np.array(request.normal, dtype=float))
            ahead = scene.travel(0.5 * sum(span))[:, 0]
            along = ahead - out * (ahead @ out)
            along = unit(along) if np.linalg.norm(along) > 0.1 else perpendicular(out)
            return np.stack([along, np.cross(out, along), out], axis=1)


def point_place(
    request: PointRequest, scene: EvaluationContext, point: BodyPoint, span: tuple[float, float]
) -> Callable[[FloatArray], FloatArray]:
    """Where a point belongs, as a function of instants (U,): places (U, 3) m."""
    shift = point_axes(request, scene, span) @ np.array(request.relative, dtype=float)
    if request.path is not None:
        follow = path_places(request.path, scene.timeline)
        return lambda times: follow(times) + shift
    if request.place is not None:
        fixed = np.array(request.place, dtype=float) + shift
        return lambda times: np.tile(fixed, (len(times), 1))
    if request.environment:
        times = np.linspace(*span, 50)
        mean = _reference_place(scene, point, times).mean(axis=0) + shift
        return lambda times: np.tile(mean, (len(times), 1))
    if request.bounds is not None:
        # Bounds without a place are absolute: "the toe at least 0.3 m above the floor".
        floor = np.array([0.0, 0.0, scene.schedule.floor_m]) + shift
        return lambda times: np.tile(floor, (len(times), 1))
    return lambda times: _reference_place(scene, point, times) + shift


def _reference_place(scene: EvaluationContext, point: BodyPoint, times: FloatArray) -> FloatArray:
    old = scene.reference_times(times)
    motion = scene.reference
    return np.asarray(motion.pose(old).points([point])[:, 0] + motion.com(old))


def path_places(path: Path, timeline: Timeline) -> Callable[[FloatArray], FloatArray]:
    """A moving place as a function of instants; see pins.between."""
    at = np.array([timeline.instant(frame) for frame in path.frames])
    places = np.array(path.places)
    return lambda times: between(at, places, times)


def _peak(
    request: ForceRequest, scene: EvaluationContext, transcription: Transcription
) -> Constraint:
    span = scene.interval(request.name, request.when)
    points = sorted(
        {c.point for c in transcription.contacts if touches(request.touching, c.contact)}
    )
    if not points:
        raise NothingTouches(request.name, request.touching)
    measure = PeakForce(np.array(points, dtype=int))
    return Constraint(request.name, measure, _limits(None, request.peak), *span)


def touches(names: Sequence[str], contact: Contact) -> bool:
    """Whether a contact is one of those named by contact, point or bone; no names mean all."""
    return not names or bool({contact.name, contact.point, contact.bone} & set(names))
