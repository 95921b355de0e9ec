"""Small figures for tests: a trunk on two jointed legs that stand, one until half-way; an arm."""

from dataclasses import replace
from functools import cache

import numpy as np
from hangtime.solver.analysis.timeline import Timeline
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import Body, Character, Joint
from hangtime.solver.body.dynamics import MomentFunction
from hangtime.solver.body.joint_axes import JointAxes
from hangtime.solver.body.kinematics import BodyPoint, forward_kinematics
from hangtime.solver.constraints.constraint_builder import build_constraints
from hangtime.solver.constraints.evaluation_context import EvaluationContext
from hangtime.solver.data.contacts import Contact, ContactSchedule
from hangtime.solver.data.recording import Bone, Recording
from hangtime.solver.data.requests import Requests
from hangtime.solver.data.status import Status
from hangtime.solver.numerics.block_banded import BlockBanded
from hangtime.solver.numerics.rotations import rotation_matrix
from hangtime.solver.numerics.splines import ORDER, SplineBasis, phase_breaks
from hangtime.solver.objectives.motion_metric import motion_target
from hangtime.solver.objectives.tracking_cost import CostWeights, TrackingCost
from hangtime.solver.optimisation.restoration import restore
from hangtime.solver.optimisation.sqp import FeasibleSet, Outcome
from hangtime.solver.transcription.constraint import Constraint, ConstraintFunction, exchange
from hangtime.solver.transcription.contact_pins import PointContact
from hangtime.solver.transcription.joint_measures import TwistAngle
from hangtime.solver.transcription.motion import Motion
from hangtime.solver.transcription.rows import Layout
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.solver.transcription.transcription import Transcription

DURATION = 0.3  # s
LIFT = 0.15  # s, when the right foot leaves
STEP = 1e-6
CROUCH = np.array([0.0, 0.0, 0.0, 0.4, 0.0, -0.8, 0.4, 0.0, -0.8])  # rad
RATE = 100.0  # scene frames a second of the small figure's recording, whose first frame is 1


def body(name: str, part: Part, side: Side, mass: float, tip: tuple[float, float, float]) -> Body:
    end = np.array(tip)
    size = np.array([0.1, 0.15, np.linalg.norm(end)])
    inertia = np.diag(mass * (size @ size - size**2) / 12.0)
    return Body(name, name, part, side, mass, 0.5 * end, inertia, end, size, np.eye(3), 0.5 * end)


@cache
def figure() -> Character:
    """A trunk (3 angles at the root), two thighs (2) and two shanks (1), about 1 m of leg."""
    random = np.random.default_rng(7)
    skew = rotation_matrix(0.2 * random.normal(size=(9, 3)))
    bodies = [body("trunk", Part.PELVIS, Side.MIDDLE, 40.0, (0.0, 0.05, 0.5))]
    joints = [Joint(-1, np.zeros(3), JointAxes(3, skew[0], skew[1]), 0)]
    first = 3
    for i, side in enumerate((Side.LEFT, Side.RIGHT)):
        hip = np.array([0.1 - 0.2 * i, 0.0, 0.0])
        thigh = len(bodies)
        bodies.append(body(f"{side.value} thigh", Part.THIGH, side, 9.0, (0.0, 0.0, -0.45)))
        joints.append(Joint(0, hip, JointAxes(2, skew[2 + i], np.eye(3)), first))
        bodies.append(body(f"{side.value} shank", Part.SHANK, side, 6.0, (0.0, -0.03, -0.5)))
        knee = np.array([0.0, 0.0, -0.45])
        joints.append(Joint(thigh, knee, JointAxes(1, skew[4 + i], np.eye(3)), first + 2))
        first += 3
    return Character(tuple(bodies), tuple(joints), 1.5)


@cache
def feet() -> tuple[BodyPoint, ...]:
    """The soles' ends of both shanks."""
    character = figure()
    return tuple(BodyPoint(i, character.bodies[i].tip) for i in (2, 4))


@cache
def _basis() -> SplineBasis:
    breaks, double = phase_breaks([0.0, LIFT, DURATION], [], 0.05)
    return SplineBasis(breaks, double)


@cache
def standing() -> Transcription:
    """Both feet carry at first, the left one all the time."""
    return Transcription(figure(), _basis(), feet(), contacts(), MomentFunction(figure()))


def contacts() -> tuple[PointContact, ...]:
    """Each foot a little nearer than with straight legs and the centre of mass one metre up."""
    at = forward_kinematics(figure(), np.zeros((1, figure().n_angles))).points(feet())[0] + [
        0.0,
        0.0,
        1.08,
    ]
    ends = (DURATION, LIFT)
    bones = [figure().bodies[p.body].bone for p in feet()]
    made = [
        Contact(f"{bone} 1", bone, bone, np.zeros(3), 0.0, end, place)
        for bone, end, place in zip(bones, ends, at, strict=True)
    ]
    return tuple(PointContact(c, i) for i, c in enumerate(made))


def places() -> np.ndarray:
    return np.stack([c.contact.place for c in standing().contacts])


def random_state(seed: int, size: float = 0.2) -> np.ndarray:
    """Unknowns near standing: (K, n_block), forces about half a body weight each."""
    t = standing()
    random = np.random.default_rng(seed)
    x = size * random.normal(size=t.active.shape)
    x[:, t.layout.com] += [0.0, 0.0, 1.0]
    x[:, t.layout.forces] += np.tile([0.0, 0.0, 0.5], t.layout.n_points)
    x[~t.active] = 0.0
    return x


# -- standing, solved -----------------------------------------------------------------------


def metric(motion: Motion) -> BlockBanded:
    weights = CostWeights(shape=1.0, com=0.1, force=1e-3)
    return TrackingCost(motion.transcription, motion_target(motion), weights).expand(motion.x)[1]


@cache
def stood() -> Motion:
    """A valid motion near standing, knees a little bent."""
    x = random_state(3, size=0.02)
    x[:, standing().layout.angles] += CROUCH
    outcome = restored(standing(), Motion(standing(), x, places()))
    assert outcome.status is Status.SOLVED
    return Motion(standing(), outcome.x, places())


def restored(transcription: Transcription, start: Motion) -> Outcome:
    """Minimum-norm steps to where a transcription's rows hold."""
    return restore(FeasibleSet(transcription, places()), metric(start), start.x, stage="toy")


def held_between(t: Transcription, start: Motion) -> tuple[Transcription, Outcome]:
    """The same, with rows added where a constraint is violated in between."""
    outcome = restored(t, start)
    for _ in range(4):
        added = tuple(exchange(c, t.character, t.basis, t.layout, outcome.x) for c in t.constraints)
        if all(new is old for new, old in zip(added, t.constraints, strict=True)):
            break
        t = replace(t, constraints=added)
        outcome = restored(t, Motion(t, outcome.x, start.places))
    return t, outcome


@cache
def context() -> EvaluationContext:
    """The standing motion as a fit of which something is asked."""
    motion = stood()
    touching = tuple(c.contact for c in motion.transcription.contacts)
    line = Timeline(np.array([0.0, DURATION]), np.array([0.0, DURATION]), (), 1.0, RATE)
    schedule = ContactSchedule(touching, DURATION, 0.0)
    return EvaluationContext(
        recording(), motion, motion, schedule.phases, schedule, line, lambda _: np.eye(3)
    )


def recording() -> Recording:
    """What context() was read from; bones' axes are the bodies'."""
    character = figure()
    times = np.linspace(0.0, DURATION, round(DURATION * RATE) + 1)
    still = forward_kinematics(character, np.zeros((1, character.n_angles)))
    bones = tuple(
        Bone(b.bone, j.parent, head, head + b.tip, np.eye(3))
        for b, j, head in zip(character.bodies, character.joints, still.centres[0], strict=True)
    )
    heads = np.tile(still.centres, (len(times), 1, 1))
    rotations = np.tile(np.eye(3), (len(times), len(bones), 1, 1))
    return Recording("toy", bones, 1.0 + RATE * times, times, heads, rotations)


def asked(requests: Requests) -> Transcription:
    """The standing figure of which something is asked."""
    return replace(standing(), constraints=build_constraints(requests, context(), standing()))


# -- an arm with plain axes, posed at will --------------------------------------------------


def arm(dofs: int) -> Character:
    """A trunk and an arm that hangs from it by a joint of x, y and z in turn."""
    trunk = body("trunk", Part.PELVIS, Side.MIDDLE, 40.0, (0.0, 0.0, 0.5))
    hanging = body("arm", Part.UPPER_ARM, Side.LEFT, 5.0, (0.0, 0.0, -0.6))
    shoulder = Joint(0, np.array([0.2, 0.0, 0.5]), JointAxes(dofs, np.eye(3), np.eye(3)), 3)
    root = Joint(-1, np.zeros(3), JointAxes(3, np.eye(3), np.eye(3)), 0)
    return Character((trunk, hanging), (root, shoulder), 1.2)


def still(character: Character, angles: np.ndarray, com: np.ndarray | None = None) -> State:
    """The character in one pose, seen at one instant of a second."""
    layout = Layout(character.n_angles, 0)
    basis = SplineBasis(np.array([0.0, 1.0]), np.array([False, False]))
    x = np.zeros((basis.n_coefficients, layout.n_block))
    x[:, layout.angles] = angles
    x[:, layout.com] = 0.0 if com is None else com
    return State(character, layout, Instants(basis, np.array([0.5])), x)


# -- Jacobians ------------------------------------------------------------------------------


def seen(t: Transcription, x: np.ndarray) -> State:
    """Unknowns at the instants at which a constraint of the whole clip would have its rows."""
    whole = Constraint(
        "toy", TwistAngle(t.character.joints[0], np.eye(3)[0]), None, *t.basis.breaks[[0, -1]]
    )
    return State(t.character, t.layout, whole.instants(t.basis), x)


def jacobian_error(state: State, function: ConstraintFunction, seed: int) -> float:
    """Error of a function's Jacobian against central differences along a random direction of the
    unknowns, over the largest of these."""
    direction = np.random.default_rng(seed).normal(size=state.x.shape)
    ahead, behind = (
        function.value(replace(state, x=state.x + s * STEP * direction)) for s in (1.0, -1.0)
    )
    theirs = (ahead - behind) / (2.0 * STEP)
    jacobian = state.instants.assemble(function.jacobians(state), state.layout)
    assert jacobian.shape == (*theirs.shape, ORDER, state.layout.n_block)
    ours = np.einsum("umkn,ukn->um", jacobian, direction[state.instants.blocks])
    largest = float(np.abs(theirs).max())
    assert largest > 1e-3  # else nothing was tested
    return float(np.abs(ours - theirs).max()) / largest
