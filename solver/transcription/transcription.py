"""Direct transcription: the motion as finitely many unknowns and constraint rows (thesis 4).

Unknowns: coefficients of the centre of mass (m) and of the joint angles (rad) as cubic splines,
and the contact forces (body weights) as piecewise linear functions. Rows:

balance   c'' / g + z - sum f = 0 at every force node: with the matching bases it then holds at
          *every* instant, exactly (both sides are piecewise linear)
moment    L'(theta) - sum (p_i - c) x f_i = 0 at three Gauss points a span (collocation)
pin       c + p_i(theta) - place = 0 at every break while a point is pinned, and zero velocity at
          the ends: as many rows as a cubic has freedom, so that they stay independent
push      forces push and stay in their friction cones, at every force node and so at every
          instant: both sets are convex (friction_cones.py)
others    the artist's constraints (constraint.py)
guards    what the motion must not do either, where it would (guard_rows.py)

A point is pinned while it carries force; at a landing and a lift-off its place gives as soles do
(compliant_sole.py). Each point's force begins and ends at zero, and accelerations may jump only
where the body lands or leaves as a whole: so the forces' sum is continuous within a stance.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.character import Character
from ..body.dynamics import MomentFunction
from ..body.kinematics import BodyPoint, LastPose, Pose
from ..data.constants import STANDARD_GRAVITY
from ..data.row_kinds import RowKind
from ..numerics.rotations import cross_matrix
from ..numerics.seam import Seam
from ..numerics.splines import ORDER, SplineBasis, gauss_instants
from ..unseen.support_force import N_POINTS, SupportForce
from .constraint import Constraint, DiscretisedConstraint
from .contact_pins import Pins, PointContact, cut_by_seam, touching_spans
from .friction_cones import FrictionCones
from .guard_rows import GuardRows
from .ride import Ride
from .rows import FORCE_BLOCKS, Layout, Rows, inside
from .sampling import ChannelJacobian, Instants

GAUSS_NODES = 3  # dynamics nodes a span


@dataclass
class Transcription:
    """Constraint rows of one motion problem on one basis.

    points: the bodies' points on which forces act: those that touch, then those of the support.
    contacts: when and where they touch. moment: the rate of angular momentum about the centre of
    mass. support: what carries the body where nothing that is known does. guards: at most one of a
    kind. active: which unknowns exist. discretised: the constraints on this basis, guards last.
    periodic: whether the motion repeats, so that its last instant is tied to its first (`seam`).
    course: x and y of the direction in which it then goes, where no contact that the seam cuts says
    so; None any.
    """

    character: Character
    basis: SplineBasis
    points: tuple[BodyPoint, ...]
    contacts: tuple[PointContact, ...]
    moment: MomentFunction
    constraints: tuple[Constraint, ...] = ()
    guards: tuple[GuardRows, ...] = ()
    periodic: bool = False
    course: tuple[float, float] | None = None
    support: SupportForce | None = None
    seam: Seam | None = field(init=False)
    layout: Layout = field(init=False)
    active: BoolArray = field(init=False)  # (K, n_block)

    def __post_init__(self) -> None:
        self.layout = Layout(self.character.n_angles, len(self.points))
        self.active = self._active()
        self.seam = self._seam() if self.periodic else None
        times, self.node_weights, self.node_spans = gauss_instants(self.basis.breaks, GAUSS_NODES)
        self.node_times = times
        self._node_basis = [self.basis.evaluate(times, k, self.node_spans) for k in range(3)]
        self._node_force = self.basis.force_weights(times, self.node_spans)
        self._posed = LastPose(self.character)
        self._balance = self._balance_rows()
        self.pins = Pins(self.basis, self.layout, self.contacts)
        self.cones = FrictionCones(self.basis, self.layout, self.contacts)
        first = len(self.contacts)
        self.discretised = [
            DiscretisedConstraint(constraint, self.character, self.basis, self.layout, first + i)
            for i, constraint in enumerate(self.constraints)
        ]
        self.discretised += self._discretised(self.guards)

    def _discretised(self, guards: tuple[GuardRows, ...]) -> list[DiscretisedConstraint]:
        made, first = [], len(self.contacts) + len(self.constraints)
        for guard in guards:
            owners = first + guard.items
            made.append(
                DiscretisedConstraint(guard, self.character, self.basis, self.layout, owners)
            )
            first += len(guard.names)
        return made

    def guarded(self, guards: tuple[GuardRows, ...]) -> "Transcription":
        """The same with other guards; bounds that are relaxed stay so."""
        twin = copy(self)
        twin.guards = guards
        asked = self.discretised[: len(self.constraints)]
        twin.discretised = [*asked, *self._discretised(guards)]
        return twin

    def within(self, spans: slice) -> "Transcription":
        """The same with the rows of some spans alone. Only unknowns exist that act in no others.

        For a step in a part (local_steps.py), without seam; `guards` are those of the whole.
        """
        twin, basis = copy(self), self.basis
        twin.seam = None
        first = basis.first_coefficient
        begin = first[spans.start - 1] + ORDER if spans.start else 0
        end = first[spans.stop] if spans.stop < basis.n_spans else basis.n_coefficients
        twin.active = np.zeros_like(self.active)
        twin.active[begin:end] = self.active[begin:end]
        nodes = slice(GAUSS_NODES * spans.start, GAUSS_NODES * spans.stop)
        twin.node_times, twin.node_spans = self.node_times[nodes], self.node_spans[nodes]
        twin.node_weights = self.node_weights[nodes]
        twin._node_basis = [each[nodes] for each in self._node_basis]
        twin._node_force = self._node_force[nodes]
        twin._balance = self._balance.some(inside(self._balance.span, spans))
        twin.pins, twin.cones = self.pins.within(spans), self.cones.within(spans)
        parts = [each.within(spans) for each in self.discretised]
        twin.discretised = [each for each in parts if len(each.instants.times)]
        return twin

    @property
    def spans(self) -> slice:
        """That it has rows of."""
        return slice(int(self.node_spans[0]), int(self.node_spans[-1]) + 1)

    @property
    def blocks(self) -> slice:
        """Blocks of unknowns that act in its spans."""
        first = self.basis.first_coefficient
        return slice(int(first[self.spans.start]), int(first[self.spans.stop - 1]) + ORDER)

    @property
    def owners(self) -> tuple[str, ...]:
        """Names of the rows' owners: contacts, then constraints, then the guards' items."""
        contacts = tuple(c.contact.name for c in self.contacts)
        guarded = tuple(name for guard in self.guards for name in guard.names)
        return (*contacts, *(c.name for c in self.constraints), *guarded)

    def guard(self, kind: RowKind) -> GuardRows | None:
        """The guard rows of a kind."""
        return next((guard for guard in self.guards if guard.kind is kind), None)

    def relaxed(self, x: FloatArray, share: float) -> "Transcription":
        """Homotopy: bounds that x (K, n_block) violates lie `share` of the way to their own."""
        twin = copy(self)
        twin.discretised = [each.relaxed(x, share) for each in self.discretised]
        return twin

    def retimed(self, warp: Callable[[FloatArray], FloatArray]) -> "Transcription":
        """The same unknowns at other instants, without the artist's constraints.

        Control points and force values stay where they are in their phase. warp: new instants
        (T,) s of old ones, ascending.
        """
        basis = replace(self.basis, breaks=warp(self.basis.breaks))
        contacts = tuple(contact.retimed(warp) for contact in self.contacts)
        support = None if self.support is None else self.support.retimed(warp)
        return replace(
            self, basis=basis, contacts=contacts, support=support, constraints=(), guards=()
        )

    def riding(self, rides: Sequence[Ride | None]) -> "Transcription":
        """The same unknowns with contacts (n_contacts,) that ride on moving ground."""
        contacts = tuple(
            replace(contact, ride=ride) for contact, ride in zip(self.contacts, rides, strict=True)
        )
        return replace(self, contacts=contacts)

    @property
    def touching(self) -> tuple[BodyPoint, ...]:
        """The bodies' points that touch."""
        return self.points[: self.layout.n_points - self.n_support]

    @property
    def n_support(self) -> int:
        """How many points the unseen support acts on; they are the last."""
        return 0 if self.support is None else N_POINTS

    @property
    def support_columns(self) -> slice:
        """Columns of a block that hold the unseen support's forces."""
        return slice(self.layout.n_block - 3 * self.n_support, self.layout.n_block)

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
            active[layout.force_block(nodes.ravel()), layout.force(contact.point)] = True
        for contact in self.contacts:
            nodes = basis.force_nodes(touching_spans(basis, contact.contact))
            if contact.contact.start > basis.breaks[0]:
                active[layout.force_block(nodes[0, 0]), layout.force(contact.point)] = False
            if contact.contact.end < basis.breaks[-1]:
                active[layout.force_block(nodes[-1, 1]), layout.force(contact.point)] = False
        if self.support is not None:
            self._let_support(active, self.support)
        return active

    def _let_support(self, active: BoolArray, support: SupportForce) -> None:
        """Likewise what carries unseen."""
        basis, columns = self.basis, self.support_columns
        for spans in support.spans(basis):
            nodes = basis.force_nodes(spans)
            active[self.layout.force_block(nodes.ravel()), columns] = True
            if spans[0] > 0:
                active[self.layout.force_block(nodes[0, 0]), columns] = False
            if spans[-1] < basis.n_spans - 1:
                active[self.layout.force_block(nodes[-1, 1]), columns] = False

    def _seam(self) -> Seam:
        """Pose, velocities, the joints' accelerations and forces of a motion that repeats.

        The centre of mass has gone somewhere, level: how far is for the solver to say, or for
        contacts that the seam cuts. Its acceleration follows from the forces.
        """
        layout, each = self.layout, np.eye(self.layout.n_block)
        com, angles = each[layout.com], each[layout.angles]
        same = [com[2:], angles]
        if self.course is not None and not cut_by_seam(self.contacts, self.basis.breaks[-1]):
            x, y = self.course
            same.append((x * com[1] - y * com[0])[None])
        smooth = [np.concatenate(same), np.concatenate([com, angles]), angles]
        forces = range(layout.forces.start, layout.forces.stop)
        return Seam.of(self.basis, self.active, smooth, forces)

    def window(self, x: FloatArray, spans: IntArray) -> FloatArray:
        """(R, 4, n_block) the four blocks of x (K, n_block) that act in each span (R,)."""
        blocks = self.basis.first_coefficient[spans][:, None] + np.arange(ORDER)
        return np.asarray(x[blocks])

    def rows(self, x: FloatArray, places: FloatArray) -> Rows:
        """Every row at unknowns x (K, n_block), pins at places (n_contacts, 3) m, world."""
        at_nodes, at_pins = self._poses(x)
        parts = [self._balance_at(x), self._moment_rows(x, at_nodes)]
        if self.contacts:
            window = self.window(x, self.pins.spans)
            parts += self.pins.rows(window, at_pins, self.points, places)
            parts += self.cones.rows(x)
        parts += [each.rows(x) for each in self.discretised]
        return self._only_active(Rows.join(parts))

    def guard_rows(self, x: FloatArray) -> Rows:
        """The guard rows alone; they are the last of `rows`. There must be some."""
        return Rows.join([each.rows(x) for each in self.discretised[-len(self.guards) :]])

    def values(self, x: FloatArray, places: FloatArray) -> FloatArray:
        """(R,) values of `rows` without their Jacobian."""
        at_nodes, at_pins = self._poses(x)
        parts = [self._balance_residual(x), self._moment_residual(x, at_nodes).ravel()]
        if self.contacts:
            window = self.window(x, self.pins.spans)
            parts.append(self.pins.values(window, at_pins, self.points, places))
            parts.append(self.cones.values(x))
        parts += [each.value(x) for each in self.discretised]
        return np.concatenate(parts)

    def moved(self, values: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
        """(R,) `values` where the places (n_contacts, 3) m go from before to after, x staying."""
        moved, first = values.copy(), len(self._balance.value) + 3 * len(self.node_times)
        if self.contacts:
            change = self.pins.moved(before, after)
            moved[first : first + len(change)] += change
        return moved

    def assemble(self, instants: Instants, jacobians: list[ChannelJacobian]) -> FloatArray:
        """(U, m, 4, n_block) Jacobian by the unknowns that exist in each instant's blocks."""
        jacobian = instants.assemble(jacobians, self.layout)
        jacobian *= self.active[instants.blocks][:, None]
        return jacobian

    def _only_active(self, rows: Rows) -> Rows:
        blocks = self.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)
        rows.jacobian[~self.active[blocks]] = 0.0
        return rows

    def pose_at_nodes(self, x: FloatArray) -> Pose:
        """The figure at the dynamics nodes, relative to the centre of mass."""
        return self._poses(x)[0]

    def _poses(self, x: FloatArray) -> tuple[Pose, Pose]:
        """Forward kinematics at the dynamics nodes and at the pins' breaks, evaluated together."""
        q = self.angles_at_nodes(x, 0)
        pinned = self.pins.angles(self.window(x, self.pins.spans))
        posed = self._posed(np.concatenate([q, pinned]))
        return posed.at(slice(0, len(q))), posed.at(slice(len(q), None))

    # -- balance ---------------------------------------------------------------------------

    def _balance_rows(self) -> Rows:
        basis, layout = self.basis, self.layout
        spans = np.arange(basis.n_spans)
        nodes = basis.force_nodes(spans)
        _, first = np.unique(nodes.ravel(), return_index=True)
        span, side = spans[first // 2], first % 2
        times = basis.breaks[span + side]
        second = basis.evaluate(times, 2, span) / STANDARD_GRAVITY
        jacobian = np.zeros((len(span), 3, ORDER, layout.n_block))
        each = np.arange(len(span))
        for axis in range(3):
            jacobian[:, axis, :, layout.com.start + axis] = second
            for point in range(layout.n_points):
                jacobian[
                    each, axis, FORCE_BLOCKS.start + side, layout.force(point).start + axis
                ] = -1.0
        weight = np.tile([0.0, 0.0, self.character.gravity / STANDARD_GRAVITY], (len(span), 1))
        return self._only_active(Rows.of(span, weight, jacobian, RowKind.BALANCE, times))

    def _balance_residual(self, x: FloatArray) -> FloatArray:
        rows = self._balance
        local = self.window(x, rows.span)
        return np.asarray(rows.value + np.einsum("rkn,rkn->r", rows.jacobian, local))

    def _balance_at(self, x: FloatArray) -> Rows:
        return replace(self._balance, value=self._balance_residual(x))

    # -- moment ----------------------------------------------------------------------------

    def angles_at_nodes(self, x: FloatArray, derivative: int) -> FloatArray:
        """(N, n_angles) joint angles, rad, or their derivative at the dynamics nodes."""
        local = self.window(x, self.node_spans)[:, :, self.layout.angles]
        return np.asarray(np.einsum("nk,nkj->nj", self._node_basis[derivative], local))

    def forces_at_nodes(self, x: FloatArray) -> FloatArray:
        """(N, P, 3) contact forces at the dynamics nodes, body weights, world."""
        local = self.window(x, self.node_spans)[:, FORCE_BLOCKS, self.layout.forces]
        forces = np.einsum("nk,nkj->nj", self._node_force, local)
        return np.asarray(forces.reshape(len(forces), self.layout.n_points, 3))

    def _moment_residual(self, x: FloatArray, posed: Pose) -> FloatArray:
        rate = self.moment.value_at(posed, *(self.angles_at_nodes(x, k) for k in (1, 2)))
        if not self.points:
            return rate
        arms = posed.points(self.points)
        return np.asarray(rate - np.cross(arms, self.forces_at_nodes(x)).sum(axis=1))

    def _moment_rows(self, x: FloatArray, posed: Pose) -> Rows:
        layout = self.layout
        rate, by_order = self.moment.jacobian_at(
            posed, *(self.angles_at_nodes(x, k) for k in (1, 2))
        )
        count = len(rate)
        jacobian = np.zeros((count, 3, ORDER, layout.n_block))
        if self.points:
            arms, turn = posed.points(self.points), posed.point_jacobian(self.points)
            forces = self.forces_at_nodes(x)
            rate = rate - np.cross(arms, forces).sum(axis=1)
            pull = cross_matrix(forces).swapaxes(1, 2).reshape(count, 3, 3 * layout.n_points)
            by_order[:, :, 0] += pull @ turn.reshape(count, 3 * layout.n_points, layout.n_angles)
            lever = -cross_matrix(arms)  # (N, P, 3, 3): d moment / d force
            lever = lever.transpose(0, 2, 1, 3).reshape(count, 3, 3 * layout.n_points)
            for side in range(2):
                weight = self._node_force[:, side]
                jacobian[:, :, FORCE_BLOCKS.start + side, layout.forces] = (
                    weight[:, None, None] * lever
                )
        stacked = np.stack(self._node_basis, axis=-1)[:, None]  # (N, 1, 4, 3)
        np.matmul(stacked, by_order, out=jacobian[..., layout.angles])
        return Rows.of(self.node_spans, rate, jacobian, RowKind.MOMENT, self.node_times)
