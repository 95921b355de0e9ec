"""Knot refinement: splits spans until a motion holds between the nodes too (thesis 6.4)."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import SplineBasis
from ..optimisation.restoration import restore
from ..optimisation.sqp import FeasibleSet, Outcome, Progress
from ..transcription.motion import DenseTolerance, Motion, spans_to_refine, split_spans

MAX_REFINEMENTS = 3

MetricOf = Callable[[Motion], BlockBanded]
"""Metric W of the minimum-norm steps at a motion."""


def refine(
    outcome: Outcome,
    metric_of: MetricOf,
    tolerance: DenseTolerance,
    progress: Progress | None = None,
    *,
    basis: FloatArray | None = None,
) -> list[Outcome]:
    """Knot refinement: splits spans until dynamics and pins hold between the nodes (thesis 6.4).

    basis: the changes of a block that are allowed, see FeasibleSet.
    """
    outcomes: list[Outcome] = []
    for _ in range(MAX_REFINEMENTS):
        motion = Motion(outcome.transcription, outcome.x, outcome.places)
        weak = spans_to_refine(motion, tolerance)
        if not len(weak):
            break
        finer = on_finer_basis(motion, weak)
        metric = metric_of(finer)
        feasible = FeasibleSet(finer.transcription, outcome.places, basis)
        finer_outcome = restore(feasible, metric, finer.x, stage="refine", progress=progress)
        if finer_outcome.status is not Status.SOLVED:
            break  # what was solved for stands; its residual between the nodes is reported
        outcome = finer_outcome
        outcomes.append(outcome)
    return outcomes


def on_finer_basis(motion: Motion, spans: IntArray) -> Motion:
    """Knot insertion: the same motion with some spans split in two."""
    old = motion.transcription
    breaks = split_spans(old.basis.breaks, spans)
    double = np.isin(breaks, old.basis.breaks[old.basis.double])
    basis = SplineBasis(breaks, double)
    new = replace(old, basis=basis)
    x = np.zeros((basis.n_coefficients, old.layout.n_block))
    x[:, old.layout.motion] = old.basis.insert_knots(basis, motion.x[:, old.layout.motion])
    inner = np.arange(basis.n_spans)
    nodes = basis.force_nodes(inner)
    middles = 0.5 * (breaks[:-1] + breaks[1:])
    was = old.basis.spans(middles)
    values = motion.x[old.layout.force_block(old.basis.force_nodes(was))][:, :, old.layout.forces]
    for side in range(2):
        weights = old.basis.force_weights(breaks[inner + side], was)
        x[old.layout.force_block(nodes[:, side]), old.layout.forces] = np.einsum(
            "tk,tkn->tn", weights, values
        )
    x[~new.active] = 0.0
    return Motion(new, x, motion.places)
