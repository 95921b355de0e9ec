"""Tracking cost: squared distance between motions, in metres of body (thesis 4.2 and 4.4).

The thesis's plain norm weighs a metre of pelvis like a radian of wrist. Here marker points spread
over every body are compared, so a change costs what it visibly moves; and their accelerations
likewise, times a time to the fourth, so that limbs do not jerk. Where joints have a price
(joint_price.py), turning them counts the same way.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.anatomy import Part
from ..body.character import Character
from ..body.kinematics import BodyPoint, Pose, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import ORDER
from ..transcription.rows import FORCE_BLOCKS
from ..transcription.transcription import GAUSS_NODES, Transcription
from .cost_to_go import CostToGo, EndTarget
from .joint_price import JointPrice

POSE_BATCH = 32  # spans
# s, `acceleration_time` of toes at least. They move next to nothing, and so came back from a
# push-off at 1300°/s and beyond where they were, of which people's joints reach half. With 0.07 and
# more one fit of a fast run ends 1.5 mm farther off.
TOE_TIME = 0.06


@dataclass(frozen=True)
class CostWeights:
    """Weights of the tracking cost; each term is a mean square in m² integrated over time.

    position: of markers in the world; shape: of markers relative to the centre of mass; com: of
    the centre of mass itself. acceleration_time: s, its fourth power weighs marker accelerations.
    com_acceleration: (m/g)², of the centre of mass's acceleration: one of g weighs as much as so
    many metres. force: (m/BW)², of force errors. force_rate_time: s, its square weighs their rate
    of change. support: (m/BW)², of what carries the body unseen.
    by_range: how much of `shape` is measured by what a change takes of the joints'
    ranges instead of by what it moves, where joints have a price. friction: (m/BW)², of each
    point's force across the target's direction. goes_on: whether the target goes on beyond both
    ends, so that markers must come back to it there. came_from: of the same before the first
    instant alone. damping: m², of what a step takes of the
    joints' ranges, in the Hessian alone (Levenberg 1944), where joints have a price. rest: of the
    root's markers in the world where it rests on something.
    """

    position: float = 0.0
    shape: float = 0.0
    com: float = 0.0
    acceleration_time: float = 0.05
    com_acceleration: float = 0.0
    force: float = 1e-6
    force_rate_time: float = 0.05
    support: float = 1e-3
    by_range: float = 0.5
    friction: float = 0.0
    goes_on: bool = False
    came_from: float = 0.0
    damping: float = 0.0
    rest: float = 0.0


MARKERS = 4  # of each body; the root's are the first


def marker_points(character: Character) -> tuple[BodyPoint, ...]:
    """Markers of every body, in its frame: joint, far end and both sides, (4 B) points."""
    points = []
    for i, body in enumerate(character.bodies):
        side = body.box_rotation[:, 0] * 0.5 * body.box_size[0]
        for position in (np.zeros(3), body.tip, body.box_centre + side, body.box_centre - side):
            points.append(BodyPoint(i, position))
    return tuple(points)


@dataclass(frozen=True)
class TrackingTarget:
    """Reference motion at the dynamics nodes (N,).

    markers: (N, M, 3) m world. com: (N, 3) m world. angles: (N, n_angles) rad. accelerations:
    (N, n_angles) rad/s².
    com_acceleration: (N, 3) m/s², world. forces: (K, 3 P) force values, body weights, laid out as
    in the unknowns. slope: (K, 2) horizontal over vertical component of the force that explains
    the target's movement, at the force values. ends: at the motion's ends.
    """

    markers: FloatArray
    com: FloatArray
    angles: FloatArray
    accelerations: FloatArray
    com_acceleration: FloatArray
    forces: FloatArray
    slope: FloatArray
    ends: EndTarget


@dataclass(frozen=True)
class _NodeErrors:
    """Tracking errors at N nodes.

    values: basis values and second derivatives (N, 4). weight: (N,) s. world, shape: (N, M, 3) m,
    of markers, absolute and relative to the centre of mass. com: (N, 3) m. angles:
    (N, n_angles) rad. acceleration: (N, n_angles) rad/s², those of toes times as much as they
    weigh more. com_acceleration: (N, 3) m/s². turning:
    (N, n_angles, n_angles) m²/rad², metric of the joint angles. rest: (N,) weight of the root's
    markers in the world.
    """

    values: list[FloatArray]
    weight: FloatArray
    posed: Pose
    world: FloatArray
    shape: FloatArray
    com: FloatArray
    angles: FloatArray
    acceleration: FloatArray
    com_acceleration: FloatArray
    turning: FloatArray
    rest: FloatArray | None


def _acceleration_scale(character: Character, acceleration_time: float) -> FloatArray:
    """(n_angles,) by which accelerations of the joint angles count more, squared in the cost."""
    factors = np.ones(character.n_angles)
    for body, joint in zip(character.bodies, character.joints, strict=True):
        if body.part is Part.TOE:
            factors[joint.dofs] = max(1.0, (TOE_TIME / acceleration_time) ** 2)
    return factors


class TrackingCost:
    """Half the squared distance to a target, with gradient and Gauss-Newton Hessian.

    price: what turning joints costs beside, None nothing; that of the target's poses throughout.
    Turns are counted as `by_range` and `damping` tell. resting: (N,) nodes at which the pelvis
    rests on something, where the weight `rest` keeps it.
    """

    def __init__(
        self,
        transcription: Transcription,
        target: TrackingTarget,
        weights: CostWeights,
        price: JointPrice | None = None,
        resting: BoolArray | None = None,
    ) -> None:
        self.transcription = transcription
        self.target = target
        share = 0.0 if price is None else weights.by_range
        self._by_range = share * weights.shape  # of the price
        self.weights = replace(weights, shape=(1.0 - share) * weights.shape)
        self.points = marker_points(transcription.character)
        basis = transcription.basis
        times, spans = transcription.node_times, transcription.node_spans
        self._values = [basis.evaluate(times, k, spans) for k in (0, 2)]
        self._smooth = weights.acceleration_time**4
        self._load = weights.com_acceleration / STANDARD_GRAVITY**2
        self._force_metric = self._made_force_metric()
        n = transcription.character.n_angles
        self._scale = _acceleration_scale(transcription.character, weights.acceleration_time)
        self._price = np.broadcast_to(0.0, (len(times), n, n))
        if price is not None:
            self._price = price.metric(forward_kinematics(transcription.character, target.angles))
        self._rest = None if resting is None or not resting.any() else weights.rest * resting
        time = weights.acceleration_time
        after = weights.position if weights.goes_on else 0.0
        ends = (after + weights.came_from, after)
        to_go = CostToGo(transcription, target.ends, self.points, time, ends)
        goes_on = any(ends) and not transcription.periodic  # a loop goes on in itself
        self._to_go = to_go if goes_on else None

    def _batches(self) -> Iterator[slice]:
        """Spans a few at a time: what they need then stays in the processor's cache."""
        for first in range(0, self.transcription.basis.n_spans, POSE_BATCH):
            yield slice(first, min(first + POSE_BATCH, self.transcription.basis.n_spans))

    def _at_nodes(self, x: FloatArray, all_posed: Pose, spans: slice) -> _NodeErrors:
        t = self.transcription
        nodes = slice(GAUSS_NODES * spans.start, GAUSS_NODES * spans.stop)
        local = t.window(x, t.node_spans[nodes])
        values = [each[nodes] for each in self._values]
        motion, second = (np.einsum("nk,nkj->nj", B, local) for B in values)
        posed = all_posed.at(nodes)
        com, target = motion[:, t.layout.com], self.target
        relative = posed.points(self.points)
        markers, centre = target.markers[nodes], target.com[nodes]
        return _NodeErrors(
            values=values,
            weight=t.node_weights[nodes],
            posed=posed,
            world=relative + com[:, None] - markers,
            shape=relative - (markers - centre[:, None]),
            com=com - centre,
            angles=motion[:, t.layout.angles] - target.angles[nodes],
            acceleration=self._scale * (second[:, t.layout.angles] - target.accelerations[nodes]),
            com_acceleration=second[:, t.layout.com] - target.com_acceleration[nodes],
            turning=self._by_range * self._price[nodes],
            rest=None if self._rest is None else self._rest[nodes],
        )

    def value(self, x: FloatArray) -> float:
        """Half the squared distance at unknowns (K, n_block)."""
        p, total = self.weights, 0.0
        posed = self.transcription.pose_at_nodes(x)
        for spans in self._batches():
            at = self._at_nodes(x, posed, spans)
            mean = p.position * (at.world**2).sum(axis=(1, 2)) + p.shape * (at.shape**2).sum(
                axis=(1, 2)
            )
            each = mean / len(self.points) + p.com * (at.com**2).sum(axis=1)
            moved = at.posed.point_rates(self.points, at.acceleration)
            each += self._smooth * self._marker_weight * (moved**2).sum(axis=(1, 2))
            if at.rest is not None:
                each += at.rest * (at.world[:, :MARKERS] ** 2).sum(axis=(1, 2)) / MARKERS
            each += _squares(at.turning, at.angles)
            each += self._smooth * _squares(at.turning, at.acceleration)
            each += self._load * (at.com_acceleration**2).sum(axis=1)
            total += 0.5 * float(at.weight @ each)
        if self._to_go is not None:
            total += self._to_go.value(x)
        forces = self._force_error(x)
        return total + 0.5 * float((forces * self._force_metric.times(forces)).sum())

    @property
    def _marker_weight(self) -> float:
        return (self.weights.position + self.weights.shape) / len(self.points)

    def expand(
        self, x: FloatArray, into: BlockBanded | None = None
    ) -> tuple[FloatArray, BlockBanded]:
        """Gradient (K, n_block) and Gauss-Newton Hessian at x (K, n_block). into: an earlier
        Hessian of its own, to be overwritten."""
        t = self.transcription
        gradient = np.zeros_like(x)
        matrix = BlockBanded(*x.shape) if into is None else into.cleared()
        forces = t.layout.forces
        gradient[:, forces] = self._force_metric.times(self._force_error(x))
        matrix.lower[:, :, forces, forces] = self._force_metric.lower
        posed = t.pose_at_nodes(x)
        for spans in self._batches():
            self._expand_batch(self._at_nodes(x, posed, spans), spans, gradient, matrix)
        if self._to_go is not None:
            self._to_go.expand(x, gradient, matrix)
        matrix.add_diagonal((~t.active).astype(float))  # unknowns that do not exist stay put
        return gradient, matrix

    def _expand_batch(
        self, at: _NodeErrors, spans: slice, gradient: FloatArray, matrix: BlockBanded
    ) -> None:
        p, layout = self.weights, self.transcription.layout
        count = len(self.points)
        squares, turn = at.posed.points_metric(self.points)
        n_motion, com, angles = layout.n_motion, layout.com, layout.angles
        metric = np.zeros((len(turn), n_motion, n_motion))
        angle = self._marker_weight * squares + at.turning
        mean_turn = p.position / count * turn  # (N, 3, n)
        metric[:, angles, angles] = angle
        metric[:, com, angles] = mean_turn
        metric[:, angles, com] = np.swapaxes(mean_turn, 1, 2)
        diagonal = range(com.stop)
        metric[:, diagonal, diagonal] = p.position + p.com
        slope = np.zeros((len(turn), n_motion))
        pull = (p.position * at.world + p.shape * at.shape) / count
        slope[:, angles] = at.posed.points_gradient(self.points, pull)
        slope[:, angles] += np.einsum("njk,nk->nj", at.turning, at.angles)
        slope[:, com] = p.position * at.world.mean(axis=1) + p.com * at.com
        curvature = self._smooth * self._scale * np.einsum("njk,nk->nj", angle, at.acceleration)
        first = self.transcription.basis.first_coefficient[spans]
        nodes = slice(GAUSS_NODES * spans.start, GAUSS_NODES * spans.stop)
        if at.rest is not None:
            self._expand_rest(at, at.rest, metric, slope)
        damping = p.damping * self._price[nodes]
        metric[:, angles, angles] += damping
        accelerated = (angle + damping) * np.multiply.outer(self._scale, self._scale)
        self._add_windows(at, metric, accelerated, first, matrix)
        value, second = at.values
        local = (at.weight[:, None] * value)[..., None] * slope[:, None]
        load = self._load * at.com_acceleration
        local[..., com] += (at.weight[:, None] * second)[..., None] * load[:, None]
        local[..., angles] += (at.weight[:, None] * second)[..., None] * curvature[:, None]
        summed = local.reshape(len(first), GAUSS_NODES, ORDER, n_motion).sum(axis=1)
        for k in range(ORDER):
            gradient[first + k, layout.motion] += summed[:, k]

    def _expand_rest(
        self, at: _NodeErrors, rest: FloatArray, metric: FloatArray, slope: FloatArray
    ) -> None:
        """Adds the root's markers in the world to metric (N, n, n) and gradient (N, n)."""
        layout, root = self.transcription.layout, self.points[:MARKERS]
        com, angles = layout.com, layout.angles
        squares, turn = at.posed.points_metric(root)
        share = rest / MARKERS
        metric[:, angles, angles] += share[:, None, None] * squares
        metric[:, com, angles] += share[:, None, None] * turn
        metric[:, angles, com] += share[:, None, None] * np.swapaxes(turn, 1, 2)
        metric[:, range(com.stop), range(com.stop)] += rest[:, None]
        pull = share[:, None, None] * at.world[:, :MARKERS]
        slope[:, angles] += at.posed.points_gradient(root, pull)
        slope[:, com] += pull.sum(axis=1)

    def _add_windows(
        self,
        at: _NodeErrors,
        metric: FloatArray,
        angle: FloatArray,
        first: IntArray,
        matrix: BlockBanded,
    ) -> None:
        """Adds the Hessian over each span's blocks: metrics of values and of accelerations, times
        products of two of the four basis functions; of these the lower half."""
        layout, spans = self.transcription.layout, len(first)
        forms = np.zeros((spans, 2, GAUSS_NODES, *metric.shape[1:]))
        forms[:, 0] = metric.reshape(spans, GAUSS_NODES, *metric.shape[1:])
        forms[:, 1, :, layout.angles, layout.angles] = self._smooth * angle.reshape(
            spans, GAUSS_NODES, *angle.shape[1:]
        )
        for axis in range(layout.com.stop):
            forms[:, 1, :, axis, axis] = self._load
        pairs = np.stack([_products(each, at.weight) for each in at.values], axis=1)
        pairs = pairs.reshape(spans, GAUSS_NODES, 2, ORDER, ORDER)
        row, column = np.tril_indices(ORDER)
        weights = pairs[..., row, column].transpose(0, 3, 2, 1).reshape(spans, len(row), -1)
        blocks = weights @ forms.reshape(spans, 2 * GAUSS_NODES, -1)
        blocks = blocks.reshape(spans, len(row), *metric.shape[1:])
        for k, (i, j) in enumerate(zip(row.tolist(), column.tolist(), strict=True)):
            matrix.lower[i - j][first + j, layout.motion, layout.motion] += blocks[:, k]

    # -- forces ----------------------------------------------------------------------------

    def _force_error(self, x: FloatArray) -> FloatArray:
        """(K, 3 P) body weights."""
        t = self.transcription
        forces = t.layout.forces
        return np.where(t.active[:, forces], x[:, forces] - self.target.forces, 0.0)

    def _made_force_metric(self) -> BlockBanded:
        """Integral of squared force errors, their rates and their parts across the target's slope:
        piecewise linear, exact. Of the forces alone."""
        t, p = self.transcription, self.weights
        basis, layout = t.basis, t.layout
        h = np.diff(basis.breaks)[:, None, None]
        mass = h * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
        stiff = np.array([[1.0, -1.0], [-1.0, 1.0]]) / h
        alike = p.force * (mass + p.force_rate_time**2 * stiff)
        exists = t.active[:, layout.forces]
        matrix = BlockBanded(*exists.shape)
        unseen = np.diag((np.arange(exists.shape[1]) >= 3 * (layout.n_points - t.n_support)) * 1.0)
        across = self._across()
        first = basis.first_coefficient + FORCE_BLOCKS.start  # of each span's first force value
        identity = np.eye(exists.shape[1])
        for row in range(2):
            for column in range(row + 1):
                a, b = first + row, first + column
                each = alike[:, row, column, None, None] * identity
                each = each + p.support * mass[:, row, column, None, None] * unseen
                if p.friction:
                    pair = np.swapaxes(across[a], 1, 2) @ across[b]
                    each = each + p.friction * mass[:, row, column, None, None] * pair
                each = each * exists[a][:, :, None] * exists[b][:, None, :]
                np.add.at(matrix.lower[row - column], b, each)
        return matrix

    def _across(self) -> FloatArray:
        """(K, 2 P, 3 P) maps of the force values to their parts across the target's slope."""
        t = self.transcription
        points = t.layout.n_points
        across = np.zeros((t.basis.n_coefficients, points, 2, points, 3))
        each = np.arange(points)
        for axis in range(2):
            across[:, each, axis, each, axis] = 1.0
            across[:, each, axis, each, 2] = -self.target.slope[:, axis, None]
        return across.reshape(len(across), 2 * points, 3 * points)


def _products(values: FloatArray, weight: FloatArray) -> FloatArray:
    """(N, 4, 4) weighted products of the four basis functions with each other."""
    return np.asarray(weight[:, None, None] * values[:, :, None] * values[:, None, :])


def _squares(metric: FloatArray, v: FloatArray) -> FloatArray:
    """(N,) v' M v of vectors v (N, n) by metrics (N, n, n)."""
    return np.asarray(np.einsum("nj,njk,nk->n", v, metric, v, optimize=True))
