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

from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

from .character import Character
from .contacts import Contact
from .dynamics import GRAVITY, MomentFunction
from .kinematics import BodyPoint, Pose, pose
from .pins import Pins, PointContact
from .recording import BoolArray, FloatArray, IntArray
from .rotations import cross_matrix
from .rows import Layout, RowKind, Rows
from .splines import ORDER, Basis, gauss_instants

GAUSS = 3  # dynamics nodes a span
SETTLE = 0.03  # s


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
        self.pins = Pins(self.basis, self.layout, self.contacts)

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
        at_nodes, at_pins = self._poses(x)
        parts = [self._balance_at(x), self._moment_rows(x, at_nodes)]
        if self.contacts:
            window = self.window(x, self.pins.spans)
            parts += self.pins.rows(window, at_pins, self.points, places)
        if self.released:
            parts.append(self._release_rows(x))
        return self._only_active(Rows.join(parts))

    def residuals(self, x: FloatArray, places: FloatArray) -> FloatArray:
        """The residuals of `rows` alone, cheaper."""
        at_nodes, at_pins = self._poses(x)
        parts = [self._balance_residual(x), self._moment_residual(x, at_nodes).ravel()]
        if self.contacts:
            window = self.window(x, self.pins.spans)
            parts.append(self.pins.residuals(window, at_pins, self.points, places))
        if self.released:
            parts.append(self._release_rows(x).residual)
        return np.concatenate(parts)

    def release(self, pairs: frozenset[tuple[int, int]]) -> "Transcription":
        """These equations with the forces of (force node, point) pairs held at zero as well."""
        twin = copy(self)
        twin.released = self.released | pairs
        return twin

    def _only_active(self, rows: Rows) -> Rows:
        blocks = self.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
        rows.jacobian[~self.active[blocks]] = 0.0
        return rows

    def _poses(self, x: FloatArray) -> tuple[Pose, Pose]:
        """The figure at the dynamics nodes and at the pins' breaks, worked out together."""
        q = self.angles_at_nodes(x, 0)
        pinned = self.pins.angles(self.window(x, self.pins.spans))
        posed = pose(self.character, np.concatenate([q, pinned]))
        return posed.at(slice(0, len(q))), posed.at(slice(len(q), None))

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
        weight = np.tile([0.0, 0.0, 1.0], (len(span), 1))
        return self._only_active(Rows.triples(span, weight, jacobian, RowKind.BALANCE, times))

    def _balance_residual(self, x: FloatArray) -> FloatArray:
        rows = self._balance
        local = self.window(x, rows.span)
        return np.asarray(rows.residual + np.einsum("rkn,rkn->r", rows.jacobian, local))

    def _balance_at(self, x: FloatArray) -> Rows:
        return replace(self._balance, residual=self._balance_residual(x))

    # -- moment ----------------------------------------------------------------------------

    def angles_at_nodes(self, x: FloatArray, derivative: int) -> FloatArray:
        """(N, n_angles) joint angles, or their derivative, at the dynamics nodes."""
        local = self.window(x, self.node_spans)[:, :, self.layout.angles]
        return np.asarray(np.einsum("nk,nkj->nj", self._node_basis[derivative], local))

    def forces_at_nodes(self, x: FloatArray) -> FloatArray:
        """(N, P, 3) contact forces in body weights at the dynamics nodes."""
        local = self.window(x, self.node_spans)[:, 1:3, self.layout.forces]
        forces = np.einsum("nk,nkj->nj", self._node_force, local)
        return np.asarray(forces.reshape(len(forces), self.layout.n_points, 3))

    def _moment_residual(self, x: FloatArray, posed: Pose) -> FloatArray:
        rate = self.moment.value(*(self.angles_at_nodes(x, k) for k in range(3)))
        if not self.points:
            return rate
        arms = posed.points(self.points)
        return np.asarray(rate - np.cross(arms, self.forces_at_nodes(x)).sum(axis=1))

    def _moment_rows(self, x: FloatArray, posed: Pose) -> Rows:
        layout = self.layout
        rate, by_order = self.moment.jacobian(*(self.angles_at_nodes(x, k) for k in range(3)))
        count = len(rate)
        jacobian = np.zeros((count, 3, ORDER, layout.n_block))
        if self.points:
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
        return Rows.triples(self.node_spans, rate, jacobian, RowKind.MOMENT, self.node_times)

    # -- releases --------------------------------------------------------------------------

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
        times = basis.breaks[span]
        return Rows.triples(span, residual, jacobian, RowKind.RELEASE, times)

    def pulling(self, x: FloatArray, tolerance: float) -> frozenset[tuple[int, int]]:
        """(force node, point) pairs whose vertical force pulls by more than tolerance (BW)."""
        vertical = x[1:-1, self.layout.forces].reshape(-1, self.layout.n_points, 3)[:, :, 2]
        nodes, points = np.nonzero(vertical < -tolerance)
        return frozenset(zip(nodes.tolist(), points.tolist(), strict=True))


def touching_spans(basis: Basis, contact: Contact) -> IntArray:
    """Indices of the spans during which a contact carries force."""
    middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
    return np.flatnonzero((middles > contact.start) & (middles < contact.end))
