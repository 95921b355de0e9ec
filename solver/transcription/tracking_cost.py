"""How far one motion is from another, in metres of body (the norm of thesis 4.2 and 4.4).

The thesis's plain norm prices a metre of pelvis like a radian of wrist. Here points spread over
every body are compared, so a change costs what it visibly moves; and their accelerations
likewise, times a time to the fourth, so that limbs do not jerk.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..body.kinematics import BodyPoint, Pose, forward_kinematics
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import ORDER
from .transcription import GAUSS, Transcription

AT_ONCE = 16  # spans


@dataclass(frozen=True)
class CostWeights:
    """What the distance weighs; each term is a mean square in m² integrated over time.

    place: points in the world; shape: points relative to the centre of mass; com: the centre of
    mass itself. smooth_s: accelerations count times this time to the fourth, s. force: (m/BW)²,
    of the difference to the reference force. force_slope_s: its rate of change counts times this
    time squared, s.
    """

    place: float = 0.0
    shape: float = 0.0
    com: float = 0.0
    smooth_s: float = 0.05
    force: float = 1e-6
    force_slope_s: float = 0.05


def marker_points(character: Character) -> tuple[BodyPoint, ...]:
    """Points that stand for a body's visible place and turn: joint, far end and both sides."""
    points = []
    for i, body in enumerate(character.bodies):
        side = body.box_rotation[:, 0] * 0.5 * body.box_size[0]
        for place in (np.zeros(3), body.tip, body.box_centre + side, body.box_centre - side):
            points.append(BodyPoint(i, place))
    return tuple(points)


@dataclass(frozen=True)
class Target:
    """A motion to stay close to, at the dynamics nodes (N,).

    markers: (N, M, 3) m world. com: (N, 3) m world. accelerations: (N, n_angles) rad/s².
    forces: (K, 3 P) force values in body weights, laid out as in the unknowns.
    """

    markers: FloatArray
    com: FloatArray
    accelerations: FloatArray
    forces: FloatArray


@dataclass(frozen=True)
class _Nodes:
    """A motion against the target at N nodes: basis values and second derivatives (N, 4), weights
    (N,) s, pose, marker errors in the world and in shape (N, M, 3), errors of the centre of mass
    (N, 3) and of the accelerations (N, n_angles)."""

    values: list[FloatArray]
    weight: FloatArray
    posed: Pose
    world: FloatArray
    shape: FloatArray
    com: FloatArray
    bend: FloatArray


class TrackingCost:
    """The squared distance to a target as a function of the unknowns, with Gauss-Newton metric."""

    def __init__(self, transcription: Transcription, target: Target, prices: CostWeights) -> None:
        self.transcription = transcription
        self.target = target
        self.prices = prices
        self.points = marker_points(transcription.character)
        basis = transcription.basis
        times, spans = transcription.node_times, transcription.node_spans
        self._values = [basis.evaluate(times, k, spans) for k in (0, 2)]
        self._smooth = prices.smooth_s**4
        self._force_windows = self._force_metric()

    def _parts(self) -> Iterator[slice]:
        """The spans, a few at a time: what they need then stays in the processor's cache."""
        for first in range(0, self.transcription.basis.n_spans, AT_ONCE):
            yield slice(first, min(first + AT_ONCE, self.transcription.basis.n_spans))

    def _at_nodes(self, x: FloatArray, spans: slice) -> "_Nodes":
        t = self.transcription
        nodes = slice(GAUSS * spans.start, GAUSS * spans.stop)
        local = t.window(x, t.node_spans[nodes])
        values = [each[nodes] for each in self._values]
        motion, second = (np.einsum("nk,nkj->nj", B, local) for B in values)
        posed = forward_kinematics(t.character, motion[:, t.layout.angles])
        com, target = motion[:, t.layout.com], self.target
        relative = posed.points(self.points)
        markers, centre = target.markers[nodes], target.com[nodes]
        return _Nodes(
            values=values,
            weight=t.node_weights[nodes],
            posed=posed,
            world=relative + com[:, None] - markers,
            shape=relative - (markers - centre[:, None]),
            com=com - centre,
            bend=second[:, t.layout.angles] - target.accelerations[nodes],
        )

    def value(self, x: FloatArray) -> float:
        """Half the squared distance."""
        p, total = self.prices, 0.0
        for spans in self._parts():
            at = self._at_nodes(x, spans)
            mean = p.place * (at.world**2).sum(axis=(1, 2)) + p.shape * (at.shape**2).sum(
                axis=(1, 2)
            )
            each = mean / len(self.points) + p.com * (at.com**2).sum(axis=1)
            moved = np.einsum("npij,nj->npi", at.posed.point_jacobian(self.points), at.bend)
            each += self._smooth * self._mean_price * (moved**2).sum(axis=(1, 2))
            total += 0.5 * float(at.weight @ each)
        forces = self._force_error(x)
        return total + 0.5 * float((forces * self._force_windows.times(forces)).sum())

    @property
    def _mean_price(self) -> float:
        return (self.prices.place + self.prices.shape) / len(self.points)

    def expand(self, x: FloatArray) -> tuple[FloatArray, BlockBanded]:
        """Gradient (K, n_block) and Gauss-Newton metric at x."""
        t = self.transcription
        gradient = self._force_windows.times(self._force_error(x))
        matrix = self._force_windows.copy()
        for spans in self._parts():
            self._expand_part(x, spans, gradient, matrix)
        matrix.add_diagonal((~t.active).astype(float))  # unknowns that do not exist stay put
        return gradient, matrix

    def _expand_part(
        self, x: FloatArray, spans: slice, gradient: FloatArray, matrix: BlockBanded
    ) -> None:
        p, layout = self.prices, self.transcription.layout
        at, count = self._at_nodes(x, spans), len(self.points)
        turn = at.posed.point_jacobian(self.points)
        flat = turn.reshape(len(turn), -1, layout.n_angles)
        n_motion = 3 + layout.n_angles
        metric = np.zeros((len(turn), n_motion, n_motion))
        angle = self._mean_price * np.swapaxes(flat, 1, 2) @ flat
        mean_turn = p.place * turn.mean(axis=1)  # (N, 3, n)
        metric[:, 3:, 3:] = angle
        metric[:, :3, 3:] = mean_turn
        metric[:, 3:, :3] = np.swapaxes(mean_turn, 1, 2)
        metric[:, range(3), range(3)] = p.place + p.com
        slope = np.zeros((len(turn), n_motion))
        pull = (p.place * at.world + p.shape * at.shape).reshape(len(turn), -1) / count
        slope[:, 3:] = np.einsum("nrj,nr->nj", flat, pull)
        slope[:, :3] = p.place * at.world.mean(axis=1) + p.com * at.com
        bend = self._smooth * np.einsum("njk,nk->nj", angle, at.bend)
        first = self.transcription.basis.first_coefficient[spans]
        matrix.add_windows(first, self._windows(at, metric, angle), layout.motion)
        value, second = at.values
        local = (at.weight[:, None] * value)[..., None] * slope[:, None]
        local[..., 3:] += (at.weight[:, None] * second)[..., None] * bend[:, None]
        summed = local.reshape(len(first), GAUSS, ORDER, n_motion).sum(axis=1)
        for k in range(ORDER):
            gradient[first + k, layout.motion] += summed[:, k]

    def _windows(self, at: "_Nodes", metric: FloatArray, angle: FloatArray) -> FloatArray:
        """(S, 4, n_motion, 4, n_motion) the metric over each span's blocks."""
        spans, n_motion, n = len(metric) // GAUSS, metric.shape[-1], angle.shape[-1]
        value, second = at.values
        pairs = _products(value, at.weight).reshape(spans, GAUSS, ORDER * ORDER)
        windows = np.swapaxes(pairs, 1, 2) @ metric.reshape(spans, GAUSS, -1)
        windows = windows.reshape(spans, ORDER, ORDER, n_motion, n_motion)
        pairs = self._smooth * _products(second, at.weight).reshape(spans, GAUSS, ORDER * ORDER)
        bending = np.swapaxes(pairs, 1, 2) @ angle.reshape(spans, GAUSS, -1)
        windows[..., 3:, 3:] += bending.reshape(spans, ORDER, ORDER, n, n)
        return np.asarray(windows.transpose(0, 1, 3, 2, 4))

    # -- forces ----------------------------------------------------------------------------

    def _force_error(self, x: FloatArray) -> FloatArray:
        error = np.zeros_like(x)
        forces = self.transcription.layout.forces
        error[:, forces] = x[:, forces] - self.target.forces
        error[~self.transcription.active] = 0.0
        return error

    def _force_metric(self) -> BlockBanded:
        """Integral of squared force differences and of their slopes: piecewise linear, exact."""
        t, p = self.transcription, self.prices
        basis, layout = t.basis, t.layout
        h = np.diff(basis.breaks)
        mass = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
        stiff = np.array([[1.0, -1.0], [-1.0, 1.0]])
        each = p.force * (h[:, None, None] * mass + p.force_slope_s**2 / h[:, None, None] * stiff)
        matrix = BlockBanded(basis.n_coefficients, layout.n_block)
        exists = t.active[:, layout.forces]
        index = np.arange(layout.forces.start, layout.forces.stop)
        first = basis.first_coefficient + 1  # the block of each span's first force value
        for row in range(2):
            for column in range(row + 1):
                both = exists[first + row] & exists[first + column]
                block = matrix.lower[row - column]
                np.add.at(
                    block,
                    ((first + column)[:, None], index, index),
                    each[:, row, column, None] * both,
                )
        return matrix


def _products(values: FloatArray, weight: FloatArray) -> FloatArray:
    """(N, 16) weighted products of the four basis functions with each other."""
    return np.asarray(weight[:, None, None] * values[:, :, None] * values[:, None, :])
