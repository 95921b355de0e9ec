"""Steps in parts of a motion: where few spans are still violated, only what is about them changes.

Of a long motion some place always converges last. What a minimum-norm step does for it fades away
within some tenths of a second, as the metric is a movement's and feet hold it; so the linearised
problem of the spans about it, with the rest of the motion as it is, has nearly the same step, at a
cost that does not grow with the motion.
"""

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import ORDER
from ..transcription.rows import Rows
from ..transcription.transcription import Transcription
from .kkt_step import LinearisedProblem

MARGIN = 0.5  # s, on both sides of a violated span; with half of it such a step is half longer
MOST_IN_PARTS = 0.5  # of all spans; steps in more parts cost as much as one of the whole


def parts_around(spans: IntArray, breaks: FloatArray) -> list[slice]:
    """Parts of all spans that are up to MARGIN from some of these, ascending and apart; none where
    they are most of all.

    spans: ascending indices. breaks: (n_spans + 1,) s.
    """
    starts = np.searchsorted(breaks, breaks[spans] - MARGIN, side="right") - 1
    stops = np.searchsorted(breaks, breaks[spans + 1] + MARGIN)
    count = len(breaks) - 1
    parts: list[slice] = []
    for start, stop in zip(starts.clip(0).tolist(), stops.clip(None, count).tolist(), strict=True):
        begins = parts.pop().start if parts and start <= parts[-1].stop else start
        parts.append(slice(begins, stop))
    few = sum(part.stop - part.start for part in parts) <= MOST_IN_PARTS * count
    return parts if few else []


def local_step(
    transcription: Transcription,
    places: FloatArray,
    metric: BlockBanded,
    x: FloatArray,
    part: slice,
    basis: FloatArray | None,
) -> FloatArray:
    """Minimum-norm step (K, n_block) from x (K, n_block) to where the rows of a part of the spans
    hold; zero in all blocks that act elsewhere too.

    places: (n_contacts, 3) m. metric: W of the whole motion. basis: see LinearisedProblem.
    """
    t = transcription.within(part)
    rows, free = t.rows(x, places), t.active[t.blocks].any(axis=1)
    problem = LinearisedProblem(t, rows, metric.part(t.blocks, free), basis=basis)
    return problem.step(_without_edges(t, rows, free), limp_to_middle=True).d


def _without_edges(t: Transcription, rows: Rows, free: BoolArray) -> FloatArray:
    """(R,) values of the rows, of which those hold that depend on blocks that stay: they nearly
    do, and what is free of their unknowns could not settle the rest."""
    first = t.basis.first_coefficient[rows.span] - t.blocks.start
    inner = free[first[:, None] + np.arange(ORDER)].all(axis=1)
    return np.where(inner, rows.value, rows.value.clip(rows.lower, rows.upper))
