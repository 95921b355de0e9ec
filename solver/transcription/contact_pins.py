"""The equations that hold touching points still, or on what carries them (thesis 3.3.2).

While a point is pinned its place is fixed at every break; its speed is zero at the pin's ends and
at double knots inside, where the spline is only once differentiable and each side needs its own
end condition. These are as many rows as a cubic has freedom, so they stay independent. A place may
move (a lift, a swing), and a point may slide along a surface: then only its height is held.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.kinematics import BodyPoint, Pose, point_velocity
from ..data.contacts import Contact
from ..data.row_kinds import RowKind
from ..numerics.interpolation import interpolate
from ..numerics.splines import ORDER, SplineBasis
from .rows import Layout, Rows

FRICTION = 1.0  # of a rubber sole on a hall's floor
STEP = 1e-3  # s, of the differences that give a moving place its speed


@dataclass(frozen=True)
class Track:
    """A place that moves: (T,) s and displacements (T, 3) m from the contact's place."""

    times: FloatArray
    moves: FloatArray

    def at(self, times: FloatArray) -> FloatArray:
        """(U, 3) m, smooth between the instants."""
        return between(self.times, self.moves, times)

    def speed(self, times: FloatArray) -> FloatArray:
        """(U, 3) m/s."""
        first, last = self.times[0], self.times[-1]
        before, after = (np.clip(times + step, first, last) for step in (-STEP, STEP))
        return np.asarray((self.at(after) - self.at(before)) / (after - before)[:, None])


def between(times: FloatArray, places: FloatArray, at: FloatArray) -> FloatArray:
    """(U, 3) places of (T, 3) at instants (U,): cubic where four are known, else linear; still
    before the first and after the last."""
    inside = np.clip(at, times[0], times[-1])
    if len(times) >= 4:
        return interpolate(times, places, inside)
    columns = [np.interp(inside, times, places[:, k]) for k in range(3)]
    return np.stack(columns, axis=1)


@dataclass(frozen=True)
class PointContact:
    """A contact as the equations see it: `point` indexes the transcription's points.

    held: (k, 3) unit directions in which the point is held; None in all. track: how its place
    moves. friction: coefficient, None for a grip, which may pull as well as push. normal: (3,) of
    what it touches. pyramid: whether the friction cone is four planes inside the round one.
    """

    contact: Contact
    point: int
    pin_start: float
    pin_end: float
    held: FloatArray | None = None
    track: Track | None = None
    friction: float | None = FRICTION
    normal: FloatArray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    pyramid: bool = False

    def off(self, at: FloatArray, place: FloatArray, times: FloatArray) -> FloatArray:
        """(T, k) how far points at (T, 3) are from where they are held at instants (T,), m.

        place: (3,) m, where the contact's track begins.
        """
        off = at - place
        if self.track is not None:
            off = off - self.track.at(times)
        return off if self.held is None else np.asarray(off @ self.held.T)


@dataclass(frozen=True)
class _Held:
    """Which contact is held at which of the pins' breaks, as M pairs; point: what it holds.

    axes: (M, 3, 3) rows the directions in which it may be held; moves: (M, 3) how far its place
    is from where it began, or how fast that moves; kept: (3 M,) which directions are held.
    """

    contact: IntArray
    at: IntArray
    point: IntArray
    axes: FloatArray
    moves: FloatArray
    kept: BoolArray
    turned: bool


class Pins:
    """Pin rows on one basis. times: (U,) the breaks at which anything is pinned."""

    def __init__(
        self, basis: SplineBasis, layout: Layout, contacts: Sequence[PointContact]
    ) -> None:
        self.layout = layout
        slack = 1e-9
        pinned = np.array(
            [
                (basis.breaks >= c.pin_start - slack) & (basis.breaks <= c.pin_end + slack)
                for c in contacts
            ],
            dtype=bool,
        ).reshape(len(contacts), len(basis.breaks))
        ends = np.array(
            [
                np.isclose(basis.breaks, c.pin_start) | np.isclose(basis.breaks, c.pin_end)
                for c in contacts
            ],
            dtype=bool,
        ).reshape(pinned.shape)
        used = np.flatnonzero(pinned.any(axis=0))
        self.times = basis.breaks[used]
        self.spans = basis.spans(self.times)
        self._basis = [basis.evaluate(self.times, k, self.spans) for k in (0, 1)]
        self._place = self._held(pinned[:, used], contacts, speed=False)
        self._speed = self._held((pinned & (ends | basis.double))[:, used], contacts, speed=True)

    def _held(self, which: BoolArray, contacts: Sequence[PointContact], *, speed: bool) -> _Held:
        contact, at = np.nonzero(which)
        axes, kept = np.tile(np.eye(3), (len(contact), 1, 1)), np.ones((len(contact), 3), bool)
        moves = np.zeros((len(contact), 3))
        for i, each in enumerate(contacts):
            mine = contact == i
            if each.track is not None:
                times = self.times[at[mine]]
                moves[mine] = each.track.speed(times) if speed else each.track.at(times)
            if each.held is not None:
                count = len(each.held)
                axes[mine, :count], kept[mine, count:] = each.held, False
        point = np.array([c.point for c in contacts], dtype=int)[contact]
        turned = any(c.held is not None for c in contacts)
        return _Held(contact, at, point, axes, moves, kept.ravel(), turned)

    def angles(self, window: FloatArray) -> FloatArray:
        """(U, n_angles) joint angles at the pins' breaks, from the unknowns' windows there."""
        return np.asarray(np.einsum("uk,ukj->uj", self._basis[0], window[:, :, self.layout.angles]))

    def values(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> FloatArray:
        """The values of `rows`, in their order."""
        speeds = point_velocity(posed, points, self._angle_speeds(window))[0]
        off = self._off(window, posed, points, places).ravel()[self._place.kept]
        drift = self._drift(window, speeds[self._speed.at, self._speed.point])
        return np.concatenate([off, drift.ravel()[self._speed.kept]])

    def rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> list[Rows]:
        """Rows of place and of speed. window: (U, 4, n_block); posed: at the pins' breaks."""
        return [
            self._place_rows(window, posed, points, places),
            self._speed_rows(window, posed, points),
        ]

    def _off(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> FloatArray:
        held = self._place
        com = np.einsum("uk,ukj->uj", self._basis[0], window[:, :, self.layout.com])
        at = com[held.at] + posed.points(points)[held.at, held.point]
        return np.asarray(
            np.einsum("mij,mj->mi", held.axes, at - places[held.contact] - held.moves)
        )

    def _drift(self, window: FloatArray, speeds: FloatArray) -> FloatArray:
        held = self._speed
        com = np.einsum("uk,ukj->uj", self._basis[1], window[:, :, self.layout.com])
        return np.asarray(np.einsum("mij,mj->mi", held.axes, com[held.at] + speeds - held.moves))

    def _angle_speeds(self, window: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("uk,ukj->uj", self._basis[1], window[:, :, self.layout.angles]))

    def _place_rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> Rows:
        held = self._place
        value = self._basis[0][held.at]
        turn = posed.point_jacobian(points)[held.at, held.point]
        jacobian = self._empty(held)
        jacobian[..., self.layout.angles] = value[:, None, :, None] * turn[:, :, None]
        for axis in range(3):
            jacobian[:, axis, :, axis] = value
        off = self._off(window, posed, points, places)
        return self._rows(held, off, jacobian, RowKind.PIN)

    def _speed_rows(self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint]) -> Rows:
        held = self._speed
        some, back = np.unique(held.at, return_inverse=True)
        few = posed.at(some)
        found = point_velocity(few, points, self._angle_speeds(window)[some])
        each = (back, held.point)
        jacobian = self._empty(held)
        for basis, derivative in zip(self._basis, found[1:], strict=True):
            jacobian[..., self.layout.angles] += (
                basis[held.at][:, None, :, None] * derivative[each][:, :, None]
            )
        for axis in range(3):
            jacobian[:, axis, :, axis] = self._basis[1][held.at]
        drift = self._drift(window, found[0][each])
        return self._rows(held, drift, jacobian, RowKind.PIN_SPEED)

    def _empty(self, held: _Held) -> FloatArray:
        return np.zeros((len(held.at), 3, ORDER, self.layout.n_block))

    def _rows(self, held: _Held, value: FloatArray, jacobian: FloatArray, kind: RowKind) -> Rows:
        if held.turned:
            jacobian = np.einsum("mij,mjkn->mikn", held.axes, jacobian)
        spans, times = self.spans[held.at], self.times[held.at]
        rows = Rows.of(spans, value, jacobian, kind, times, held.contact)
        return rows.some(held.kept) if held.turned else rows
