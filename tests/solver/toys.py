"""Small figures for tests: a trunk on two jointed legs that stand, one until half-way."""

from functools import cache

import numpy as np
from hangtime.solver.anatomy import Part, Side
from hangtime.solver.character import Body, Character, Joint
from hangtime.solver.contacts import Contact
from hangtime.solver.coordinates import Axes
from hangtime.solver.dynamics import MomentFunction
from hangtime.solver.kinematics import BodyPoint, pose
from hangtime.solver.pins import PointContact
from hangtime.solver.rotations import rotation_matrix
from hangtime.solver.splines import Basis, phase_breaks
from hangtime.solver.transcription import Transcription

DURATION = 0.3  # s
LIFT = 0.15  # s, when the right foot leaves


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
    joints = [Joint(-1, np.zeros(3), Axes(3, skew[0], skew[1]), 0)]
    first = 3
    for i, side in enumerate((Side.LEFT, Side.RIGHT)):
        hip = np.array([0.1 - 0.2 * i, 0.0, 0.0])
        thigh = len(bodies)
        bodies.append(body(f"{side.value} thigh", Part.THIGH, side, 9.0, (0.0, 0.0, -0.45)))
        joints.append(Joint(0, hip, Axes(2, skew[2 + i], np.eye(3)), first))
        bodies.append(body(f"{side.value} shank", Part.SHANK, side, 6.0, (0.0, -0.03, -0.5)))
        knee = np.array([0.0, 0.0, -0.45])
        joints.append(Joint(thigh, knee, Axes(1, skew[4 + i], np.eye(3)), first + 2))
        first += 3
    return Character(tuple(bodies), tuple(joints), 1.5)


@cache
def feet() -> tuple[BodyPoint, ...]:
    """The soles' ends of both shanks."""
    character = figure()
    return tuple(BodyPoint(i, character.bodies[i].tip) for i in (2, 4))


@cache
def _basis() -> Basis:
    breaks, double = phase_breaks([0.0, LIFT, DURATION], [], 0.05)
    return Basis(breaks, double)


@cache
def standing() -> Transcription:
    """Both feet carry at first, the left one all the time."""
    return Transcription(figure(), _basis(), feet(), contacts(), MomentFunction(figure()))


def contacts() -> tuple[PointContact, ...]:
    """Each foot where it is when every angle is zero and the centre of mass one metre up."""
    at = pose(figure(), np.zeros((1, figure().n_angles))).points(feet())[0] + [0.0, 0.0, 1.0]
    ends = (DURATION, LIFT)
    bones = [figure().bodies[p.body].bone for p in feet()]
    made = [
        Contact(f"{bone} 1", bone, bone, np.zeros(3), 0.0, end, place)
        for bone, end, place in zip(bones, ends, at, strict=True)
    ]
    return tuple(PointContact(c, i, 0.0, c.end) for i, c in enumerate(made))


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
