"""Annotations of a picture (thesis 6): from an adaptation's constraints to marks."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from ...bridge.picture.annotations import (
    Box,
    Cone,
    Ghost,
    LimitArc,
    Mark,
    Sphere,
    Thing,
    TimeSpan,
    Tint,
    Tone,
)
from ...solver.analysis.timeline import Timeline
from ...solver.arrays import FloatArray
from ...solver.body.kinematics import Pose, forward_kinematics
from ...solver.data.problem import MotionProblem
from ...solver.data.requests import AddedMass, TorqueLimit
from ...solver.data.scene import SceneObject
from ...solver.scene.object_motion import ObjectMotion
from ...solver.stages.implicit import Adaptation
from ...solver.transcription import constraint_functions, joint_measures
from ...solver.transcription.constraint import Constraint
from ...solver.transcription.torque_constraint import TorqueFunction
from .picture import instants

DENSITY = 1000.0  # kg/m³, of what is carried
SHAPE = np.array([0.9, 1.6, 0.7])  # of a cube's sides; thin where a hanging arm faces sideways
ARC = 0.7  # radius of a limit's line, as a share of the limb
BESIDE = 0.1  # m from an object's box, within which a figure is by it
SAME = np.radians(0.5)  # limits nearer than this fix the joint


def marks_of(adaptation: Adaptation, problem: MotionProblem) -> tuple[Mark, ...]:
    """The marks of what was asked for, beside the contacts; for `picture.adapted_row`."""
    figure = _Posed(adaptation, instants(adaptation.motion))
    requests = problem.requests
    marks: list[Mark] = []
    for condition in adaptation.motion.transcription.constraints:
        marks += _of_condition(condition, figure)
    marks += _limp(requests.torques, adaptation, figure)
    marks += (mark for added in requests.body.added for mark in _carried(added, figure))
    line = adaptation.setup.context.timeline
    marks += (_thing(each, line, figure.times, figure.com) for each in problem.scene)
    return tuple(marks)


def recorded_on(adaptation: Adaptation, scene: Sequence[SceneObject]) -> tuple[Mark, ...]:
    """The objects of a scene that the recording has contacts on; for `picture.recorded_row`."""
    performance, line = adaptation.fit.performance, adaptation.setup.context.timeline
    names = {contact.on for contact in adaptation.fit.schedule.contacts}
    touched = {each.whole for each in scene if each.name in names}
    drawn = (each for each in scene if each.whole in touched)
    return tuple(_thing(each, line, performance.times, performance.com) for each in drawn)


class _Posed:
    """The adapted figure at the instants of the row, world axes, m."""

    def __init__(self, adaptation: Adaptation, times: FloatArray) -> None:
        motion = adaptation.motion
        self.times = times
        self.angles = motion.angles(times)
        self.com = motion.com(times)
        self.character = motion.transcription.character
        self.context = adaptation.setup.context
        self.pose: Pose = forward_kinematics(self.character, self.angles)
        self.centres = self.pose.centres + self.com[:, None]

    def body_of(self, first_angle: int) -> int:
        """The body whose joint has this angle first."""
        return next(i for i, j in enumerate(self.character.joints) if j.first == first_angle)

    def in_world(self, body: int, vector: FloatArray) -> FloatArray:
        """(T, 3) a direction fixed in the frame of a body's parent."""
        return np.asarray(self.pose.rotations[:, self.character.joints[body].parent] @ vector)


def _of_condition(condition: Constraint, figure: _Posed) -> Iterator[Mark]:
    span = (condition.start, condition.end)
    match condition.function:
        case constraint_functions.PointPosition() as place:
            exact = np.all(condition.bounds.lower == condition.bounds.upper)
            if exact:  # bounds have no place of their own; the thesis leaves them out, too
                yield Sphere(place.place(figure.times), span, hollow=True)
        case joint_measures.BendAngle() as bend:
            yield from _limit(bend, condition, figure, span)
        case joint_measures.ConeAngle() as cone:
            body = figure.body_of(cone.joint.first)
            yield Cone(
                apex=figure.centres[:, body],
                axis=figure.in_world(body, cone.frame[0]),
                across=figure.in_world(body, cone.frame[1]),
                half_angle=float(condition.bounds.upper[0]),
                length=float(np.linalg.norm(figure.character.bodies[body].tip)),
                stretch=(float(cone.stretch[0]), float(cone.stretch[1])),
                span=span,
            )
        case constraint_functions.JointAngles() as wanted:
            yield _ghost(wanted, figure, span)


def _limit(
    bend: joint_measures.BendAngle, condition: Constraint, figure: _Posed, span: TimeSpan
) -> Iterator[Mark]:
    body = figure.body_of(bend.joint.first)
    lower, upper = float(condition.bounds.lower[0]), float(condition.bounds.upper[0])
    if upper - lower < SAME:
        yield Tint((figure.character.bodies[body].name,), Tone.FIXED, span)
    yield LimitArc(
        centre=figure.centres[:, body],
        zero=figure.in_world(body, bend.straight),
        normal=figure.in_world(body, np.cross(bend.straight, bend.flexion)),
        lower=upper if np.isinf(lower) else lower,  # one end alone is one line
        upper=lower if np.isinf(upper) else upper,
        radius=ARC * float(np.linalg.norm(figure.character.bodies[body].tip)),
        span=span,
    )


def _ghost(wanted: constraint_functions.JointAngles, figure: _Posed, span: TimeSpan) -> Ghost:
    """The boxes of the bodies whose angles are asked for, hung on the figure as it is."""
    angles = figure.angles.copy()
    angles[:, wanted.which] = wanted.wanted(figure.times)
    posed = forward_kinematics(figure.character, angles)
    asked = set(wanted.which.tolist())
    joints = figure.character.joints
    which = [i for i, j in enumerate(joints) if i > 0 and asked & set(range(j.first, j.dofs.stop))]
    bodies = [figure.character.bodies[i] for i in which]
    shift = figure.centres[:, :1] - posed.centres[:, :1]  # both hang on the same pelvis
    centres = posed.centres[:, which] + shift
    turns = posed.rotations[:, which]
    middles = np.einsum("tbij,bj->tbi", turns, np.array([b.box_centre for b in bodies]))
    boxes = turns @ np.array([b.box_rotation for b in bodies])
    return Ghost(centres + middles, boxes, np.array([b.box_size for b in bodies]), span)


def _limp(torques: Iterable[TorqueLimit], adaptation: Adaptation, figure: _Posed) -> Iterator[Tint]:
    """The limbs whose joints' torques are bounded, while they are."""
    bodies = {body.bone: body.name for body in figure.character.bodies}
    spans = {
        c.name: (c.start, c.end)
        for c in adaptation.motion.transcription.constraints
        if isinstance(c.function, TorqueFunction)
    }
    for request in torques:
        limbs = tuple(bodies[bone] for bone in request.bones)
        yield Tint(limbs, Tone.LIMP, spans[request.name])


def _carried(added: AddedMass, figure: _Posed) -> Iterator[Box]:
    """A box as heavy as what is carried, where a body carries it."""
    bodies = figure.character.bodies
    body = next((i for i, b in enumerate(bodies) if b.bone == added.bone), None)
    if body is None:
        return
    total = figure.context.fitted.transcription.character.mass
    mass = added.mass if added.mass is not None else (added.share or 0.0) * total
    side = np.cbrt(mass / DENSITY)
    at = bodies[body].tip
    if added.offset is not None:
        recording = figure.context.recording
        at = recording.bones[recording.index(added.bone)].rotation @ np.array(added.offset)
    turns = figure.pose.rotations[:, body]
    yield Box(figure.centres[:, body] + turns @ at, turns, side * SHAPE)


# ---------------------------------------------------------------- the scene


def _thing(thing: SceneObject, line: Timeline, times: FloatArray, com: FloatArray) -> Thing:
    """An object, with the figures that are by it: over it, or nearly. com: (T, 3) m, of the body at
    `times` (T,) s. What reaches from below it to above it where it comes nearest is a wall."""
    places, turns = ObjectMotion.of(thing, line.first_frame, line.rate).at(times)
    if not thing.moves:
        places, turns = places[0], turns[0]
    points = thing.vertices @ np.swapaxes(turns, -1, -2) + places[..., None, :]
    low, high = points.min(axis=-2) - BESIDE, points.max(axis=-2) + BESIDE
    away = np.maximum(np.maximum(low - com, com - high), 0.0)[:, :2]
    by = ~away.any(axis=1)
    when = times[by] if by.any() else times[[0, -1]]
    inside = (com > low) & (com < high)
    wall = not thing.part_of and bool(inside[np.linalg.norm(away, axis=1).argmin(), 2])
    return Thing(points, thing.triangles, (float(when[0]), float(when[-1])), wall)
