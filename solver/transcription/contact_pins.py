"""Contact pins: equality rows that hold touching points in place (thesis 3.3.2).

While a point is pinned its place is fixed at every break; its velocity is zero at the pin's ends
and at double knots inside, where the spline is only once differentiable and each side needs its own
end condition. These are as many rows as a cubic has freedom, so they stay independent. A place may
move along a path or ride on moving ground (ride.py), and a point may slide along a
surface: then only its height is held.
"""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.kinematics import BodyPoint, Pose, point_velocity
from ..data.constants import DEFAULT_FRICTION, UP
from ..data.contacts import Contact
from ..data.row_kinds import RowKind
from ..numerics.interpolation import interpolate
from ..numerics.rigid_motion import Poses
from ..numerics.splines import ORDER, SplineBasis
from .ride import Ride
from .rows import Layout, Rows, inside

SLACK_RATE = 50.0  # 1/s, of a speed that goes with a slack of places
TINY = 1e-9  # s
VELOCITY_STEP = 1e-3  # s, of the central differences that give a moving place its velocity


def touching_spans(basis: SplineBasis, contact: Contact) -> IntArray:
    """Indices of the spans during which a contact carries force."""
    middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
    return np.flatnonzero((middles > contact.start) & (middles < contact.end))


@dataclass(frozen=True)
class PlaceTrajectory:
    """Trajectory of a moving place: (T,) s and displacements (T, 3) m from the contact's place."""

    times: FloatArray
    moves: FloatArray

    def at(self, times: FloatArray) -> FloatArray:
        """(U, 3) displacements at instants (U,) s, m."""
        return interpolate_places(self.times, self.moves, times)

    def velocity(self, times: FloatArray) -> FloatArray:
        """(U, 3) velocities at instants (U,) s, m/s."""
        both = np.stack([times - VELOCITY_STEP, times + VELOCITY_STEP])
        both = both.clip(self.times[0], self.times[-1])
        before, after = self.at(both.ravel()).reshape(2, -1, 3)
        apart = np.maximum(both[1] - both[0], TINY)  # outside it rests
        return np.asarray((after - before) / apart[:, None])


def interpolate_places(times: FloatArray, places: FloatArray, at: FloatArray) -> FloatArray:
    """(U, 3) interpolation of places (T, 3) at instants (U,) s.

    Cubic where four are known, else linear; constant before the first and after the last.
    """
    inside = np.clip(at, times[0], times[-1])
    if len(times) >= 4:
        return interpolate(times, places, inside)
    columns = [np.interp(inside, times, places[:, k]) for k in range(3)]
    return np.stack(columns, axis=1)


@dataclass(frozen=True)
class PointContact:
    """A contact in the equations; `point` indexes the transcription's points. World axes.

    held: (k, 3) unit directions in which the point is held; None in all. track: trajectory of its
    place, by the scene's clock. ride: on ground that moves. sole: how the point sinks to its place
    along the normal and rises from it (compliant_sole.py). friction: coefficient, None for a grip,
    which may pull as well as push. normal: (3,) of the surface, where the ride begins. pyramid: a
    four-sided friction pyramid inside the cone.
    """

    contact: Contact
    point: int
    held: FloatArray | None = None
    track: PlaceTrajectory | None = None
    ride: Ride | None = None
    sole: PlaceTrajectory | None = None
    friction: float | None = DEFAULT_FRICTION
    normal: FloatArray = field(default_factory=UP.copy)
    pyramid: bool = False

    @property
    def bears_weight(self) -> bool:
        """Whether a weight can rest on it: the vertical is in its friction cone; any on a grip."""
        x, y, z = self.normal
        return self.friction is None or bool(np.hypot(x, y) <= self.friction * z)

    def retimed(self, warp: Callable[[FloatArray], FloatArray]) -> "PointContact":
        """The same contact at other instants; a track's clock stays, as a ride's does.

        warp: new instants (T,) s of old ones.
        """
        start, end = warp(np.array([self.contact.start, self.contact.end])).tolist()
        contact = replace(self.contact, start=start, end=end)
        sole = None if self.sole is None else replace(self.sole, times=warp(self.sole.times))
        ride = None if self.ride is None else self.ride.retimed(warp)
        return replace(self, contact=contact, ride=ride, sole=sole)

    def pin_error(self, at: FloatArray, place: FloatArray, times: FloatArray) -> FloatArray:
        """(T, k) errors of points at (T, 3) against where they are held at instants (T,) s, m.

        place: (3,) m, where the contact's track and ride begin.
        """
        error = at - self.holds(times).of(place)
        return error if self.held is None else np.asarray(error @ self.held.T)

    def holds(self, times: FloatArray) -> Poses:
        """Poses from its place to where the point is held at instants (T,) s."""
        poses = Poses.still(len(times)) if self.ride is None else self.ride.poses(times)
        shift = poses.shift
        if self.track is not None:
            shift = shift + self.track.at(times)
        if self.sole is not None:
            shift = shift + self.sole.at(times)[:, 2:] * (poses.turn @ self.normal)
        return Poses(poses.turn, shift)

    def hold_rates(self, times: FloatArray) -> Poses:
        """Rates of change of `holds`."""
        rates = Poses.resting(len(times)) if self.ride is None else self.ride.rates(times)
        shift = rates.shift
        if self.track is not None:
            shift = shift + self.track.velocity(times)
        if self.sole is not None:
            shift = shift + self.sole.velocity(times)[:, 2:] * self.normals(times)
            shift = shift + self.sole.at(times)[:, 2:] * (rates.turn @ self.normal)
        return Poses(rates.turn, shift)

    def normals(self, times: FloatArray) -> FloatArray:
        """(T, 3) normals of the surface at instants (T,) s; they turn with what it rides on."""
        if self.ride is None:
            return np.tile(self.normal, (len(times), 1))
        return np.asarray(self.ride.poses(times).turn @ self.normal)


def cut_by_seam(contacts: Sequence[PointContact], duration: float) -> list[tuple[int, int]]:
    """Indices of the two parts of each contact that the seam of a motion that repeats cuts: the one
    at its start, and the one at its end."""
    starting = {c.point: i for i, c in enumerate(contacts) if c.contact.start <= 0.0}
    ending = {c.point: i for i, c in enumerate(contacts) if c.contact.end >= duration}
    return [(starting[point], ending[point]) for point in starting if point in ending]


def tied_places(
    places: FloatArray, contacts: Sequence[PointContact], duration: float
) -> FloatArray:
    """Places (n_contacts, 3) m of a motion that repeats: the parts of contacts that its seam cuts
    are equally far apart, level. Each is moved half of the way there."""
    cut = cut_by_seam(contacts, duration)
    if not cut:
        return places
    first, last = np.array(cut).T
    apart = places[last] - places[first]
    common = apart.mean(axis=0) * [1.0, 1.0, 0.0]
    tied = places.copy()
    tied[first] += 0.5 * (apart - common)
    tied[last] -= 0.5 * (apart - common)
    return tied


@dataclass(frozen=True)
class _PinPairs:
    """M pairs of a contact and one of the pins' breaks (`at`) at which it is held.

    point: (M,) of the contact. axes: (M, 3, 3), rows the directions in which it may be held.
    holds: M poses that its place is held at, or their rates. kept: (3 M,) held directions. turned:
    whether any axes are not the world's. slack: (M,) m, or m/s, that count as met.
    """

    contact: IntArray
    at: IntArray
    point: IntArray
    axes: FloatArray
    holds: Poses
    kept: BoolArray
    turned: bool
    slack: FloatArray | float

    def within(self, kept: BoolArray) -> "_PinPairs":
        """Those at some of the breaks, by flags of all of these; breaks are counted among them."""
        mine, slack = kept[self.at], self.slack
        return _PinPairs(
            self.contact[mine],
            (np.cumsum(kept) - 1)[self.at[mine]],
            self.point[mine],
            self.axes[mine],
            Poses(self.holds.turn[mine], self.holds.shift[mine]),
            self.kept[np.repeat(mine, 3)],
            self.turned,
            slack[mine] if isinstance(slack, np.ndarray) else slack,
        )

    def held(self, places: FloatArray) -> FloatArray:
        """(M, 3) where places (n_contacts, 3) m are held, m, or how fast that goes, m/s."""
        return self.holds.of(places[self.contact])


class Pins:
    """Pin rows on one basis. times, spans: (U,) the breaks at which anything is pinned."""

    def __init__(
        self, basis: SplineBasis, layout: Layout, contacts: Sequence[PointContact]
    ) -> None:
        self.layout = layout
        slack, breaks = 1e-9, basis.breaks
        span = np.array([(c.contact.start, c.contact.end) for c in contacts]).reshape(-1, 2)
        start, end = span[:, :1], span[:, 1:]
        pinned = (breaks >= start - slack) & (breaks <= end + slack)
        ends = np.isclose(breaks, start) | np.isclose(breaks, end)
        used = np.flatnonzero(pinned.any(axis=0))
        self.times = basis.breaks[used]
        self.spans = basis.spans(self.times)
        self._basis = [basis.evaluate(self.times, k, self.spans) for k in (0, 1)]
        self._position = self._pairs(pinned[:, used], contacts, velocity=False)
        self._velocity = self._pairs(
            (pinned & (ends | basis.double))[:, used], contacts, velocity=True
        )

    def _pairs(
        self, which: BoolArray, contacts: Sequence[PointContact], *, velocity: bool
    ) -> _PinPairs:
        contact, at = np.nonzero(which)
        axes, kept = np.tile(np.eye(3), (len(contact), 1, 1)), np.ones((len(contact), 3), bool)
        holds = Poses(np.zeros((len(contact), 3, 3)), np.zeros((len(contact), 3)))
        for i, each in enumerate(contacts):
            mine = contact == i
            when = self.times[at[mine]]
            poses = each.hold_rates(when) if velocity else each.holds(when)
            holds.turn[mine], holds.shift[mine] = poses.turn, poses.shift
            if each.held is not None:
                count = len(each.held)
                axes[mine, :count], kept[mine, count:] = each.held, False
        point = np.array([c.point for c in contacts], dtype=int)[contact]
        turned = any(c.held is not None for c in contacts)
        slack = np.array([c.contact.slack for c in contacts])[contact] if len(contact) else 0.0
        slack = slack * (SLACK_RATE if velocity else 1.0)
        return _PinPairs(contact, at, point, axes, holds, kept.ravel(), turned, slack)

    def within(self, spans: slice) -> "Pins":
        """Those in some of the spans."""
        twin, kept = copy(self), inside(self.spans, spans)
        twin.times, twin.spans = self.times[kept], self.spans[kept]
        twin._basis = [each[kept] for each in self._basis]
        twin._position, twin._velocity = self._position.within(kept), self._velocity.within(kept)
        return twin

    def angles(self, window: FloatArray) -> FloatArray:
        """(U, n_angles) joint angles at the pins' breaks, rad; window (U, 4, n_block)."""
        return np.asarray(np.einsum("uk,ukj->uj", self._basis[0], window[:, :, self.layout.angles]))

    def values(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> FloatArray:
        """Values of `rows`, in their order, without the Jacobian."""
        error = self._error(window, posed, points, places).ravel()[self._position.kept]
        some, back = np.unique(self._velocity.at, return_inverse=True)
        velocities = posed.at(some).point_rates(points, self._angle_velocities(window)[some])
        drift = self._drift(window, velocities[back, self._velocity.point], places)
        return np.concatenate([error, drift.ravel()[self._velocity.kept]])

    def moved(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """Change of `values` where places (n_contacts, 3) m go from before to after."""
        changes = []
        for held in (self._position, self._velocity):
            apart = held.held(before) - held.held(after)
            changes.append(np.einsum("mij,mj->mi", held.axes, apart).ravel()[held.kept])
        return np.concatenate(changes)

    def rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> list[Rows]:
        """Rows of position (m) and of velocity (m/s).

        window: (U, 4, n_block) of the unknowns, and posed: the figure, at the pins' breaks. places:
        (n_contacts, 3) m, world.
        """
        return [
            self._position_rows(window, posed, points, places),
            self._velocity_rows(window, posed, points, places),
        ]

    def _error(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> FloatArray:
        held = self._position
        com = np.einsum("uk,ukj->uj", self._basis[0], window[:, :, self.layout.com])
        at = com[held.at] + posed.points(points)[held.at, held.point]
        return np.asarray(np.einsum("mij,mj->mi", held.axes, at - held.held(places)))

    def _drift(self, window: FloatArray, velocities: FloatArray, places: FloatArray) -> FloatArray:
        held = self._velocity
        com = np.einsum("uk,ukj->uj", self._basis[1], window[:, :, self.layout.com])
        return np.asarray(
            np.einsum("mij,mj->mi", held.axes, com[held.at] + velocities - held.held(places))
        )

    def _angle_velocities(self, window: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("uk,ukj->uj", self._basis[1], window[:, :, self.layout.angles]))

    def _position_rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> Rows:
        held = self._position
        value = self._basis[0][held.at]
        turn = posed.point_jacobian(points)[held.at, held.point]
        jacobian = self._empty(held)
        jacobian[..., self.layout.angles] = value[:, None, :, None] * turn[:, :, None]
        for axis in range(3):
            jacobian[:, axis, :, self.layout.com.start + axis] = value
        error = self._error(window, posed, points, places)
        return self._rows(held, error, jacobian, RowKind.PIN)

    def _velocity_rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> Rows:
        held = self._velocity
        some, back = np.unique(held.at, return_inverse=True)
        few = posed.at(some)
        found = point_velocity(few, points, self._angle_velocities(window)[some])
        each = (back, held.point)
        jacobian = self._empty(held)
        for basis, derivative in zip(self._basis, found[1:], strict=True):
            jacobian[..., self.layout.angles] += (
                basis[held.at][:, None, :, None] * derivative[each][:, :, None]
            )
        for axis in range(3):
            jacobian[:, axis, :, self.layout.com.start + axis] = self._basis[1][held.at]
        drift = self._drift(window, found[0][each], places)
        return self._rows(held, drift, jacobian, RowKind.PIN_SPEED)

    def _empty(self, held: _PinPairs) -> FloatArray:
        return np.zeros((len(held.at), 3, ORDER, self.layout.n_block))

    def _rows(
        self, held: _PinPairs, value: FloatArray, jacobian: FloatArray, kind: RowKind
    ) -> Rows:
        if held.turned:
            jacobian = np.einsum("mij,mjkn->mikn", held.axes, jacobian)
        spans, times = self.spans[held.at], self.times[held.at]
        rows = Rows.of(spans, value, jacobian, kind, times, held.contact, slack=held.slack)
        return rows.some(held.kept) if held.turned else rows
