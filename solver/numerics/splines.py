"""Cubic B-spline basis with knots at phase boundaries (thesis 4).

A boundary is a double knot: position and velocity are continuous there, acceleration may jump.
Contact forces live in the matching space of second derivatives: linear in each span, continuous
at single knots, free to jump at double ones. So `m c'' = m g + sum of forces` can hold at every
instant, not only at nodes.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .block_banded import BlockBanded

DEGREE = 3
ORDER = DEGREE + 1
BLOCK = 8  # coefficients that a projection solves for together
THIRD_DERIVATIVE_WEIGHT = 1e-9  # regularises splines through samples that jump between contacts


@dataclass(frozen=True)
class SplineTerm:
    """Of a sum of squares at T instants: a spline's derivative by s, how much each weighs (T,), and
    the samples (T, n) that it is compared with."""

    derivative: int
    weights: FloatArray
    samples: FloatArray


@dataclass(frozen=True)
class SplineBasis:
    """Cubic B-spline basis over [breaks[0], breaks[-1]] s, clamped at both ends.

    breaks: (n_spans + 1,) increasing breakpoints, s. double: (n_spans + 1,) bool, which interior
    breakpoints are double knots.
    """

    breaks: FloatArray
    double: BoolArray

    @property
    def n_spans(self) -> int:
        """Number of polynomial pieces."""
        return len(self.breaks) - 1

    @cached_property
    def knots(self) -> FloatArray:
        """(n_coefficients + 4,) knot vector, s, with fourfold ends."""
        inner = np.repeat(self.breaks[1:-1], 1 + self.double[1:-1])
        ends = self.breaks[[0, -1]]
        return np.concatenate([np.repeat(ends[0], ORDER), inner, np.repeat(ends[1], ORDER)])

    @property
    def n_coefficients(self) -> int:
        """Number of control points."""
        return len(self.knots) - ORDER

    @cached_property
    def first_coefficient(self) -> IntArray:
        """(n_spans,) index of the first of the four coefficients that act in each span."""
        jumps = np.concatenate([[0], np.cumsum(1 + self.double[1:-1].astype(int))])
        return np.asarray(jumps, dtype=int)

    def spans(self, times: FloatArray) -> IntArray:
        """(T,) index of the span of each instant, s; a breakpoint belongs to the span after it."""
        inside = np.searchsorted(self.breaks, times, side="right") - 1
        return np.clip(inside, 0, self.n_spans - 1)

    def evaluate(
        self, times: FloatArray, derivative: int = 0, spans: IntArray | None = None
    ) -> FloatArray:
        """(T, 4) values, or derivatives by s, of the four basis functions of each instant's span.

        spans: (T,) the span each instant is taken to be in, for one-sided limits at a breakpoint.
        """
        spans = self.spans(times) if spans is None else spans
        last = self.first_coefficient[spans] + DEGREE  # knots[last] <= t < knots[last + 1]
        return _basis_functions(self.knots, last, np.asarray(times, dtype=float), derivative)

    def force_nodes(self, spans: IntArray) -> IntArray:
        """(S, 2) indices of the force nodes at the start and end of each span (S,)."""
        first = self.first_coefficient[spans]
        return np.stack([first, first + 1], axis=-1)

    def force_weights(self, times: FloatArray, spans: IntArray | None = None) -> FloatArray:
        """(T, 2) linear interpolation weights of the two force nodes of each instant's span."""
        spans = self.spans(times) if spans is None else spans
        start, end = self.breaks[spans], self.breaks[spans + 1]
        w = (times - start) / (end - start)
        return np.stack([1.0 - w, w], axis=-1)

    def matrix(self, times: FloatArray, derivative: int = 0) -> FloatArray:
        """(T, n_coefficients) collocation matrix of values, or of derivatives by s."""
        spans = self.spans(times)
        values = self.evaluate(times, derivative, spans)
        full = np.zeros((len(times), self.n_coefficients))
        columns = self.first_coefficient[spans][:, None] + np.arange(ORDER)
        np.put_along_axis(full, columns, values, axis=1)
        return full

    def combine(
        self, coefficients: FloatArray, times: FloatArray, derivative: int = 0
    ) -> FloatArray:
        """(T, n) spline values, or derivatives by s, of (n_coefficients, n) coefficients."""
        spans = self.spans(times)
        values = self.evaluate(times, derivative, spans)
        columns = self.first_coefficient[spans][:, None] + np.arange(ORDER)
        return np.asarray(np.einsum("tk,tkn->tn", values, coefficients[columns]))

    def project(self, times: FloatArray, samples: FloatArray, smooth: float = 1e-12) -> FloatArray:
        """(n_coefficients, n) penalised least-squares fit of (T, n) samples at times (T,), s.

        smooth: weight of the squared third derivative (a P-spline's penalty), just enough to
        settle spans that hold too few samples.
        """
        spans, middles = self.spans(times), 0.5 * (self.breaks[:-1] + self.breaks[1:])
        values, third = self.evaluate(times, 0, spans), self.evaluate(middles, 3)
        third *= np.diff(self.breaks)[:, None] ** 3
        squares = smooth * len(times) * third[:, :, None] * third[:, None]  # (n_spans, 4, 4)
        np.add.at(squares, spans, values[:, :, None] * values[:, None])
        right = np.zeros((self.n_coefficients, samples.shape[1]))
        columns = self.first_coefficient[spans][:, None] + np.arange(ORDER)
        np.add.at(right, columns, values[..., None] * samples[:, None])
        return _solve(self.first_coefficient, squares, right)

    def least_squares(self, times: FloatArray, terms: Sequence[SplineTerm]) -> FloatArray:
        """(n_coefficients, n) that make the sum of these terms at times (T,), s, least."""
        spans = self.spans(times)
        columns = self.first_coefficient[spans][:, None] + np.arange(ORDER)
        squares = np.zeros((self.n_spans, ORDER, ORDER))
        right = np.zeros((self.n_coefficients, terms[0].samples.shape[1]))
        for term in terms:
            values = self.evaluate(times, term.derivative, spans)
            weighted = term.weights[:, None] * values
            np.add.at(squares, spans, weighted[:, :, None] * values[:, None])
            np.add.at(right, columns, weighted[..., None] * term.samples[:, None])
        return _solve(self.first_coefficient, squares, right)

    def insert_knots(self, finer: "SplineBasis", coefficients: FloatArray) -> FloatArray:
        """Knot insertion: (n, m) coefficients of the same curve on a finer basis.

        The finer basis's knots must contain this one's. A coefficient is its piece's polar form
        (blossom) at three consecutive knots (Ramshaw 1989).
        """
        spans = np.searchsorted(finer.first_coefficient, np.arange(finer.n_coefficients), "right")
        own = np.maximum(spans - 1, 0)  # a finer span in which each coefficient acts
        start = finer.breaks[own]
        old = self.spans(0.5 * (start + finer.breaks[own + 1]))
        blocks = coefficients[self.first_coefficient[old][:, None] + np.arange(ORDER)]
        p0, p1, p2, p3 = (
            np.einsum("ck,ckn->cn", self.evaluate(start, k, old), blocks) for k in range(ORDER)
        )
        u, v, w = (
            (finer.knots[k : k + finer.n_coefficients] - start)[:, None] for k in range(1, ORDER)
        )
        return np.asarray(
            p0
            + p1 * (u + v + w) / 3.0
            + p2 / 2.0 * (u * v + v * w + u * w) / 3.0
            + p3 / 6.0 * u * v * w
        )


def _solve(first: IntArray, windows: FloatArray, right: FloatArray) -> FloatArray:
    """x of A x = right (K, n), A the sum of windows (S, 4, 4), from first (S,) on."""
    blocks, rest = -(-len(right) // BLOCK), -len(right) % BLOCK
    system = BlockBanded(blocks, BLOCK, 1)
    below = np.tril_indices(ORDER)  # a factor asks for no more
    row, column = (first[:, None] + each for each in below)
    at = (row // BLOCK - column // BLOCK, column // BLOCK, row % BLOCK, column % BLOCK)
    np.add.at(system.lower, at, windows[:, below[0], below[1]])
    filling = np.arange(BLOCK - rest, BLOCK)
    system.lower[0, -1, filling, filling] = 1.0
    padded = np.concatenate([right, np.zeros((rest, right.shape[1]))])
    x = system.factor(overwrite=True).solve(padded.reshape(blocks, BLOCK, -1))
    return np.asarray(x.reshape(padded.shape)[: len(right)])


def _basis_functions(
    knots: FloatArray, last: IntArray, t: FloatArray, derivative: int
) -> FloatArray:
    """(T, 4) Cox-de Boor recursion for many instants at once (de Boor 1978, ch. X)."""
    degree = DEGREE - derivative
    values = np.ones((len(t), 1))
    for p in range(1, degree + 1):
        values = _raise_degree(knots, last, t, values, p)
    for p in range(degree + 1, DEGREE + 1):  # B'_p = p (B_{p-1,i} / . - B_{p-1,i+1} / .)
        previous = np.zeros((len(t), p + 1))
        for i in range(p):
            left, right = knots[last - p + 1 + i], knots[last + 1 + i]
            share = p * values[:, i] / (right - left)
            previous[:, i] -= share
            previous[:, i + 1] += share
        values = previous
    return values


def _raise_degree(
    knots: FloatArray, last: IntArray, t: FloatArray, values: FloatArray, p: int
) -> FloatArray:
    """(T, p + 1) basis functions of degree p from (T, p) of degree p - 1 (de Boor 1978, ch. X)."""
    raised = np.zeros((len(t), p + 1))
    for i in range(p):
        left, right = knots[last - p + 1 + i], knots[last + 1 + i]
        share = values[:, i] / (right - left)
        raised[:, i] += (right - t) * share
        raised[:, i + 1] += (t - left) * share
    return raised


def gauss_instants(breaks: FloatArray, per_span: int) -> tuple[FloatArray, FloatArray, IntArray]:
    """Gauss-Legendre quadrature in every span: times, s, weights, s, and span indices.

    Each is flat, (n_spans * per_span,).
    """
    nodes, weights = np.polynomial.legendre.leggauss(per_span)  # type: ignore[no-untyped-call]
    half = 0.5 * np.diff(breaks)
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    times = middle[:, None] + half[:, None] * nodes
    spans = np.repeat(np.arange(len(half)), per_span)
    return times.ravel(), (half[:, None] * weights).ravel(), spans


def phase_breaks(
    boundaries: Sequence[float], extra: Sequence[float], longest: float
) -> tuple[FloatArray, BoolArray]:
    """Breakpoints (n,), s, and double-knot flags (n,) from phase boundaries.

    boundaries: sorted instants including both ends; inner ones are double knots. extra: instants
    that are single knots. No span is longer than `longest`, s.
    """
    fixed = sorted({*boundaries, *extra})
    breaks: list[float] = []
    for start, end in itertools.pairwise(fixed):
        count = max(1, int(np.ceil((end - start) / longest - 1e-9)))
        breaks.extend(np.linspace(start, end, count + 1)[:-1])
    breaks.append(fixed[-1])
    at = np.array(breaks)
    double = np.isin(at, np.array(boundaries))
    double[[0, -1]] = False
    return at, double


def greville_abscissae(basis: SplineBasis) -> FloatArray:
    """(n_coefficients,) Greville abscissae, s: the instant that each coefficient stands for."""
    k = basis.knots
    return np.asarray((k[1:-3] + k[2:-2] + k[3:-1]) / 3.0)


def dense_instants(basis: SplineBasis, per_span: int = 4) -> FloatArray:
    """Gauss instants, s, that determine a spline on this basis."""
    return gauss_instants(basis.breaks, per_span)[0]
