"""Forward kinematics and point Jacobians, for many instants at once (thesis 3.3.1).

Everything is relative to the centre of mass: the configuration holds the centre of mass itself,
so a point's place in the world is the centre of mass plus what is computed here.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..numerics.rotations import cross_matrix
from .character import Character


@dataclass(frozen=True)
class BodyPoint:
    """Body-fixed point: index of the body, place (3,) m in the body's frame."""

    body: int
    place: FloatArray


@dataclass(frozen=True)
class Pose:
    """Body poses at N instants. Positions (N, ..., 3) m, world axes, from the centre of mass."""

    character: Character
    rotations: FloatArray  # (N, B, 3, 3) body to world
    centres: FloatArray  # (N, B, 3) joint centres
    axes: FloatArray  # (N, n_angles, 3) world axis that each angle turns about

    def at(self, instants: slice | IntArray) -> "Pose":
        """The poses at some of the instants."""
        parts = (self.rotations, self.centres, self.axes)
        return Pose(self.character, *(part[instants] for part in parts))

    @cached_property
    def body_coms(self) -> FloatArray:
        """(N, B, 3) centres of mass of the bodies."""
        local = self.character.body_coms
        return np.asarray(self.centres + np.einsum("nbij,bj->nbi", self.rotations, local))

    def points(self, points: Sequence[BodyPoint]) -> FloatArray:
        """(N, P, 3) positions of body-fixed points, m, from the centre of mass."""
        bodies = [p.body for p in points]
        local = np.stack([p.place for p in points])
        turned = np.einsum("npij,pj->npi", self.rotations[:, bodies], local)
        return np.asarray(self.centres[:, bodies] + turned)

    def point_jacobian(self, points: Sequence[BodyPoint]) -> FloatArray:
        """(N, P, 3, n_angles) geometric Jacobian of `points`, m/rad (Featherstone 2008, ch. 4.1).

        A column is axis x (point - joint centre), less the centre of mass's own.
        """
        moves = self.character.path_matrix[[p.body for p in points]]  # (P, n)
        at = self.points(points)
        n, count, angles = len(at), len(points), self.axes.shape[1]
        # axis x (point - origin), as one product per instant instead of a cross per pair
        turn = cross_matrix(self.axes)  # (N, n, 3, 3)
        spin = (turn.reshape(n, 3 * angles, 3) @ np.swapaxes(at, 1, 2)).reshape(n, angles, 3, count)
        about = np.cross(self.axes, self.centres[:, self.character.body_of_angle])
        moved = (spin - about[..., None]) * moves.T[None, :, None, :]
        moved -= self._com_jacobian[..., None]
        return np.ascontiguousarray(moved.transpose(0, 3, 2, 1))

    def points_metric(self, points: Sequence[BodyPoint]) -> tuple[FloatArray, FloatArray]:
        """Sums over points of J'J (N, n_angles, n_angles), m², and of J (N, 3, n_angles), m.

        J is `point_jacobian`, which is not needed: the first is the mass matrix of points of mass
        1, by composite rigid bodies (Featherstone 2008, ch. 6.2), about the centre of mass.
        """
        moves = self.character.path_matrix[[p.body for p in points]]  # (P, n)
        at, count = self.points(points), len(points)
        pairs = (at[..., None] * at[..., None, :]).reshape(*at.shape[:2], 9)
        first = moves.T @ at
        second = (moves.T @ pairs).reshape(*self.axes.shape, 3)
        mass, turn, move = moves.sum(axis=0)[:, None], self.axes, self._moves_there
        force = np.cross(turn, first) + mass * move
        trace = np.trace(second, axis1=2, axis2=3)[..., None]
        moment = trace * turn - (second @ turn[..., None])[..., 0] + np.cross(first, move)
        motion, momentum = (
            np.concatenate(each, axis=2) for each in ((turn, move), (moment, force))
        )
        inner = np.triu(self.character.path_matrix[self.character.body_of_angle].T)
        half = (motion @ np.swapaxes(momentum, 1, 2)) * (inner - 0.5 * np.eye(len(inner)))
        half -= (force - 0.5 * count * self._com_jacobian) @ np.swapaxes(self._com_jacobian, 1, 2)
        total = force - count * self._com_jacobian
        return half + np.swapaxes(half, 1, 2), np.swapaxes(total, 1, 2)

    def points_gradient(self, points: Sequence[BodyPoint], forces: FloatArray) -> FloatArray:
        """(N, n_angles) sum over points of J' times forces (N, P, 3), without the Jacobian."""
        moves = self.character.path_matrix[[p.body for p in points]]
        moment, force = moves.T @ np.cross(self.points(points), forces), moves.T @ forces
        found = (self.axes * moment).sum(axis=2) + (self._moves_there * force).sum(axis=2)
        total = forces.sum(axis=1)
        return np.asarray(found - (self._com_jacobian @ total[..., None])[..., 0])

    @cached_property
    def _moves_there(self) -> FloatArray:
        """(N, n_angles, 3) what each angle does to a point at the centre of mass, m/rad."""
        return np.cross(self.centres[:, self.character.body_of_angle], self.axes)

    def jacobian_at(self, bodies: IntArray, at: FloatArray) -> FloatArray:
        """(N, 3, n_angles) Jacobian of one point an instant, at (N, 3) m on bodies (N,), m/rad.

        As `point_jacobian`, of points that slide from instant to instant.
        """
        arm = at[:, None] - self.centres[:, self.character.body_of_angle]
        moved = np.cross(self.axes, arm) * self.character.path_matrix[bodies, :, None]
        return np.swapaxes(moved - self._com_jacobian, 1, 2)

    def point_rates(self, points: Sequence[BodyPoint], rates: FloatArray) -> FloatArray:
        """(N, P, 3) product of `point_jacobian` with (N, n_angles) rates, without the Jacobian."""
        moves, owner = self.character.path_matrix, self.character.body_of_angle
        spin = self.axes * rates[..., None]
        turn, moment = moves @ spin, moves @ np.cross(spin, self.centres[:, owner])
        coms = np.cross(turn, self.body_coms) - moment
        com = self.character.mass_shares @ coms
        bodies = [p.body for p in points]
        at = np.cross(turn[:, bodies], self.points(points)) - moment[:, bodies]
        return np.asarray(at - com[:, None])

    @cached_property
    def _com_jacobian(self) -> FloatArray:
        """(N, n_angles, 3) Jacobian of the centre of mass with the root's centre fixed, m/rad."""
        share = self.character.path_matrix * self.character.mass_shares[:, None]  # (B, n)
        moment = share.T @ self.body_coms
        owner = self.character.body_of_angle
        carried = moment - share.sum(axis=0)[:, None] * self.centres[:, owner]
        return np.cross(self.axes, carried)


def point_velocity(
    posed: Pose, points: Sequence[BodyPoint], speeds: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Point velocities relative to the centre of mass and their derivatives.

    speeds: (N, n_angles) rad/s. Returns velocities (N, P, 3) m/s, world axes, and their
    derivatives by angle and by speed, each (N, P, 3, n_angles). The derivative of a column J_j by
    an angle k nearer the root is axis_k x J_j, and by one farther out axis_j x J_k (Featherstone
    2008, ch. 2.10).
    """
    character = posed.character
    places = [BodyPoint(p.body, p.place) for p in points]
    places += [BodyPoint(i, body.com) for i, body in enumerate(character.bodies)]
    moves = character.path_matrix[[p.body for p in places]]
    arm = posed.points(places)[:, :, None] - posed.centres[:, None, character.body_of_angle]
    columns = np.cross(posed.axes[:, None], arm) * moves[None, :, :, None]  # (N, P + B, n, 3)
    carried = columns * speeds[:, None, :, None]
    outward = np.cumsum(carried[:, :, ::-1], axis=2)[:, :, ::-1]  # sum over j >= k
    spin = posed.axes[:, None] * speeds[:, None, :, None] * moves[None, :, :, None]
    before = np.cumsum(spin, axis=2) - spin  # angular velocity of what joint k turns in
    by_angle = np.cross(posed.axes[:, None], outward) * moves[None, :, :, None]
    by_angle += np.cross(before, columns)
    velocity = carried.sum(axis=2)
    count = len(points)
    share = character.mass_shares

    def relative(each: FloatArray) -> FloatArray:
        return np.asarray(
            each[:, :count] - np.einsum("b,nb...->n...", share, each[:, count:])[:, None]
        )

    return (
        relative(velocity),
        np.swapaxes(relative(by_angle), -1, -2),
        np.swapaxes(relative(columns), -1, -2),
    )


def forward_kinematics(character: Character, angles: FloatArray) -> Pose:
    """Forward kinematics: body poses at (N, n_angles) joint angles in rad.

    World axes; positions from the centre of mass (Featherstone 2008, ch. 4.1). In here instants
    come last: products of three by three with long rows take half of the time of as many
    products as there are instants.
    """
    n = len(angles)
    rotations = np.empty((len(character.bodies), 3, 3, n))
    centres = np.zeros((len(character.bodies), 3, n))
    axes = np.empty((character.n_angles, 3, n))
    by_angle = np.ascontiguousarray(angles.T)
    cosines, sines = np.cos(by_angle), np.sin(by_angle)  # of all at once: see rotations.py
    for i, joint in enumerate(character.joints):
        if joint.parent < 0:
            turn = np.tile(joint.axes.before[..., None], n)
        else:
            held = rotations[joint.parent]
            centres[i] = centres[joint.parent] + joint.offset @ held
            turn = joint.axes.before.T @ held
        for k in range(joint.axes.dofs):
            j = joint.first + k
            axes[j] = turn[:, k]
            _turn(turn, k, cosines[j], sines[j])
        rotations[i] = joint.axes.after.T @ turn
    coms = centres + (character.body_coms[:, None, None] @ rotations)[:, :, 0]
    centres -= np.tensordot(character.mass_shares, coms, 1)
    return Pose(character, *(_instants_first(each) for each in (rotations, centres, axes)))


class LastPose:
    """Forward kinematics that keeps what it found last: a line search asks for its objective and
    its rows at the same angles, and the step after it for both again."""

    def __init__(self, character: Character) -> None:
        self._character = character
        self._angles = np.empty((0, character.n_angles))
        self._pose: Pose | None = None

    def __call__(self, angles: FloatArray) -> Pose:
        """As `forward_kinematics`."""
        if self._pose is None or not np.array_equal(angles, self._angles):
            self._angles, self._pose = angles, forward_kinematics(self._character, angles)
        return self._pose


def _instants_first(each: FloatArray) -> FloatArray:
    """(N, ...) of (..., N)."""
    return np.ascontiguousarray(np.moveaxis(each, -1, 0))


def _turn(R: FloatArray, axis: int, c: FloatArray, s: FloatArray) -> None:
    """R (3, 3, N) becomes its product with the rotation about a coordinate axis by the angle with
    cosine c (N,) and sine s: mixes two columns."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    mixed = R[:, i] * c + R[:, j] * s
    R[:, j] = R[:, j] * c - R[:, i] * s
    R[:, i] = mixed
