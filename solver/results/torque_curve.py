"""A motion's torques as cubic splines of their own density (thesis 4).

Torques follow from movement and forces at every instant; here they are approximated, for plots and
for others to read. They jump where contacts begin and end, so every stretch between has a spline
of its own. Unless a density is asked for, knots are added until the splines are near enough.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..numerics.splines import SplineBasis, phase_breaks
from ..transcription.motion import Motion
from ..transcription.sampling import Instants, State
from ..transcription.torque_constraint import TorqueFunction

COARSEST = 0.2  # s
FINEST = 0.01  # s
NEAR = 0.01  # of the largest torque; rms
PER_SPAN = 8


@dataclass(frozen=True)
class Piece:
    """One stretch without a jump: basis over it, coefficients (K, m) N·m."""

    basis: SplineBasis
    coefficients: FloatArray


@dataclass(frozen=True)
class TorqueCurve:
    """Torques at m joint angles. error: rms over time of the worst of them, N·m."""

    pieces: tuple[Piece, ...]
    error: float

    @property
    def n_coefficients(self) -> int:
        return sum(len(piece.coefficients) for piece in self.pieces)

    def at(self, times: FloatArray) -> FloatArray:
        """(T, m) N·m; an instant at which torques jump belongs to the stretch after it."""
        starts = [piece.basis.breaks[0] for piece in self.pieces]
        which = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, None)
        found = np.empty((len(times), self.pieces[0].coefficients.shape[1]))
        for i, piece in enumerate(self.pieces):
            mine = which == i
            found[mine] = piece.basis.combine(piece.coefficients, times[mine])
        return found


def torque_curve(
    motion: Motion, torques: TorqueFunction, *, longest: float | None = None
) -> TorqueCurve:
    """The splines nearest to a motion's torques. longest: s between knots; None chooses it."""
    stretches = [(times, exact_torques(motion, torques, times)) for times in _stretches(motion)]
    peak = max(float(np.abs(values).max()) for _, values in stretches)
    span = COARSEST if longest is None else longest
    while True:
        pieces, squares, count = [], 0.0, 0
        for times, values in stretches:
            basis = SplineBasis(*phase_breaks([times[0], times[-1]], [], span))
            piece = Piece(basis, basis.project(times, values))
            pieces.append(piece)
            squares = squares + ((basis.combine(piece.coefficients, times) - values) ** 2).sum(0)
            count += len(times)
        error = float(np.sqrt(np.max(squares) / count))
        if longest is not None or error <= NEAR * peak or span <= FINEST:
            return TorqueCurve(tuple(pieces), error)
        span *= 0.5


def exact_torques(motion: Motion, torques: TorqueFunction, times: FloatArray) -> FloatArray:
    """(T, m) N·m, by inverse dynamics."""
    t = motion.transcription
    state = State(t.character, t.layout, Instants(t.basis, times), motion.x)
    return torques.value(state) * t.character.mass * STANDARD_GRAVITY


def _stretches(motion: Motion) -> Iterator[FloatArray]:
    """Dense instants of each stretch between jumps, which are just left out."""
    basis = motion.transcription.basis
    edges = [0, *np.flatnonzero(basis.double), basis.n_spans]
    for first, last in pairwise(edges):
        breaks = basis.breaks[first : last + 1]
        inside = [
            start + (end - start) * np.linspace(0.0, 1.0, PER_SPAN, endpoint=False)
            for start, end in pairwise(breaks)
        ]
        times = np.append(np.concatenate(inside), breaks[-1])
        gap = 1e-6 * (times[-1] - times[0])
        times[0] += gap
        times[-1] -= gap
        yield times
