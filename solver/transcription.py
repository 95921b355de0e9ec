"""The motion as finitely many unknowns and equations (thesis 4; findings: rank, Gauss points).

Unknowns: coefficients of the centre of mass (m) and of the joint angles (rad) as cubic splines,
and the contact forces (body weights) as piecewise linear functions. Equations:

balance   c'' / g + z - sum f = 0 at every force node: with the matching bases it then holds at
          *every* instant, exactly (both sides are piecewise linear)
moment    L'(theta) - sum (p_i - c) x f_i = 0 at three Gauss points a span
pin       c + p_i(theta) - place = 0 at every break while a point is pinned, and zero velocity at
          the ends: as many rows as a cubic has freedom, so that they stay independent

A contact carries force for a short while before its point has come to rest and after it starts
to lift (`SETTLE`): shoes and feet give, and a spline cannot stop a foot in no time.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .character import Character
from .contacts import Contact
from .dynamics import GRAVITY, MomentFunction
from .kinematics import BodyPoint, point_velocity, pose
from .recording import BoolArray, FloatArray, IntArray
from .rotations import cross_matrix
from .splines import ORDER, Basis, gauss_instants

GAUSS = 3  # dynamics nodes a span
SETTLE = 0.03  # s


class RowKind(Enum):
    """What an equation states. The value is the unit of its violation."""

    BALANCE = "BW"
    MOMENT = "BW·m"
    PIN = "m"
    PIN_SPEED = "m/s"
    RELEASE = "BW released"  # a force that would pull is held at zero


@dataclass(frozen=True)
class PointContact:
    """A contact as the equations see it: `point` indexes the transcription's points."""

    contact: Contact
    point: int
    pin_start: float
    pin_end: float


@dataclass(frozen=True)
class Layout:
    """Where each unknown sits in the array x (K, n_block): centre of mass, angles, forces.

    The forces of force node g sit in block g + 1; those of blocks 0 and K - 1 do not exist.
    """

    n_angles: int
    n_points: int

    @property
    def n_block(self) -> int:
        return 3 + self.n_angles + 3 * self.n_points

    @property
    def com(self) -> slice:
        return slice(0, 3)

    @property
    def angles(self) -> slice:
        return slice(3, 3 + self.n_angles)

    @property
    def motion(self) -> slice:
        return slice(0, 3 + self.n_angles)

    @property
    def forces(self) -> slice:
        return slice(3 + self.n_angles, self.n_block)

    def force(self, point: int) -> slice:
        first = 3 + self.n_angles + 3 * point
        return slice(first, first + 3)


@dataclass(frozen=True)
class Rows:
    """R equations, each within one span: residual (R,), Jacobian (R, 4, n_block) over the span's
    four blocks, and per row its kind, instant (s) and contact (index or -1)."""

    span: IntArray
    residual: FloatArray
    jacobian: FloatArray
    kind: NDArray[np.object_]
    time: FloatArray
    contact: IntArray

    @staticmethod
    def join(parts: Sequence["Rows"]) -> "Rows":
        names = ("span", "residual", "jacobian", "kind", "time", "contact")
        return Rows(*[np.concatenate([getattr(p, name) for p in parts]) for name in names])


@dataclass
class Transcription:
    """The equations of one motion problem on one basis.

    points: the bodies' points that touch; contacts: when and where they do.
    """

    character: Character
    basis: Basis
    points: tuple[BodyPoint, ...]
    contacts: tuple[PointContact, ...]
    moment: MomentFunction
    released: frozenset[tuple[int, int]] = frozenset()  # (force node, point): held at zero
    layout: Layout = field(init=False)
    active: BoolArray = field(init=False)  # (K, n_block) bool, which unknowns exist

    def __post_init__(self) -> None:
        self.layout = Layout(self.character.n_angles, len(self.points))
        self.active = self._active()
        times, self.node_weights, self.node_spans = gauss_instants(self.basis.breaks, GAUSS)
        self.node_times = times
        self._node_basis = [self.basis.evaluate(times, k, self.node_spans) for k in range(3)]
        self._node_force = self.basis.force_weights(times, self.node_spans)
        self._balance = self._balance_rows()

    @property
    def n_unknowns(self) -> int:
        return int(self.active.sum())

    def _active(self) -> BoolArray:
        """Forces act between a contact's start and end, zero at both (where the clip goes on)."""
        basis, layout = self.basis, self.layout
        active = np.zeros((basis.n_coefficients, layout.n_block), dtype=bool)
        active[:, layout.motion] = True
        for contact in self.contacts:
            inside = touching_spans(basis, contact.contact)
            nodes = basis.force_nodes(inside)
            active[nodes.ravel() + 1, layout.force(contact.point)] = True
        for contact in self.contacts:
            nodes = basis.force_nodes(touching_spans(basis, contact.contact))
            if contact.contact.start > basis.breaks[0]:
                active[nodes[0, 0] + 1, layout.force(contact.point)] = False
            if contact.contact.end < basis.breaks[-1]:
                active[nodes[-1, 1] + 1, layout.force(contact.point)] = False
        return active

    def window(self, x: FloatArray, spans: IntArray) -> FloatArray:
        """(R, 4, n_block) the four blocks that act in each span."""
        blocks = self.basis.first_coefficient[spans][:, None] + np.arange(ORDER)
        return np.asarray(x[blocks])

    def rows(self, x: FloatArray, places: FloatArray) -> Rows:
        """Every equation at unknowns x (K, n_block), pins at places (n_contacts, 3) m."""
        parts = [self._balance_at(x), self._moment_rows(x)]
        if self.contacts:
            parts += [self._pin_rows(x, places), self._speed_rows(x)]
        if self.released:
            parts.append(self._release_rows(x))
        rows = Rows.join(parts)
        blocks = self.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
        rows.jacobian[~self.active[blocks]] = 0.0
        return rows

    def residuals(self, x: FloatArray, places: FloatArray) -> FloatArray:
        """The residuals of `rows` alone, cheaper."""
        parts = [self._balance_at(x).residual, self._moment_residual(x).ravel()]
        if self.contacts:
            parts += [self._pin_residual(x, places).ravel(), self._speed_rows(x).residual]
        if self.released:
            parts.append(self._release_rows(x).residual)
        return np.concatenate(parts)

    # -- balance ---------------------------------------------------------------------------

    def _balance_rows(self) -> Rows:
        basis, layout = self.basis, self.layout
        spans = np.arange(basis.n_spans)
        nodes = basis.force_nodes(spans)
        _, first = np.unique(nodes.ravel(), return_index=True)
        span, side = spans[first // 2], first % 2
        times = basis.breaks[span + side]
        second = basis.evaluate(times, 2, span) / GRAVITY
        jacobian = np.zeros((len(span), 3, ORDER, layout.n_block))
        each = np.arange(len(span))
        for axis in range(3):
            jacobian[:, axis, :, axis] = second
            for point in range(layout.n_points):
                jacobian[each, axis, 1 + side, layout.force(point).start + axis] = -1.0
        count = 3 * len(span)
        weight = np.tile([0.0, 0.0, 1.0], len(span))
        return Rows(
            np.repeat(span, 3),
            weight,
            jacobian.reshape(count, ORDER, layout.n_block),
            np.full(count, RowKind.BALANCE),
            np.repeat(times, 3),
            np.full(count, -1),
        )

    def _balance_at(self, x: FloatArray) -> Rows:
        rows = self._balance
        residual = rows.residual + np.einsum("rkn,rkn->r", rows.jacobian, self.window(x, rows.span))
        return Rows(rows.span, residual, rows.jacobian.copy(), rows.kind, rows.time, rows.contact)

    # -- moment ----------------------------------------------------------------------------

    def angles_at_nodes(self, x: FloatArray) -> list[FloatArray]:
        """Joint angles, velocities and accelerations (N, n_angles) at the dynamics nodes."""
        local = self.window(x, self.node_spans)[:, :, self.layout.angles]
        return [np.einsum("nk,nkj->nj", B, local) for B in self._node_basis]

    def forces_at_nodes(self, x: FloatArray) -> FloatArray:
        """(N, P, 3) contact forces in body weights at the dynamics nodes."""
        local = self.window(x, self.node_spans)[:, 1:3, self.layout.forces]
        forces = np.einsum("nk,nkj->nj", self._node_force, local)
        return np.asarray(forces.reshape(len(forces), self.layout.n_points, 3))

    def _moment_residual(self, x: FloatArray) -> FloatArray:
        q, v, a = self.angles_at_nodes(x)
        rate = self.moment.value(q, v, a)
        if not self.points:
            return rate
        arms = pose(self.character, q).points(self.points)
        return np.asarray(rate - np.cross(arms, self.forces_at_nodes(x)).sum(axis=1))

    def _moment_rows(self, x: FloatArray) -> Rows:
        layout = self.layout
        q, v, a = self.angles_at_nodes(x)
        rate, by_order = self.moment.jacobian(q, v, a)
        count = len(q)
        jacobian = np.zeros((count, 3, ORDER, layout.n_block))
        if self.points:
            posed = pose(self.character, q)
            arms, turn = posed.points(self.points), posed.point_jacobian(self.points)
            forces = self.forces_at_nodes(x)
            rate = rate - np.cross(arms, forces).sum(axis=1)
            by_order[:, :, 0] += np.einsum("npij,npjk->nik", cross_matrix(forces), turn)
            lever = -cross_matrix(arms)  # (N, P, 3, 3): d moment / d force
            lever = lever.transpose(0, 2, 1, 3).reshape(count, 3, 3 * layout.n_points)
            for side in range(2):
                weight = self._node_force[:, side]
                jacobian[:, :, 1 + side, layout.forces] = weight[:, None, None] * lever
        stacked = np.stack(self._node_basis, axis=-1)  # (N, 4, 3)
        jacobian[..., layout.angles] = np.einsum("nko,niom->nikm", stacked, by_order)
        return Rows(
            np.repeat(self.node_spans, 3),
            rate.ravel(),
            jacobian.reshape(3 * count, ORDER, layout.n_block),
            np.full(3 * count, RowKind.MOMENT),
            np.repeat(self.node_times, 3),
            np.full(3 * count, -1),
        )

    # -- pins ------------------------------------------------------------------------------

    def _pin_instants(self, *, speed: bool) -> tuple[IntArray, FloatArray]:
        """(contact index, instant) of the pin rows: breaks while pinned, or where speed is zero.

        Speed is held at the pin's ends and at double knots inside, where the spline is only
        once differentiable and each side needs its own end condition.
        """
        index: list[int] = []
        times: list[float] = []
        for i, contact in enumerate(self.contacts):
            slack = 1e-9
            breaks = self.basis.breaks
            inside = (breaks >= contact.pin_start - slack) & (breaks <= contact.pin_end + slack)
            if speed:
                ends = np.isclose(breaks, contact.pin_start) | np.isclose(breaks, contact.pin_end)
                inside &= ends | self.basis.double
            index.extend([i] * int(inside.sum()))
            times.extend(breaks[inside].tolist())
        return np.array(index, dtype=int), np.array(times)

    def _pin_residual(self, x: FloatArray, places: FloatArray) -> FloatArray:
        return self._pin_evaluate(x, places)[0]

    def _pin_evaluate(
        self, x: FloatArray, places: FloatArray
    ) -> tuple[FloatArray, IntArray, FloatArray, IntArray, FloatArray]:
        index, times = self._pin_instants(speed=False)
        spans = self.basis.spans(times)
        values = self.basis.evaluate(times, 0, spans)
        local = np.einsum("nk,nkj->nj", values, self.window(x, spans))
        which = np.array([self.contacts[i].point for i in index])
        arms = pose(self.character, local[:, self.layout.angles]).points(self.points)
        at = local[:, self.layout.com] + arms[np.arange(len(index)), which]
        return at - places[index], index, times, spans, values

    def _pin_rows(self, x: FloatArray, places: FloatArray) -> Rows:
        residual, index, times, spans, values = self._pin_evaluate(x, places)
        local = np.einsum("nk,nkj->nj", values, self.window(x, spans))
        which = np.array([self.contacts[i].point for i in index])
        posed = pose(self.character, local[:, self.layout.angles])
        turn = posed.point_jacobian(self.points)[np.arange(len(index)), which]
        jacobian = np.zeros((len(index), 3, ORDER, self.layout.n_block))
        jacobian[..., self.layout.angles] = values[:, None, :, None] * turn[:, :, None]
        for axis in range(3):
            jacobian[:, axis, :, axis] = values
        return self._contact_rows(residual, jacobian, index, times, spans, RowKind.PIN)

    def _speed_rows(self, x: FloatArray) -> Rows:
        index, times = self._pin_instants(speed=True)
        spans = self.basis.spans(times)
        values, slopes = (self.basis.evaluate(times, k, spans) for k in (0, 1))
        window = self.window(x, spans)
        angles = self.layout.angles
        q, v = (np.einsum("nk,nkj->nj", B, window[:, :, angles]) for B in (values, slopes))
        each, which = np.arange(len(index)), np.array([self.contacts[i].point for i in index])
        speeds, by_angle, by_speed = point_velocity(pose(self.character, q), self.points, v)
        com_speed = np.einsum("nk,nkj->nj", slopes, window[:, :, self.layout.com])
        jacobian = np.zeros((len(index), 3, ORDER, self.layout.n_block))
        for basis, derivative in ((values, by_angle), (slopes, by_speed)):
            jacobian[..., angles] += basis[:, None, :, None] * derivative[each, which][:, :, None]
        for axis in range(3):
            jacobian[:, axis, :, axis] = slopes
        residual = com_speed + speeds[each, which]
        return self._contact_rows(residual, jacobian, index, times, spans, RowKind.PIN_SPEED)

    def _release_rows(self, x: FloatArray) -> Rows:
        layout, basis = self.layout, self.basis
        pairs = np.array(sorted(self.released))
        block = pairs[:, 0] + 1
        last = basis.first_coefficient + 1  # the block of each span's first force node
        span = np.minimum(np.searchsorted(last, block, side="right") - 1, basis.n_spans - 1)
        count = len(pairs)
        jacobian = np.zeros((count, 3, ORDER, layout.n_block))
        local = block - basis.first_coefficient[span]
        residual = np.empty((count, 3))
        for axis in range(3):
            column = layout.forces.start + 3 * pairs[:, 1] + axis
            jacobian[np.arange(count), axis, local, column] = 1.0
            residual[:, axis] = x[block, column]
        return Rows(
            np.repeat(span, 3),
            residual.ravel(),
            jacobian.reshape(3 * count, ORDER, layout.n_block),
            np.full(3 * count, RowKind.RELEASE),
            np.repeat(basis.breaks[span], 3),
            np.full(3 * count, -1),
        )

    def pulling(self, x: FloatArray, tolerance: float) -> frozenset[tuple[int, int]]:
        """(force node, point) pairs whose vertical force pulls by more than tolerance (BW)."""
        vertical = x[1:-1, self.layout.forces].reshape(-1, self.layout.n_points, 3)[:, :, 2]
        nodes, points = np.nonzero(vertical < -tolerance)
        return frozenset(zip(nodes.tolist(), points.tolist(), strict=True))

    def _contact_rows(
        self,
        residual: FloatArray,
        jacobian: FloatArray,
        index: IntArray,
        times: FloatArray,
        spans: IntArray,
        kind: RowKind,
    ) -> Rows:
        count = 3 * len(index)
        return Rows(
            np.repeat(spans, 3),
            residual.ravel(),
            jacobian.reshape(count, ORDER, self.layout.n_block),
            np.full(count, kind),
            np.repeat(times, 3),
            np.repeat(index, 3),
        )


def touching_spans(basis: Basis, contact: Contact) -> IntArray:
    """Indices of the spans during which a contact carries force."""
    middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
    return np.flatnonzero((middles > contact.start) & (middles < contact.end))
