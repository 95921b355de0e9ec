"""Splines against scipy's, and the force space that lets the balance hold at every instant."""

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.numerics.splines import ORDER, SplineBasis, gauss_instants, phase_breaks
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

BREAKS = np.array([0.0, 0.1, 0.25, 0.3, 0.5, 0.62, 0.7])
DOUBLE = np.array([False, False, True, False, True, True, False])


@st.composite
def bases(draw: st.DrawFn) -> SplineBasis:
    """Bases with spans between 10 and 100 ms and any interior double knots."""
    spans = draw(st.lists(st.integers(10, 100), min_size=1, max_size=9))
    inner = draw(st.lists(st.booleans(), min_size=len(spans) - 1, max_size=len(spans) - 1))
    breaks = np.concatenate([[0.0], np.cumsum(spans) / 1000.0])
    return SplineBasis(breaks, np.array([False, *inner, False]))


def coefficients_of(basis: SplineBasis, columns: int = 2) -> FloatArray:
    return np.random.default_rng(basis.n_coefficients).normal(size=(basis.n_coefficients, columns))


@settings(max_examples=25)
@given(bases(), st.integers(0, 3))
def test_values_and_derivatives_are_those_of_scipy(basis: SplineBasis, derivative: int) -> None:
    c = coefficients_of(basis)
    times = gauss_instants(basis.breaks, 5)[0]
    theirs = BSpline(basis.knots, c, ORDER - 1)(times, nu=derivative)
    ours = basis.combine(c, times, derivative)
    scale = np.abs(theirs).max()
    assert ours == pytest.approx(theirs, abs=1e-11 * scale)
    assert basis.matrix(times, derivative) @ c == pytest.approx(ours, abs=1e-11 * scale)


def test_both_ends_belong_to_the_spline() -> None:
    basis = SplineBasis(BREAKS, DOUBLE)
    c = coefficients_of(basis)
    assert basis.combine(c, BREAKS[[0, -1]]) == pytest.approx(c[[0, -1]], abs=1e-14)


def test_accelerations_jump_at_double_knots_only() -> None:
    basis = SplineBasis(BREAKS, DOUBLE)
    c = coefficients_of(basis)[:, 0]
    inner = np.arange(1, basis.n_spans)

    def jump(derivative: int) -> FloatArray:
        sides = [basis.evaluate(BREAKS[inner], derivative, inner - k) for k in (1, 0)]
        first = [basis.first_coefficient[inner - k][:, None] + np.arange(ORDER) for k in (1, 0)]
        before, after = ((B * c[i]).sum(axis=1) for B, i in zip(sides, first, strict=True))
        return np.asarray(np.abs(after - before))

    assert jump(0).max() < 1e-12
    assert jump(1).max() < 1e-10
    assert jump(2)[~DOUBLE[1:-1]].max() < 1e-8
    assert jump(2)[DOUBLE[1:-1]].min() > 1.0


@settings(max_examples=25)
@given(bases())
def test_projection_reproduces_a_spline(basis: SplineBasis) -> None:
    c = coefficients_of(basis)
    times = np.linspace(0.0, basis.breaks[-1], 40 * basis.n_spans)
    found = basis.project(times, basis.combine(c, times))
    assert basis.combine(found, times) == pytest.approx(basis.combine(c, times), abs=1e-5)


def test_projection_settles_spans_without_samples() -> None:
    basis = SplineBasis(np.linspace(0.0, 1.0, 41), np.zeros(41, dtype=bool))
    times = np.linspace(0.0, 1.0, 16)  # fewer samples than unknowns
    found = basis.project(times, np.sin(3.0 * times)[:, None])
    dense = np.linspace(0.0, 1.0, 200)
    assert basis.combine(found, dense)[:, 0] == pytest.approx(np.sin(3.0 * dense), abs=1e-3)


@settings(max_examples=25)
@given(bases(), st.data())
def test_a_finer_basis_holds_the_same_curve(basis: SplineBasis, data: st.DataObject) -> None:
    chosen = data.draw(st.lists(st.booleans(), min_size=basis.n_spans, max_size=basis.n_spans))
    halves = (0.5 * (basis.breaks[:-1] + basis.breaks[1:]))[np.array(chosen)]
    breaks = np.sort(np.concatenate([basis.breaks, halves]))
    finer = SplineBasis(breaks, np.isin(breaks, basis.breaks[basis.double]))
    c = coefficients_of(basis)
    times = np.linspace(0.0, basis.breaks[-1], 301)
    moved = finer.combine(basis.insert_knots(finer, c), times)
    assert moved == pytest.approx(basis.combine(c, times), abs=1e-10)


@settings(max_examples=25)
@given(bases())
def test_every_second_derivative_lies_in_the_force_space(basis: SplineBasis) -> None:
    """So that balance at the force nodes is balance at every instant."""
    c = coefficients_of(basis)
    spans = np.arange(basis.n_spans)
    nodes = basis.force_nodes(spans)
    assert nodes.max() + 1 == basis.n_coefficients - 2
    force = np.full((basis.n_coefficients - 2, 2), np.nan)
    for side in range(2):
        ends = basis.evaluate(basis.breaks[spans + side], 2, spans)
        index = basis.first_coefficient[spans][:, None] + np.arange(ORDER)
        here = np.einsum("sk,skn->sn", ends, c[index])
        known = force[nodes[:, side]]
        assert here == pytest.approx(np.where(np.isnan(known), here, known), rel=1e-7, abs=1e-5)
        force[nodes[:, side]] = here
    assert np.isfinite(force).all()
    times, _, inside = gauss_instants(basis.breaks, 7)
    weighted = basis.force_weights(times, inside)[..., None] * force[basis.force_nodes(inside)]
    second = basis.combine(c, times, 2)
    assert weighted.sum(axis=1) == pytest.approx(second, abs=1e-9 * np.abs(second).max())


@settings(max_examples=25)
@given(bases(), st.integers(1, 4))
def test_gauss_instants_integrate_exactly(basis: SplineBasis, per: int) -> None:
    times, weights, spans = gauss_instants(basis.breaks, per)
    degree = 2 * per - 1
    end = basis.breaks[-1]
    assert weights @ times**degree == pytest.approx(end ** (degree + 1) / (degree + 1), rel=1e-10)
    assert (basis.spans(times) == spans).all()


def test_phase_breaks_double_the_inner_boundaries_and_keep_spans_short() -> None:
    breaks, double = phase_breaks([0.0, 0.5, 0.82, 1.0], [0.53, 0.9], 0.05)
    assert np.diff(breaks).max() <= 0.05 + 1e-9
    assert np.isin([0.0, 0.5, 0.53, 0.82, 0.9, 1.0], breaks).all()
    assert breaks[double].tolist() == [0.5, 0.82]


def test_phase_breaks_do_not_split_what_just_fits() -> None:
    breaks, double = phase_breaks([0.0, 0.15], [], 0.05)
    assert breaks == pytest.approx([0.0, 0.05, 0.1, 0.15])
    assert not double.any()
