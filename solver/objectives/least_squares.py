"""Objectives of the explicit solution (thesis 4.3): least-squares integrals, with their
Gauss-Newton Hessians (Nocedal & Wright, ch. 10).

Each term is divided by its value at the start, so that the weights are shares. Torque smoothness
compares the torques within a span and the slopes on both sides of a knot, for torques are
piecewise smooth: their second derivative lies in the spans and, as a jump of slope, at the knots.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.kinematics import BodyPoint
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import ORDER
from ..transcription.motion import Motion
from ..transcription.sampling import Channel, ChannelJacobian, Instants, MotionFunction, State
from ..transcription.torque_constraint import TorqueFunction
from ..transcription.transcription import Transcription

# A change of 100 N·m at one joint of a person weighs like one of 2 cm of the whole shape.
TORQUE_CHANGE_WEIGHT = 0.02  # m² per (body weight x m)²


class ObjectiveTerm(Protocol):
    """A term of an objective, with the factor `scale`."""

    def value(self, x: FloatArray) -> float:
        """Its unscaled value at unknowns (K, n_block)."""

    def expand(self, x: FloatArray, gradient: FloatArray, hessian: BlockBanded) -> None:
        """Adds gradient and Gauss-Newton Hessian at x, (K, n_block) each, times its scale."""

    scale: float


@dataclass
class LeastSquares:
    """Half the integral of |function - target|^2 by quadrature at the dynamics nodes (N,).

    target: (N, m).

    weights: (N,) s, of the nodes; None those of the integral over the whole motion.
    """

    transcription: Transcription
    function: MotionFunction
    target: FloatArray | float = 0.0
    scale: float = 1.0
    weights: FloatArray | None = None

    @cached_property
    def _weights(self) -> FloatArray:
        return self.transcription.node_weights if self.weights is None else self.weights

    @cached_property
    def _instants(self) -> Instants:
        t = self.transcription
        return Instants(t.basis, t.node_times, t.node_spans)

    def _state(self, x: FloatArray) -> State:
        t = self.transcription
        return State(t.character, t.layout, self._instants, x)

    def value(self, x: FloatArray) -> float:
        residual = self.function.value(self._state(x)) - self.target
        return 0.5 * float(self._weights @ (residual**2).sum(axis=1))

    def expand(self, x: FloatArray, gradient: FloatArray, hessian: BlockBanded) -> None:
        t, state = self.transcription, self._state(x)
        root = np.sqrt(self.scale * self._weights)
        residual = root[:, None] * (self.function.value(state) - self.target)
        J = t.assemble(self._instants, self.function.jacobians(state))
        J *= root[:, None, None, None]
        spans = t.basis.n_spans
        add_squares(
            gradient,
            hessian,
            t.basis.first_coefficient,
            residual.reshape(spans, -1),
            J.reshape(spans, -1, ORDER, t.layout.n_block),
        )


def add_squares(
    gradient: FloatArray,
    hessian: BlockBanded,
    first: IntArray,
    residual: FloatArray,
    J: FloatArray,
) -> None:
    """Adds J'r and J'J of S windows: r (S, R), J (S, R, w, n) from block first (S,) on."""
    spans, rows, width, n = J.shape
    flat = J.reshape(spans, rows, width * n)
    slope = (residual[:, None] @ flat).reshape(spans, width, n)
    for k in range(width):
        np.add.at(gradient, first + k, slope[:, k])
    square = np.empty((spans, width * n, width * n))
    for span in range(spans):  # numpy knows that a.T @ a is symmetric
        square[span] = flat[span].T @ flat[span]
    hessian.add_windows(first, square.reshape(spans, width, n, width, n))


@dataclass
class TorqueSmoothness:
    """Half the integral of the torques' squared second derivative, BW·m/s² (thesis eq. 4.4)."""

    transcription: Transcription
    function: TorqueFunction
    scale: float = 1.0

    def __post_init__(self) -> None:
        t = self.transcription
        self._instants = Instants(t.basis, t.node_times, t.node_spans)
        h = np.diff(t.basis.breaks)
        delta = 0.5 * h * np.sqrt(0.6)  # from a span's middle to its outer Gauss points
        # Of the parabola through a span's three nodes: second derivative, slopes at both ends.
        curvature = np.stack([np.ones_like(h), np.full_like(h, -2.0), np.ones_like(h)], axis=1)
        curvature /= (delta**2)[:, None]
        middle = np.stack([-np.ones_like(h), np.zeros_like(h), np.ones_like(h)], axis=1)
        middle /= (2.0 * delta)[:, None]
        half = 0.5 * h[:, None] * curvature
        self._curvature = np.sqrt(h)[:, None] * curvature
        smooth = ~t.basis.double[1:-1]
        self._before = np.flatnonzero(smooth)  # the span before each single knot
        size = 1.0 / np.sqrt(0.5 * (h[:-1] + h[1:]))[self._before, None]
        self._left = size * (middle + half)[self._before]
        self._right = size * (middle - half)[self._before + 1]

    def _state(self, x: FloatArray) -> State:
        t = self.transcription
        return State(t.character, t.layout, self._instants, x)

    def _residuals(self, torques: FloatArray) -> tuple[FloatArray, FloatArray]:
        each = torques.reshape(len(self._curvature), 3, -1)
        curvature = np.einsum("sk,skj->sj", self._curvature, each)
        before = self._before
        jump = np.einsum("sk,skj->sj", self._right, each[before + 1])
        jump -= np.einsum("sk,skj->sj", self._left, each[before])
        return curvature, jump

    def value(self, x: FloatArray) -> float:
        curvature, jump = self._residuals(self.function.value(self._state(x)))
        return 0.5 * float((curvature**2).sum() + (jump**2).sum())

    def expand(self, x: FloatArray, gradient: FloatArray, hessian: BlockBanded) -> None:
        t, state = self.transcription, self._state(x)
        root = np.sqrt(self.scale)
        curvature, jump = self._residuals(self.function.value(state))
        J = t.assemble(self._instants, self.function.jacobians(state))
        spans, n = t.basis.n_spans, t.layout.n_block
        J = J.reshape(spans, 3, -1, ORDER * n)
        first, before = t.basis.first_coefficient, self._before
        rows = J.shape[2]

        def mixed(weights: FloatArray, spans: IntArray | slice) -> FloatArray:
            found = np.einsum("sk,skjn->sjn", weights, J[spans])
            return np.asarray(found.reshape(-1, rows, ORDER, n))

        whole = root * mixed(self._curvature, slice(None))
        add_squares(gradient, hessian, first, root * curvature, whole)
        wide = np.zeros((len(before), rows, ORDER + 1, n))
        wide[:, :, 1:] = mixed(self._right, before + 1)
        wide[:, :, :-1] -= mixed(self._left, before)
        add_squares(gradient, hessian, first[before], root * jump, root * wide)


# ---------------------------------------------------------------- motion functions


@dataclass(frozen=True)
class Power:
    """Joint power: torque times angular velocity (U, m), BW·m/s."""

    function: TorqueFunction

    def value(self, state: State) -> FloatArray:
        return self.function.value(state) * state.angles(1)[:, self.function.angles]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        torques, which = self.function.value(state), self.function.angles
        speeds = state.angles(1)[:, which]
        jacobians = [
            ChannelJacobian(s.channel, s.order, s.matrix * speeds[:, :, None])
            for s in self.function.jacobians(state)
        ]
        by_rate = np.zeros((*torques.shape, state.character.n_angles))
        by_rate[:, np.arange(len(which)), which] = torques
        return [*jacobians, ChannelJacobian(Channel.ANGLES, 1, by_rate)]


@dataclass(frozen=True)
class MassPositions:
    """Positions of the bodies' centres of mass (U, 3 B), m, times root mass shares."""

    def value(self, state: State) -> FloatArray:
        points, roots = self._points(state)
        at = state.pose.points(points) + state.com()[:, None]
        return np.asarray((at * roots[:, None]).reshape(len(at), -1))

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        points, roots = self._points(state)
        turn = state.pose.point_jacobian(points) * roots[:, None, None]
        count = len(turn)
        com = np.tile((roots[:, None, None] * np.eye(3)).reshape(-1, 3), (count, 1, 1))
        return [
            ChannelJacobian(Channel.ANGLES, 0, turn.reshape(count, -1, turn.shape[-1])),
            ChannelJacobian(Channel.COM, 0, com),
        ]

    def _points(self, state: State) -> tuple[list[BodyPoint], FloatArray]:
        bodies = state.character.bodies
        share = np.array([body.mass for body in bodies]) / state.character.mass
        return [BodyPoint(i, body.com) for i, body in enumerate(bodies)], np.sqrt(share)


@dataclass(frozen=True)
class AngleDerivatives:
    """The order-th time derivatives of the joint angles (U, n_angles), rad."""

    order: int

    def value(self, state: State) -> FloatArray:
        return state.angles(self.order)

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        n = state.character.n_angles
        matrix = np.broadcast_to(np.eye(n), (len(state.instants.times), n, n))
        return [ChannelJacobian(Channel.ANGLES, self.order, matrix)]


@dataclass(frozen=True)
class ContactForces:
    """Contact forces (U, 3 P), body weights, world."""

    def value(self, state: State) -> FloatArray:
        return np.asarray(state.forces.reshape(len(state.forces), -1))

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        n = 3 * state.layout.n_points
        matrix = np.broadcast_to(np.eye(n), (len(state.instants.times), n, n))
        return [ChannelJacobian(Channel.FORCES, 0, matrix)]


# ---------------------------------------------------------------- objective and metric


@dataclass(frozen=True)
class WeightedObjective:
    """Weighted sum of terms, with Levenberg damping: a metric added to the Hessian alone."""

    terms: Sequence[ObjectiveTerm]
    damping: Callable[[FloatArray], BlockBanded]

    def value(self, x: FloatArray) -> float:
        """The objective at unknowns (K, n_block)."""
        return sum(term.scale * term.value(x) for term in self.terms)

    def expand(
        self, x: FloatArray, into: BlockBanded | None = None
    ) -> tuple[FloatArray, BlockBanded]:
        """Gradient (K, n_block) and damped Gauss-Newton Hessian at x (K, n_block). into: an earlier
        Hessian of its own, to be overwritten."""
        hessian = self.damping(x).copy(band=ORDER, into=into)
        gradient = np.zeros_like(x)
        for term in self.terms:
            term.expand(x, gradient, hessian)
        return gradient, hessian


def values_at_nodes(motion: Motion, t: Transcription, function: MotionFunction) -> FloatArray:
    """(N, m) a function of another motion with the same points, at the dynamics nodes of t."""
    m = motion.transcription
    state = State(m.character, m.layout, Instants(m.basis, t.node_times), motion.x)
    return function.value(state)


def torque_metric(motion: Motion, torques: TorqueFunction) -> BlockBanded:
    """Metric T'T of torque changes, for the minimum-norm step in (q, tau, lambda) (thesis 4.4).

    T: the torques' Jacobian; torques follow from movement and forces.
    """
    t = motion.transcription
    term = LeastSquares(t, torques, scale=TORQUE_CHANGE_WEIGHT)
    metric = BlockBanded(t.basis.n_coefficients, t.layout.n_block)
    term.expand(motion.x, np.zeros_like(motion.x), metric)
    return metric
