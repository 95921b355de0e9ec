"""The equations that hold touching points still (thesis 3.3.2).

While a point is pinned its place is fixed at every break; its speed is zero at the pin's ends and
at double knots inside, where the spline is only once differentiable and each side needs its own
end condition. These are as many rows as a cubic has freedom, so they stay independent.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .contacts import Contact
from .kinematics import BodyPoint, Pose, point_velocity
from .recording import FloatArray, IntArray
from .rows import Layout, RowKind, Rows
from .splines import ORDER, Basis


@dataclass(frozen=True)
class PointContact:
    """A contact as the equations see it: `point` indexes the transcription's points."""

    contact: Contact
    point: int
    pin_start: float
    pin_end: float


@dataclass(frozen=True)
class _Held:
    """Which contact is held at which of the pins' breaks, as M pairs; point: what it holds."""

    contact: IntArray
    at: IntArray
    point: IntArray


class Pins:
    """Pin rows on one basis. times: (U,) the breaks at which anything is pinned."""

    def __init__(self, basis: Basis, layout: Layout, contacts: Sequence[PointContact]) -> None:
        self.layout = layout
        slack = 1e-9
        pinned = np.array(
            [
                (basis.breaks >= c.pin_start - slack) & (basis.breaks <= c.pin_end + slack)
                for c in contacts
            ]
        ).reshape(len(contacts), len(basis.breaks))
        ends = np.array(
            [
                np.isclose(basis.breaks, c.pin_start) | np.isclose(basis.breaks, c.pin_end)
                for c in contacts
            ]
        ).reshape(pinned.shape)
        used = np.flatnonzero(pinned.any(axis=0))
        self.times = basis.breaks[used]
        self.spans = basis.spans(self.times)
        self.values, self.slopes = (basis.evaluate(self.times, k, self.spans) for k in (0, 1))
        points = np.array([c.point for c in contacts], dtype=int)
        self._place = _held(pinned[:, used], points)
        self._speed = _held((pinned & (ends | basis.double))[:, used], points)

    def angles(self, window: FloatArray) -> FloatArray:
        """(U, n_angles) joint angles at the pins' breaks, from the unknowns' windows there."""
        return np.asarray(np.einsum("uk,ukj->uj", self.values, window[:, :, self.layout.angles]))

    def residuals(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> FloatArray:
        """The residuals of `rows`, in their order."""
        speeds = point_velocity(posed, points, self._angle_speeds(window))[0]
        off = self._off(window, posed, points, places)
        return np.concatenate([off.ravel(), self._drift(window, speeds).ravel()])

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
        com = np.einsum("uk,ukj->uj", self.values, window[:, :, self.layout.com])
        at = com[held.at] + posed.points(points)[held.at, held.point]
        return np.asarray(at - places[held.contact])

    def _drift(self, window: FloatArray, speeds: FloatArray) -> FloatArray:
        held = self._speed
        com = np.einsum("uk,ukj->uj", self.slopes, window[:, :, self.layout.com])
        return np.asarray(com[held.at] + speeds[held.at, held.point])

    def _angle_speeds(self, window: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("uk,ukj->uj", self.slopes, window[:, :, self.layout.angles]))

    def _place_rows(
        self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint], places: FloatArray
    ) -> Rows:
        held = self._place
        values = self.values[held.at]
        turn = posed.point_jacobian(points)[held.at, held.point]
        jacobian = self._empty(held)
        jacobian[..., self.layout.angles] = values[:, None, :, None] * turn[:, :, None]
        for axis in range(3):
            jacobian[:, axis, :, axis] = values
        off = self._off(window, posed, points, places)
        return self._rows(held, off, jacobian, RowKind.PIN)

    def _speed_rows(self, window: FloatArray, posed: Pose, points: Sequence[BodyPoint]) -> Rows:
        held = self._speed
        some, back = np.unique(held.at, return_inverse=True)
        few = posed.at(some)
        found = point_velocity(few, points, self._angle_speeds(window)[some])
        each = (back, held.point)
        jacobian = self._empty(held)
        for basis, derivative in ((self.values, found[1]), (self.slopes, found[2])):
            jacobian[..., self.layout.angles] += (
                basis[held.at][:, None, :, None] * derivative[each][:, :, None]
            )
        for axis in range(3):
            jacobian[:, axis, :, axis] = self.slopes[held.at]
        com = np.einsum("uk,ukj->uj", self.slopes, window[:, :, self.layout.com])
        return self._rows(held, com[held.at] + found[0][each], jacobian, RowKind.PIN_SPEED)

    def _empty(self, held: _Held) -> FloatArray:
        return np.zeros((len(held.at), 3, ORDER, self.layout.n_block))

    def _rows(self, held: _Held, residual: FloatArray, jacobian: FloatArray, kind: RowKind) -> Rows:
        spans, times = self.spans[held.at], self.times[held.at]
        return Rows.triples(spans, residual, jacobian, kind, times, held.contact)


def _held(which: np.ndarray[tuple[int, ...], np.dtype[np.bool_]], points: IntArray) -> _Held:
    contact, at = np.nonzero(which)
    return _Held(contact, at, points[contact])
