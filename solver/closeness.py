"""How far one motion is from another, in metres of body (the norm of thesis 4.2 and 4.4).

The thesis's plain norm prices a metre of pelvis like a radian of wrist. Here points spread over
every body are compared, so a change costs what it visibly moves; and their accelerations
likewise, times a time to the fourth, so that limbs do not jerk.
"""

from dataclasses import dataclass

import numpy as np

from .character import Character
from .kinematics import BodyPoint, Pose, pose
from .linear import BlockBanded
from .recording import FloatArray
from .splines import ORDER
from .transcription import Transcription


@dataclass(frozen=True)
class Prices:
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


class Closeness:
    """The squared distance to a target as a function of the unknowns, with Gauss-Newton metric."""

    def __init__(self, transcription: Transcription, target: Target, prices: Prices) -> None:
        self.transcription = transcription
        self.target = target
        self.prices = prices
        self.points = marker_points(transcription.character)
        basis = transcription.basis
        times, spans = transcription.node_times, transcription.node_spans
        self._values = [basis.evaluate(times, k, spans) for k in (0, 2)]
        self._smooth = prices.smooth_s**4
        self._force_windows = self._force_metric()

    def _at_nodes(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        t = self.transcription
        local = t.window(x, t.node_spans)
        motion, second = (np.einsum("nk,nkj->nj", B, local) for B in self._values)
        layout = t.layout
        return motion[:, layout.com], motion[:, layout.angles], second[:, layout.angles]

    def _errors(self, posed: Pose, com: FloatArray) -> tuple[FloatArray, FloatArray]:
        relative = posed.points(self.points)
        world = relative + com[:, None] - self.target.markers
        shape = relative - (self.target.markers - self.target.com[:, None])
        return world, shape

    def value(self, x: FloatArray) -> float:
        """Half the squared distance."""
        com, q, a = self._at_nodes(x)
        posed = pose(self.transcription.character, q)
        world, shape = self._errors(posed, com)
        p = self.prices
        mean = p.place * (world**2).sum(axis=(1, 2)) + p.shape * (shape**2).sum(axis=(1, 2))
        each = mean / len(self.points) + p.com * ((com - self.target.com) ** 2).sum(axis=1)
        metric = self._angle_metric(posed)
        off = a - self.target.accelerations
        each = each + self._smooth * np.einsum("nj,njk,nk->n", off, metric, off)
        total = 0.5 * float(self.transcription.node_weights @ each)
        forces = self._force_error(x)
        return total + 0.5 * float((forces * self._force_windows.times(forces)).sum())

    def _angle_metric(self, posed: Pose) -> FloatArray:
        """(N, n, n) mean squared displacement of the points per angle change."""
        turn = posed.point_jacobian(self.points)
        flat = turn.reshape(len(turn), -1, turn.shape[-1])
        weight = (self.prices.place + self.prices.shape) / len(self.points)
        return np.asarray(weight * np.swapaxes(flat, 1, 2) @ flat)

    def expand(self, x: FloatArray) -> tuple[FloatArray, BlockBanded]:
        """Gradient (K, n_block) and Gauss-Newton metric at x."""
        t, p = self.transcription, self.prices
        layout = t.layout
        com, q, a = self._at_nodes(x)
        posed = pose(t.character, q)
        turn = posed.point_jacobian(self.points)
        world, shape = self._errors(posed, com)
        count = len(self.points)
        flat = turn.reshape(len(turn), -1, layout.n_angles)
        n_motion = 3 + layout.n_angles
        metric = np.zeros((len(q), n_motion, n_motion))
        angle = (p.place + p.shape) / count * np.swapaxes(flat, 1, 2) @ flat
        mean_turn = p.place * turn.mean(axis=1)  # (N, 3, n)
        metric[:, 3:, 3:] = angle
        metric[:, :3, 3:] = mean_turn
        metric[:, 3:, :3] = np.swapaxes(mean_turn, 1, 2)
        metric[:, range(3), range(3)] = p.place + p.com
        slope = np.zeros((len(q), n_motion))
        pull = (p.place * world + p.shape * shape).reshape(len(q), -1) / count
        slope[:, 3:] = np.einsum("nrj,nr->nj", flat, pull)
        slope[:, :3] = p.place * world.mean(axis=1) + p.com * (com - self.target.com)
        off = a - self.target.accelerations
        bend = self._smooth * np.einsum("njk,nk->nj", angle, off)
        return self._assemble(slope, bend, metric, angle, x)

    def _assemble(
        self,
        slope: FloatArray,
        bend: FloatArray,
        metric: FloatArray,
        angle: FloatArray,
        x: FloatArray,
    ) -> tuple[FloatArray, BlockBanded]:
        t = self.transcription
        layout, basis = t.layout, t.basis
        value, second = self._values
        weight = t.node_weights
        spans, per = basis.n_spans, len(weight) // basis.n_spans
        n_motion = metric.shape[-1]
        pairs = _products(value, weight).reshape(spans, per, ORDER * ORDER)
        windows = np.swapaxes(pairs, 1, 2) @ metric.reshape(spans, per, -1)
        windows = windows.reshape(spans, ORDER, ORDER, n_motion, n_motion)
        pairs = self._smooth * _products(second, weight).reshape(spans, per, ORDER * ORDER)
        bending = np.swapaxes(pairs, 1, 2) @ angle.reshape(spans, per, -1)
        n = layout.n_angles
        windows[..., 3:, 3:] += bending.reshape(spans, ORDER, ORDER, n, n)
        full = np.zeros((spans, ORDER, layout.n_block, ORDER, layout.n_block))
        full[:, :, layout.motion, :, layout.motion] = windows.transpose(0, 1, 3, 2, 4)
        matrix = BlockBanded(basis.n_coefficients, layout.n_block)
        matrix.lower += self._force_windows.lower
        matrix.add_windows(basis.first_coefficient, full)
        matrix.add_diagonal((~t.active).astype(float))  # unknowns that do not exist stay put
        gradient = self._force_windows.times(self._force_error(x))
        local = (weight[:, None] * value)[..., None] * slope[:, None]
        local[..., 3:] += (weight[:, None] * second)[..., None] * bend[:, None]
        summed = local.reshape(spans, per, ORDER, n_motion).sum(axis=1)
        for k in range(ORDER):
            gradient[basis.first_coefficient + k, layout.motion] += summed[:, k]
        return gradient, matrix

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
        n = 3 * layout.n_points
        full = np.zeros((basis.n_spans, ORDER, layout.n_block, ORDER, layout.n_block))
        index = np.arange(layout.forces.start, layout.forces.start + n)
        for row in range(2):
            for column in range(2):
                full[:, 1 + row, index, 1 + column, index] = each[:, row, column, None]
        exists = t.active[basis.first_coefficient[:, None] + np.arange(ORDER)]
        full *= exists[:, :, :, None, None] & exists[:, None, None, :, :]
        matrix = BlockBanded(basis.n_coefficients, layout.n_block)
        matrix.add_windows(basis.first_coefficient, full)
        return matrix


def _products(values: FloatArray, weight: FloatArray) -> FloatArray:
    """(N, 16) weighted products of the four basis functions with each other."""
    return np.asarray(weight[:, None, None] * values[:, :, None] * values[:, None, :])
