"""Rate of centroidal angular momentum and its derivatives, in arrays (thesis 3.2.2: the root rows).

With the centre of mass as coordinates the six root rows of the Euler-Lagrange equations fall into
    m c'' = m g + sum of contact forces              (linear; see transcription/transcription.py)
    L'(theta, theta', theta'') = sum (p_i - c) x f_i   (angular momentum about the centre of mass)
and L' depends on the joint angles alone. Forces are in body weights, so L' is in body weights x m
(thesis 4.1: scaling).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.constants import STANDARD_GRAVITY
from .character import Character
from .kinematics import Pose, forward_kinematics

BATCH = 192  # instants: what they need then stays in the processor's cache


class MomentFunction:
    """Rate of centroidal angular momentum L', body weights x m, and its Jacobian, vectorised."""

    def __init__(self, character: Character) -> None:
        self._character, self._momentum = character, MomentumRate(character)
        self._weight = character.mass * STANDARD_GRAVITY

    def value(self, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """(N, 3) L', world axes, at (N, n_angles) angles, velocities, accelerations (rad, s)."""
        return self.value_at(forward_kinematics(self._character, q), v, a)

    def value_at(self, posed: Pose, v: FloatArray, a: FloatArray) -> FloatArray:
        """(N, 3) the same at poses that are known."""
        rate = [self._momentum(posed.at(some), v[some], a[some]) for some in _batches(len(v))]
        return np.asarray(np.concatenate(rate) / self._weight)

    def jacobian(
        self, q: FloatArray, v: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """L' (N, 3) and its derivatives (N, 3, 3, n_angles): component, by q, v or a, angle."""
        return self.jacobian_at(forward_kinematics(self._character, q), v, a)

    def jacobian_at(
        self, posed: Pose, v: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The same at poses that are known."""
        count, n = v.shape
        rate, by_order = np.empty((count, 3)), np.empty((count, 3, 3, n))
        for some in _batches(count):
            found = self._momentum.derivatives(posed.at(some), v[some], a[some])
            rate[some] = found[0].T
            for order, each in enumerate(found[1:]):
                by_order[some, :, order] = each.transpose(2, 1, 0)
        return rate / self._weight, by_order / self._weight


def _batches(count: int) -> Iterator[slice]:
    """Parts of so many instants."""
    for first in range(0, count, BATCH):
        yield slice(first, first + BATCH)


@dataclass(frozen=True)
class MomentumRate:
    """L' of a character's motions from their poses, which most who ask for it have already.

    Newton-Euler over long arrays, vectors being (..., 3, N): a fifth of what CasADi takes.
    """

    character: Character

    @cached_property
    def _bodies_before(self) -> list[int]:
        """Of each body the one that it hangs on; -1 of the root."""
        return [joint.parent for joint in self.character.joints]

    @cached_property
    def _last_angle(self) -> list[int]:
        """Of each body the last angle that turns it."""
        last: list[int] = []
        for joint in self.character.joints:
            last.append(joint.dofs.stop - 1 if joint.axes.dofs else last[joint.parent])
        return last

    @cached_property
    def _angles_before(self) -> list[int]:
        """Of each angle the one before it on the way from the root; -1 of the first."""
        before = np.arange(self.character.n_angles) - 1
        for joint in self.character.joints[1:]:
            if joint.axes.dofs:
                before[joint.first] = self._last_angle[joint.parent]
        return [int(each) for each in before]

    @cached_property
    def masses(self) -> FloatArray:
        """(B, 1, 1) kg."""
        return np.array([body.mass for body in self.character.bodies])[:, None, None]

    @cached_property
    def _inertias(self) -> FloatArray:
        """(B, 3, 3, 1) kg m², about the centres of mass."""
        return np.stack([body.inertia for body in self.character.bodies])[..., None]

    @cached_property
    def local_seconds(self) -> FloatArray:
        """(B, 3, 3) integrals of place times place, kg m², about the centres of mass."""
        inertias = self._inertias[..., 0]
        half = 0.5 * np.trace(inertias, axis1=1, axis2=2)
        return np.asarray(half[:, None, None] * np.eye(3) - inertias)

    def __call__(self, posed: Pose, speeds: FloatArray, accelerations: FloatArray) -> FloatArray:
        """(N, 3) L', N·m, world axes, at poses with angles' derivatives (N, n_angles) rad, s.

        Sum over bodies of r x m a + I alpha + omega x I omega (Featherstone 2008, ch. 5.3).
        Accelerations are from the root's centre: what all bodies share has no moment about the
        centre of mass.
        """
        carried, spin = self.of_bodies(posed, speeds, accelerations)
        moment = cross(instants_last(posed.body_coms), self.masses * carried) + spin
        return np.asarray(moment.sum(axis=0).T)

    def of_bodies(
        self, posed: Pose, speeds: FloatArray, accelerations: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """(B, 3, N) of each body, world axes: its centre of mass's acceleration from the root's
        centre, m/s², and the rate of its spin about it, I alpha + omega x I omega, N·m."""
        axes, centres, coms = (
            instants_last(v) for v in (posed.axes, posed.centres, posed.body_coms)
        )
        turn = axes * speeds.T[:, None]
        turned = _summed(turn, self._angles_before)
        gained = axes * accelerations.T[:, None] + cross(turned - turn, turn)
        omega, alpha = (
            turned[self._last_angle],
            _summed(gained, self._angles_before)[self._last_angle],
        )
        above = np.maximum(self._bodies_before, 0)
        hung = _swung(omega[above], alpha[above], centres - centres[above])
        carried = _summed(hung, self._bodies_before) + _swung(omega, alpha, coms - centres)
        R = instants_last(posed.rotations)
        omega, alpha = (times(R.swapaxes(1, 2), each) for each in (omega, alpha))
        spin = times(self._inertias, alpha) + cross(omega, times(self._inertias, omega))
        return carried, times(R, spin)

    def outward(self, each: FloatArray) -> FloatArray:
        """(B, ...) sums over each body and all that hangs on it."""
        total = each.copy()
        for i in reversed(range(1, len(self._bodies_before))):
            total[self._bodies_before[i]] += total[i]
        return total

    def derivatives(
        self, posed: Pose, speeds: FloatArray, accelerations: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """L' (3, N) and its derivatives by angles, speeds and accelerations, (n_angles, 3, N) each.

        Spatial vectors about the centre of mass, as pairs: a turn and what it does there. With an
        angle's axis S, and V, A of what it turns in (Singh, Russell and Wensing 2022, table 1),

            by a: I S     by v: 2 (I S' + B S)     by q: S x* F + I S'' + 2 B S'
            S' = V x S,   S'' = A x S + V x S'

        where I, B, F are sums over the bodies that it turns. Of B only what turns the body counts
        here: tr(D) - D with D the integral of velocity times place, as tr(Q) - Q is the inertia
        with Q the integral of place times place.
        """
        moving = self.expanded(posed, speeds, accelerations)
        S, rate, second = moving.axes, moving.rate, moving.second
        sums = moving.sums.some(self.character.body_of_angle)
        by_a = sums.momentum(S)
        by_v = 2.0 * (sums.momentum(rate) + sums.swept(S.turn))
        by_q = cross(S.turn, sums.moment) + cross(S.move, sums.force) + sums.momentum(second)
        by_q += 2.0 * sums.swept(rate.turn)
        return moving.sums.moment[0], by_q, by_v, by_a

    def expanded(
        self, posed: Pose, speeds: FloatArray, accelerations: FloatArray
    ) -> "ExpandedMotion":
        """What the derivatives of a motion's momentum and torques are made of."""
        axes, centres, coms = (
            instants_last(v) for v in (posed.axes, posed.centres, posed.body_coms)
        )
        S = Spatial(axes, cross(centres[self.character.body_of_angle], axes))
        own = S.scaled(speeds)
        V = own.summed(self._angles_before)
        before = V.less(own)
        rate = before.across(S)
        gained = S.scaled(accelerations).plus(rate.scaled(speeds))
        A = gained.summed(self._angles_before)
        # All bodies share the acceleration that keeps the centre of mass where it is: it has no
        # moment, and then nothing pulls there.
        bodies = BodySums.of(self, posed, coms, V.some(self._last_angle), A.some(self._last_angle))
        A_before = A.less(gained)
        A_before = Spatial(A_before.turn, A_before.move - bodies.shared)
        second = A_before.across(S).plus(before.across(rate))
        return ExpandedMotion(S, rate, second, bodies.each(self.outward))


@dataclass(frozen=True)
class ExpandedMotion:
    """An angle's axis S (n_angles), S' and S'' as `derivatives` has them, and the integrals over
    each body and all that hangs on it."""

    axes: "Spatial"
    rate: "Spatial"
    second: "Spatial"
    sums: "BodySums"


@dataclass(frozen=True)
class Spatial:
    """K spatial vectors about the centre of mass: turn, and move there; (K, 3, N) each."""

    turn: FloatArray
    move: FloatArray

    def scaled(self, rates: FloatArray) -> "Spatial":
        """Times rates (N, K)."""
        each = rates.T[:, None]
        return Spatial(self.turn * each, self.move * each)

    def plus(self, other: "Spatial") -> "Spatial":
        return Spatial(self.turn + other.turn, self.move + other.move)

    def less(self, other: "Spatial") -> "Spatial":
        return Spatial(self.turn - other.turn, self.move - other.move)

    def some(self, which: IntArray | list[int]) -> "Spatial":
        return Spatial(self.turn[which], self.move[which])

    def summed(self, before: list[int]) -> "Spatial":
        """Sums along the tree."""
        return Spatial(_summed(self.turn, before), _summed(self.move, before))

    def across(self, other: "Spatial") -> "Spatial":
        """Spatial cross product (Featherstone 2008, ch. 2.9)."""
        move = cross(self.turn, other.move)
        move += cross(self.move, other.turn)
        return Spatial(cross(self.turn, other.turn), move)


@dataclass(frozen=True)
class BodySums:
    """Integrals over the mass of bodies, or of all that hangs on them; places p from the centre
    of mass, velocities from the root's centre. second: p p^T (B, 3, 3, N) kg m². first: p (B, 3, N)
    kg m. swept_out: p' p^T, carried: p'. force: p'' and moment: p x p''. shared: (3, N) the mean
    acceleration, which is left out."""

    second: FloatArray
    first: FloatArray
    swept_out: FloatArray
    carried: FloatArray
    force: FloatArray
    moment: FloatArray
    shared: FloatArray

    @staticmethod
    def of(
        rate: "MomentumRate", posed: Pose, coms: FloatArray, V: Spatial, A: Spatial
    ) -> "BodySums":
        """Of each body with its motion; coms (B, 3, N)."""
        mass = rate.masses
        local = rate.local_seconds  # about its own centre of mass
        R = posed.rotations
        own = instants_last(R @ local @ np.swapaxes(R, -1, -2))
        first = mass * coms
        velocity = V.move + cross(V.turn, coms)
        acceleration = A.move + cross(A.turn, coms) + cross(V.turn, velocity)
        shared = (mass * acceleration).sum(axis=0) / mass.sum()
        force = mass * (acceleration - shared)
        turning = np.stack([cross(V.turn, own[:, :, k]) for k in range(3)], axis=2)
        spin = trace(own) * A.turn - times(own, A.turn) - cross(V.turn, times(own, V.turn))
        return BodySums(
            own + first[:, :, None] * coms[:, None],
            first,
            turning + velocity[:, :, None] * first[:, None],
            mass * velocity,
            force,
            spin + cross(coms, force),
            shared,
        )

    def some(self, which: IntArray) -> "BodySums":
        return self.each(lambda each: each[which])

    def each(self, work: Callable[[FloatArray], FloatArray]) -> "BodySums":
        """What `work` makes of the integrals."""
        return BodySums(
            work(self.second),
            work(self.first),
            work(self.swept_out),
            work(self.carried),
            work(self.force),
            work(self.moment),
            self.shared,
        )

    def momentum(self, motion: Spatial) -> FloatArray:
        """(K, 3, N) angular momentum of motions of each."""
        found = trace(self.second) * motion.turn
        found -= times(self.second, motion.turn)
        found += cross(self.first, motion.move)
        return found

    def swept(self, turns: FloatArray) -> FloatArray:
        """(K, 3, N) products of B with turns."""
        return trace(self.swept_out) * turns - times(self.swept_out, turns)

    def sweep(self, turns: FloatArray) -> Spatial:
        """The same with the force that goes with it."""
        return Spatial(self.swept(turns), cross(turns, self.carried))

    def swept_back(self, axes: Spatial) -> FloatArray:
        """(K, 3, N) products of `sweep`'s transpose with axes."""
        back = trace(self.swept_out) * axes.turn
        back -= times(self.swept_out.swapaxes(1, 2), axes.turn)
        return back + cross(self.carried, axes.move)

    def impulse(self, motion: Spatial, masses: FloatArray) -> Spatial:
        """Momentum, angular and linear, of motions of each; masses (K, 1, 1) kg."""
        linear = cross(motion.turn, self.first) + masses * motion.move
        return Spatial(self.momentum(motion), linear)

    def wrench(self, axes: Spatial) -> Spatial:
        """What turning about axes does to the wrenches: a spatial cross product."""
        moment = cross(axes.turn, self.moment) + cross(axes.move, self.force)
        return Spatial(moment, cross(axes.turn, self.force))


def trace(matrices: FloatArray) -> FloatArray:
    """(K, 1, N) of (K, 3, 3, N)."""
    return np.asarray((matrices[:, 0, 0] + matrices[:, 1, 1] + matrices[:, 2, 2])[:, None])


def instants_last(each: FloatArray) -> FloatArray:
    """(..., N) of (N, ...)."""
    return np.ascontiguousarray(np.moveaxis(each, 0, -1))


def _summed(each: FloatArray, before: list[int]) -> FloatArray:
    """Sums (K, 3, N) along a tree from its root; before: of each its parent, -1 of the root."""
    total = each.copy()
    for i, parent in enumerate(before):
        if parent >= 0:
            total[i] += total[parent]
    return total


def times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """(B, 3, N) products of matrices (B, 3, 3, N) with vectors (B, 3, N)."""
    columns = (matrices[:, :, k] * vectors[:, k, None] for k in range(3))
    return np.asarray(sum(columns))


def _swung(omega: FloatArray, alpha: FloatArray, arm: FloatArray) -> FloatArray:
    """Acceleration of arms' ends from their beginnings."""
    return cross(alpha, arm) + cross(omega, cross(omega, arm))


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products (K, 3, N) over the middle axis."""
    product = np.empty(a.shape)
    for i in range(3):
        np.multiply(a[:, i - 2], b[:, i - 1], out=product[:, i])
        product[:, i] -= a[:, i - 1] * b[:, i - 2]
    return product
