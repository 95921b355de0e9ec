"""A character as MJCF and a motion as MuJoCo's qpos, qvel and qacc: for checking and simulating.

The root has a free joint, every other joint one hinge per angle. MuJoCo numbers joints depth
first, which `hinge_order` tells. A joint's constant frame `after` is folded into its body: the
MJCF body's frame is ours without it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.body.character import Character
from ...solver.body.kinematics import BodyPoint, forward_kinematics
from ...solver.transcription.motion import Motion

ROOT_SIZE = 6  # velocities of the free joint
AXES = ("1 0 0", "0 1 0", "0 0 1")


def mjcf(character: Character, points: Sequence[BodyPoint] = ()) -> str:
    """The figure as an MJCF document: m, kg, rad, Z up, gravity down, nothing collides.

    points: become sites called "point 0", "point 1", …
    """
    root = ET.Element("mujoco", model="character")
    ET.SubElement(root, "compiler", angle="radian", autolimits="false")
    ET.SubElement(root, "option", gravity=_text([0.0, 0.0, -character.gravity]))
    bodies = [ET.SubElement(root, "worldbody")]
    for i, (body, joint) in enumerate(zip(character.bodies, character.joints, strict=True)):
        parent = bodies[joint.parent + 1]
        fold = _fold(character, joint.parent)
        turn = fold @ joint.axes.before if joint.parent >= 0 else np.eye(3)
        element = ET.SubElement(
            parent,
            "body",
            name=f"{i} {body.name}",
            pos=_text(fold @ joint.offset),
            xyaxes=_text([*turn[:, 0], *turn[:, 1]]),
        )
        if joint.parent < 0:
            ET.SubElement(element, "freejoint", name="root")
        for k in range(joint.axes.dofs if joint.parent >= 0 else 0):
            ET.SubElement(element, "joint", name=f"angle {joint.first + k}", axis=AXES[k])
        own = _fold(character, i)
        inertia = own @ body.inertia @ own.T
        ET.SubElement(
            element,
            "inertial",
            pos=_text(own @ body.com),
            mass=repr(float(body.mass)),
            fullinertia=_text([*np.diagonal(inertia), *inertia[0, 1:], inertia[1, 2]]),
        )
        for p, point in enumerate(points):
            if point.body == i:
                ET.SubElement(element, "site", name=f"point {p}", pos=_text(own @ point.place))
        bodies.append(element)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode")


def _fold(character: Character, body: int) -> FloatArray:
    """(3, 3) from a body's frame to its MJCF frame; the root's are the same."""
    return character.joints[body].axes.after if body > 0 else np.eye(3)


def _text(numbers: Sequence[float] | FloatArray) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def hinge_order(character: Character) -> IntArray:
    """(n_angles - 3,) the joint angle that each hinge of the MJCF document turns."""
    children: list[list[int]] = [[] for _ in character.joints]
    for i, joint in enumerate(character.joints):
        if joint.parent >= 0:
            children[joint.parent].append(i)
    order: list[int] = []
    pending = [0]
    while pending:
        i = pending.pop()
        if i > 0:
            order.extend(range(*character.joints[i].dofs.indices(character.n_angles)))
        pending.extend(reversed(children[i]))
    return np.array(order, dtype=int)


@dataclass(frozen=True)
class Swing:
    """Bodies' motion relative to the root's joint centre at N instants, world axes.

    rotations (N, B, 3, 3); omega, alpha (N, B, 3) rad/s, rad/s²; place, velocity, acceleration
    (N, B, 3) of the bodies' centres of mass in m.
    """

    rotations: FloatArray
    omega: FloatArray
    alpha: FloatArray
    place: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


def swing(character: Character, q: FloatArray, v: FloatArray, a: FloatArray) -> Swing:
    """Motion of all bodies at (N, n_angles) angles, their velocities and accelerations."""
    posed = forward_kinematics(character, q)
    count = (len(q), len(character.bodies), 3)
    omega, alpha = np.zeros(count), np.zeros(count)
    joint_v, joint_a = np.zeros(count), np.zeros(count)
    for i, joint in enumerate(character.joints):
        p = joint.parent
        if p >= 0:
            arm = posed.centres[:, i] - posed.centres[:, p]
            omega[:, i], alpha[:, i] = omega[:, p], alpha[:, p]
            joint_v[:, i] = joint_v[:, p] + np.cross(omega[:, p], arm)
            joint_a[:, i] = joint_a[:, p] + _acceleration(omega[:, p], alpha[:, p], arm)
        for k in range(joint.first, joint.dofs.stop):
            spin = posed.axes[:, k] * v[:, k : k + 1]
            alpha[:, i] += posed.axes[:, k] * a[:, k : k + 1] + np.cross(omega[:, i], spin)
            omega[:, i] += spin
    arms = posed.body_coms - posed.centres
    return Swing(
        posed.rotations,
        omega,
        alpha,
        posed.body_coms - posed.centres[:, :1],
        joint_v + np.cross(omega, arms),
        joint_a + _acceleration(omega, alpha, arms),
    )


def _acceleration(omega: FloatArray, alpha: FloatArray, arm: FloatArray) -> FloatArray:
    return np.asarray(np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm)))


def state(
    character: Character, com: Sequence[FloatArray], angles: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """MuJoCo's qpos (N, n + 4), qvel and qacc (N, n + 3) of a movement; n = n_angles.

    com, angles: the centre of mass (N, 3) m and the angles (N, n) rad with their first and second
    derivatives. The free joint's angular velocity and acceleration are in the root's own axes.
    """
    moving = swing(character, *angles)
    masses = np.array([body.mass for body in character.bodies])
    relative = [
        np.einsum("b,nbi->ni", masses / masses.sum(), part)
        for part in (moving.place, moving.velocity, moving.acceleration)
    ]
    place, velocity, acceleration = (c - r for c, r in zip(com, relative, strict=True))
    order = hinge_order(character)
    local = np.swapaxes(moving.rotations[:, 0], 1, 2)
    omega, alpha = (np.einsum("nij,nj->ni", local, w[:, 0]) for w in (moving.omega, moving.alpha))
    return (
        np.concatenate([place, quaternions(moving.rotations[:, 0]), angles[0][:, order]], axis=1),
        np.concatenate([velocity, omega, angles[1][:, order]], axis=1),
        np.concatenate([acceleration, alpha, angles[2][:, order]], axis=1),
    )


def motion_state(motion: Motion, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """qpos, qvel and qacc of a motion at (T,) s, exactly as its splines have them; see `state`."""
    return state(
        motion.transcription.character,
        [motion.com(times, k) for k in range(3)],
        [motion.angles(times, k) for k in range(3)],
    )


def qpos(motion: Motion, times: FloatArray) -> FloatArray:
    """(T, n_angles + 4) MuJoCo positions: root's place m, quaternion wxyz, hinges' angles rad."""
    return motion_state(motion, times)[0]


def qvel(motion: Motion, times: FloatArray) -> FloatArray:
    """(T, n_angles + 3) MuJoCo velocities: root's in world axes, its turn in its own, hinges."""
    return motion_state(motion, times)[1]


def qacc(motion: Motion, times: FloatArray) -> FloatArray:
    """(T, n_angles + 3) MuJoCo accelerations, laid out as `qvel`."""
    return motion_state(motion, times)[2]


def quaternions(R: FloatArray) -> FloatArray:
    """(N, 4) unit quaternions wxyz of (N, 3, 3) rotations."""
    diagonal = np.diagonal(R, axis1=1, axis2=2)
    trace = diagonal.sum(axis=1)
    k = np.empty((len(R), 4, 4))  # 4 q q', whose longest column loses no digits
    k[:, 0, 0] = 1 + trace
    skew = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], 1)
    k[:, 0, 1:] = k[:, 1:, 0] = skew
    k[:, 1:, 1:] = R + np.swapaxes(R, 1, 2)
    index = np.arange(3)
    k[:, index + 1, index + 1] = 1 - trace[:, None] + 2 * diagonal
    best = np.argmax(np.diagonal(k, axis1=1, axis2=2), axis=1)
    q = k[np.arange(len(R)), best]
    return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))
