"""What it costs to come back to the recording beyond a motion's two ends.

A motion that ends is free to leave its target there: a beam on an elastic bed gives four times as
much at a free end. But the performance goes on beyond the range, and so would the motion. The least
∫ |e|² + τ⁴ |e''|² dt of markers' errors e that begin with e and e' at an end is the cost-to-go of a
double integrator (Anderson & Moore 1990, 3.1): √2 τ |e|² + 2 τ² e·e' + √2 τ³ |e'|².
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..body.kinematics import BodyPoint, Pose, forward_kinematics
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import ORDER
from ..transcription.transcription import Transcription


@dataclass(frozen=True)
class EndTarget:
    """Reference motion at the first and last instant.

    markers: (2, M, 3) m world. com_velocity: (2, 3) m/s world. rates: (2, n_angles) rad/s.
    """

    markers: FloatArray
    com_velocity: FloatArray
    rates: FloatArray


@dataclass(frozen=True)
class CostToGo:
    """Half the cost-to-go at both ends, a mean over `points`, in m² s; Gauss-Newton derivatives.

    time: τ, s. weights: before the first instant and beyond the last, of a square metre of error
    during a second.
    """

    transcription: Transcription
    target: EndTarget
    points: tuple[BodyPoint, ...]
    time: float
    weights: tuple[float, float]

    @cached_property
    def _basis(self) -> FloatArray:
        """(2, 2, 4) the basis functions and their first derivatives at both ends."""
        basis = self.transcription.basis
        times, spans = basis.breaks[[0, -1]], np.array([0, basis.n_spans - 1])
        return np.stack([basis.evaluate(times, k, spans) for k in (0, 1)], axis=1)

    @property
    def _form(self) -> FloatArray:
        """(2, 2, 2) quadratic form in error and velocity; at the first instant time runs back."""
        root, square = np.sqrt(2.0) * self.time, self.time**2
        both = np.array([[root, square], [square, root * square]])
        reversed_time = both * [[1.0, -1.0], [-1.0, 1.0]]
        before, after = self.weights
        return np.stack([before * reversed_time, after * both])

    def _errors(self, x: FloatArray) -> tuple[Pose, FloatArray]:
        """Poses at both ends, and (2, 2, M, 3) the markers' errors and velocities of these."""
        t, target = self.transcription, self.target
        com, angles = t.layout.com, t.layout.angles
        spans = np.array([0, t.basis.n_spans - 1])
        local = t.window(x, spans)[..., t.layout.motion]
        value, slope = np.einsum("edk,ekj->dej", self._basis, local)
        posed = forward_kinematics(t.character, value[:, angles])
        apart = posed.points(self.points) + value[:, None, com] - target.markers
        moving = posed.point_rates(self.points, slope[:, angles] - target.rates)
        moving += (slope[:, com] - target.com_velocity)[:, None]
        return posed, np.stack([apart, moving], axis=1)

    def value(self, x: FloatArray) -> float:
        """At unknowns x (K, n_block)."""
        errors = self._errors(x)[1]
        total = np.einsum("edf,edmi,efmi->", self._form, errors, errors)
        return 0.5 * float(total) / len(self.points)

    def expand(self, x: FloatArray, gradient: FloatArray, matrix: BlockBanded) -> None:
        """Adds the derivatives at x to gradient (K, n_block) and matrix."""
        t = self.transcription
        posed, errors = self._errors(x)
        turn = posed.point_jacobian(self.points)
        move = np.concatenate([np.broadcast_to(np.eye(3), (*turn.shape[:2], 3, 3)), turn], axis=3)
        flat = move.reshape(2, -1, t.layout.n_motion) / np.sqrt(len(self.points))
        metric = np.swapaxes(flat, 1, 2) @ flat
        scaled = errors.reshape(2, 2, -1) / np.sqrt(len(self.points))
        pull = np.einsum("edf,efr,erj->edj", self._form, scaled, flat)
        slope = np.einsum("edk,edj->ekj", self._basis, pull)
        pairs = np.einsum("edk,edf,efl->ekl", self._basis, self._form, self._basis)
        windows = np.einsum("ekl,eij->ekilj", pairs, metric)
        first = t.basis.first_coefficient[[0, -1]]
        matrix.add_windows(first, windows, t.layout.motion)
        for k in range(ORDER):
            gradient[first + k, t.layout.motion] += slope[:, k]
