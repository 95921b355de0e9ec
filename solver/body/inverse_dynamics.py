"""Inverse dynamics by the recursive Newton-Euler algorithm (Featherstone 2008, ch. 5.3), in arrays.

Wrenches are taken about the centre of mass and summed from the leaves inwards. The torque along an
axis is what all that hangs on the joint needs there, less what external forces give. Its
derivatives are after Singh, Russell and Wensing (2022), as in dynamics.py: an eighth of what CasADi
takes, and nothing is built.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .character import Character
from .dynamics import BATCH, MomentumRate, Spatial, cross, instants_last, times, trace
from .kinematics import BodyPoint, Pose, forward_kinematics


@dataclass(frozen=True)
class Movement:
    """A movement at N instants, world axes. speeds, accelerations: (N, n_angles) of the angles,
    rad, s. com_acceleration: (N, 3) m/s². forces: (N, P, 3) N, on the body."""

    pose: Pose
    speeds: FloatArray
    accelerations: FloatArray
    com_acceleration: FloatArray
    forces: FloatArray

    def at(self, some: slice) -> "Movement":
        """At some of the instants."""
        parts = (self.speeds, self.accelerations, self.com_acceleration, self.forces)
        return Movement(self.pose.at(some), *(part[some] for part in parts))


@dataclass(frozen=True)
class ExternalForces:
    """Sums of external forces f at places p, from the centre of mass, on each body or on all that
    hangs on it. force: (B, 3, N) N, moment: N·m, held: f p^T (B, 3, 3, N)."""

    force: FloatArray
    moment: FloatArray
    held: FloatArray

    @staticmethod
    def of(points: Sequence[BodyPoint], movement: Movement) -> "ExternalForces":
        """On each body."""
        bodies, count = len(movement.pose.character.bodies), len(movement.speeds)
        sums = ExternalForces(
            *(np.zeros((bodies, *shape, count)) for shape in ((3,), (3,), (3, 3)))
        )
        if points:
            at = instants_last(movement.pose.points(points))
            forces = instants_last(movement.forces)
            owners = [point.body for point in points]
            np.add.at(sums.force, owners, forces)
            np.add.at(sums.moment, owners, cross(at, forces))
            np.add.at(sums.held, owners, forces[:, :, None] * at[:, None])
        return sums

    def each(self, work: Callable[[FloatArray], FloatArray]) -> "ExternalForces":
        """What `work` makes of the sums."""
        return ExternalForces(work(self.force), work(self.moment), work(self.held))

    def some(self, which: IntArray) -> "ExternalForces":
        return self.each(lambda each: each[which])

    def turned(self, axes: Spatial) -> FloatArray:
        """(K, 3, N) sums of f x (what the axes do to p)."""
        swung = trace(self.held) * axes.turn - times(self.held.swapaxes(1, 2), axes.turn)
        return np.asarray(swung + cross(self.force, axes.move))


def needed_wrench(
    momentum: MomentumRate, points: Sequence[BodyPoint], movement: Movement
) -> Spatial:
    """(B, 3, N) moment about the centre of mass, N·m, and force, N, that each body and all that
    hangs on it need beside the external forces on them; world axes."""
    character, masses, pose = momentum.character, momentum.masses, movement.pose
    carried, moment = momentum.of_bodies(pose, movement.speeds, movement.accelerations)
    shared = (masses * carried).sum(axis=0) / character.mass
    force = masses * (carried - shared + _lift(character, movement))
    moment += cross(instants_last(pose.body_coms), force)
    given = ExternalForces.of(points, movement)
    return Spatial(momentum.outward(moment - given.moment), momentum.outward(force - given.force))


def _lift(character: Character, movement: Movement) -> FloatArray:
    """(3, N) m/s², by which every body is lifted: the centre of mass's own and gravity's."""
    up = np.array([0.0, 0.0, character.gravity])
    return np.asarray(movement.com_acceleration.T + up[:, None])


@dataclass(frozen=True)
class GeneralisedForces:
    """Generalised forces at N instants.

    root_force (N, 3) N and root_moment (N, 3) N·m about the centre of mass, world axes: the
    residual wrench, zero for a valid motion; taken to act on the root body. torques
    (N, n_angles - 3) N·m at the joint angles after the root's three, positive along the angle.
    """

    root_force: FloatArray
    root_moment: FloatArray
    torques: FloatArray


class InverseDynamics:
    """Inverse dynamics of a character with external forces at chosen points, to be measured."""

    def __init__(self, character: Character, points: Sequence[BodyPoint] = ()) -> None:
        self._character, self._points = character, points
        self._momentum = MomentumRate(character)

    def __call__(
        self,
        q: FloatArray,
        v: FloatArray,
        a: FloatArray,
        com_acceleration: FloatArray,
        forces: FloatArray,
    ) -> GeneralisedForces:
        """Generalised forces of a movement.

        q, v, a: (N, n_angles) joint angles, rad, and their derivatives by s. com_acceleration:
        (N, 3) m/s², forces on the body: (N, P, 3) N; both in world axes.
        """
        posed = forward_kinematics(self._character, q)
        movement = Movement(posed, v, a, com_acceleration, forces)
        needed = needed_wrench(self._momentum, self._points, movement)
        at_joints = needed.turn - cross(instants_last(posed.centres), needed.move)
        axes, bodies_of = instants_last(posed.axes), self._character.body_of_angle
        torques = (axes * at_joints[bodies_of]).sum(axis=1)
        return GeneralisedForces(needed.move[0].T, needed.turn[0].T, torques[3:].T)


@dataclass(frozen=True)
class TorqueDerivatives:
    """Derivatives (N, m, ...) of m torques: by angles, speeds and accelerations (n_angles), by the
    centre of mass's acceleration (3) and by external forces (P, 3)."""

    by_angle: FloatArray
    by_speed: FloatArray
    by_acceleration: FloatArray
    by_com_acceleration: FloatArray
    by_force: FloatArray


class JointTorques:
    """Torques of a character's joints, N·m, along the axes of some of their angles.

    angles: (m,) none of the root's. orthogonal: of a joint with three angles the third torque is
    about the axis across the first two, not about the third angle's own, which near gimbal lock is
    parallel to the first and tells nothing of a moment across it.
    """

    def __init__(
        self,
        character: Character,
        points: Sequence[BodyPoint],
        angles: IntArray,
        *,
        orthogonal: bool = False,
    ) -> None:
        self._character, self._points = character, points
        self._angles = angles
        self._momentum = MomentumRate(character)
        self._body = character.body_of_angle[angles]
        across = [self._is_last_of_three(angle) for angle in angles.tolist()]
        self._across = np.flatnonzero(across) if orthogonal else np.zeros(0, int)

    def _is_last_of_three(self, angle: int) -> bool:
        joint = self._character.joints[self._character.body_of_angle[angle]]
        return bool(joint.axes.dofs == 3 and angle == joint.dofs.stop - 1)

    @cached_property
    def _turned(self) -> BoolArray:
        """(m, n_angles) whether an angle turns a torque's axis."""
        angles = np.arange(self._character.n_angles)
        last = self._angles.copy()  # the first angle of its joint that does not
        last[self._across] -= 1
        path = self._character.path_matrix[self._body] > 0.0
        return np.asarray(path & (angles < last[:, None]))

    @cached_property
    def _beyond(self) -> BoolArray:
        """(m, n_angles) whether an angle moves some of what hangs on a torque's axis alone."""
        path = self._character.path_matrix[self._character.body_of_angle] > 0.0
        return np.asarray(path[:, self._angles].T & ~self._turned)

    def value(self, movement: Movement) -> FloatArray:
        """(N, m) N·m."""
        needed = needed_wrench(self._momentum, self._points, movement).some(self._body)
        R = self._axes(movement.pose)
        return np.asarray((R.turn * needed.turn + R.move * needed.move).sum(axis=1).T)

    def derivatives(self, movement: Movement) -> TorqueDerivatives:
        """By all that a movement is made of."""
        batches = range(0, len(movement.speeds), BATCH)
        found = [self._derivatives(movement.at(slice(i, i + BATCH))) for i in batches]
        names = [each.name for each in fields(TorqueDerivatives)]
        return TorqueDerivatives(
            *(np.concatenate([getattr(each, name) for each in found]) for name in names)
        )

    def _derivatives(self, movement: Movement) -> TorqueDerivatives:
        """With a torque's axis R, an angle's S, and F, I, B of what hangs on each: an angle beyond
        the axis changes the wrench there, which gives R . dF; a nearer one turns the axis too, and

            by a: I R . S     by v: 2 (I R . S' + B'R . S)     by q: I R . S'' + 2 B'R . S'

        Every angle changes the acceleration that all bodies share. Weights and external forces act
        at places that turn, and do not turn themselves.
        """
        momentum, owner = self._momentum, self._character.body_of_angle
        moving = momentum.expanded(movement.pose, movement.speeds, movement.accelerations)
        S, rate, second = moving.axes, moving.rate, moving.second
        R, lift = self._axes(movement.pose), _lift(self._character, movement)[None]
        masses = momentum.outward(momentum.masses)
        given = ExternalForces.of(self._points, movement).each(momentum.outward)

        held = moving.sums.some(self._body)
        kept, swept = held.impulse(R, masses[self._body]), held.swept_back(R)
        turning = given.some(self._body).turned(R) + cross(kept.move, lift)

        sums, mass = moving.sums.some(owner), masses[owner]
        by_a = sums.impulse(S, mass)
        by_v = sums.impulse(rate, mass).plus(sums.sweep(S.turn))
        by_q = sums.wrench(S).plus(sums.impulse(second, mass))
        by_q = by_q.plus(sums.sweep(2.0 * rate.turn))
        moved = given.some(owner).turned(S) + cross(by_a.move, lift)

        far, move = _side(R.turn, R.move), _side(kept.move)

        def by(near: FloatArray, axes: FloatArray, outer: Spatial, turn: FloatArray) -> FloatArray:
            found = (near @ axes.swapaxes(1, 2)) * self._turned
            found += (far @ _side(turn, outer.move).swapaxes(1, 2)) * self._beyond
            shared = move @ (_side(outer.move) / self._character.mass).swapaxes(1, 2)
            return np.asarray(found - shared)

        return TorqueDerivatives(
            by(
                _side(kept.turn, kept.move, 2.0 * swept, turning),
                _side(second.turn, second.move, rate.turn, S.turn),
                by_q,
                by_q.turn + moved,
            ),
            2.0
            * by(
                _side(kept.turn, kept.move, swept),
                _side(rate.turn, rate.move, S.turn),
                by_v,
                by_v.turn,
            ),
            by(_side(kept.turn, kept.move), _side(S.turn, S.move), by_a, by_a.turn),
            move,
            self._by_force(movement.pose, R),
        )

    def _axes(self, pose: Pose) -> Spatial:
        """(m, 3, N) what a turn about each torque's axis does at the centre of mass."""
        axes = instants_last(pose.axes)
        turn = axes[self._angles]
        if len(self._across):
            last = self._angles[self._across]
            turn[self._across] = cross(axes[last - 2], axes[last - 1])
        return Spatial(turn, cross(instants_last(pose.centres)[self._body], turn))

    def _by_force(self, pose: Pose, R: Spatial) -> FloatArray:
        """(N, m, P, 3): a force takes over what turns its point along."""
        if not self._points:
            return np.zeros((len(pose.axes), len(self._angles), 0, 3))
        turn, move = _side(R.turn)[:, :, None], _side(R.move)[:, :, None]
        reached = self._character.path_matrix[[p.body for p in self._points]][:, self._angles].T
        swung = np.cross(turn, pose.points(self._points)[:, None]) + move
        return np.asarray(-reached[..., None] * swung)


def _side(*parts: FloatArray) -> FloatArray:
    """(N, K, 3 n) of n parts (K, 3, N), side by side."""
    return np.ascontiguousarray(np.concatenate(parts, axis=1).transpose(2, 0, 1))
