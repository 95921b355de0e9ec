"""Selection of the instants shown, and sideways spread of the figures over time: no Blender.

A jump stays on one spot while it crouches and recovers; drawn in place, those figures would hide
each other. So a row is spread: figures slide to the right as time passes, the faster the more the
body moves without travelling. Every row slides by the same amount at the same time: a landing that
is 0.3 m further in the world is 0.3 m further in the picture.
"""

from collections.abc import Sequence

import numpy as np

from ...solver.arrays import FloatArray
from .sheet import SheetRow

CLOSE = 0.35  # m, figures nearer to each other than this hide each other
KEYS_CLOSE = 0.55  # key times nearer than this share of an even spacing are not all shown
SMOOTH = 0.15  # s, over which the spread's speed is averaged: a flight's path stays a parabola
MOMENTARY = 0.15  # s, a mark that is shown no longer than this wants a figure of its own


def spread(row: SheetRow, span: float) -> FloatArray:
    """(T,) m, how far each instant slides to the right so that the row spans about `span` m.

    Zero at the instant of fastest travel; never to the left as time passes.
    """
    if len(row.times) < 2:
        return np.zeros(len(row.times))
    step = np.diff(row.times)
    centres = np.stack([limb.centre for limb in row.limbs], axis=1)
    bustle = np.linalg.norm(np.diff(centres, axis=0), axis=2).mean(axis=1) / step
    bustle = _smooth(np.sqrt(bustle), SMOOTH / step.mean())
    travel = np.diff(row.com[:, 0]) / step

    def slid(k: float) -> FloatArray:
        rate = (k * bustle - travel).clip(min=0.0)
        return np.concatenate([[0.0], np.cumsum(rate * step)])

    low, high = 0.0, 100.0
    for _ in range(40):  # the span grows with k
        k = (low + high) / 2
        low, high = (k, high) if np.ptp(row.com[:, 0] + slid(k)) < span else (low, k)
    slide = slid(low)
    return np.asarray(slide - slide[np.argmax(travel)])


def _smooth(x: FloatArray, samples: float) -> FloatArray:
    """Gaussian average over about so many samples; the ends are held."""
    reach = max(int(samples), 1)
    kernel = np.exp(-0.5 * np.linspace(-2.0, 2.0, 2 * reach + 1) ** 2)
    return np.convolve(np.pad(x, reach, mode="edge"), kernel / kernel.sum(), mode="valid")


def same_instants(lead: SheetRow, row: SheetRow) -> FloatArray:
    """(T,) s, a row's instants at which it is where the lead is at each of its own: between the
    same key times, where both have as many, else at the same time."""
    if len(lead.key_times) != len(row.key_times):
        return lead.times.clip(row.times[0], row.times[-1])
    was, now = (
        np.array([each.times[0], *sorted(each.key_times), each.times[-1]]) for each in (lead, row)
    )
    return np.interp(lead.times, was, now)


def instants(rows: Sequence[SheetRow], same: FloatArray, x: FloatArray, count: int) -> list[int]:
    """Indices of about `count` of the first row's instants worth showing in all rows.

    same: (R, T) s, each row's instants that go with them. x: (R, T) m, where each would be drawn.
    Key times, momentary marks, ends, lowest and highest; the others are put where the gaps are
    widest. No figure hides another in any row.
    """
    z = rows[0].com[:, 2]
    keys = [nearest(s, t) for row, s in zip(rows, same, strict=True) for t in row.key_times]
    marks = [nearest(s, t) for row, s in zip(rows, same, strict=True) for t in _momentary(row)]
    wished = [*marks, 0, len(z) - 1, int(z.argmin()), int(z.argmax())]
    kept = _apart(x, keys, wished, count)
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(x[0])))])
    gaps = np.diff(along[kept])
    parts = np.ones(len(gaps), dtype=int)
    while parts.sum() < count - 1 and np.max(gaps / parts, initial=0.0) > 1.4 * CLOSE:
        parts[np.argmax(gaps / parts)] += 1
    shown = set(kept)
    for start, gap, n in zip(along[kept], gaps, parts, strict=False):
        between = start + gap * np.arange(1, n) / n
        shown.update(np.searchsorted(along, between).tolist())
    return _apart(x, keys, sorted(shown), len(shown))


def _apart(x: FloatArray, keys: Sequence[int], wished: Sequence[int], count: int) -> list[int]:
    """Indices of the key times, then of those wished for, that none before hides; in order.

    count: about how many figures a row will have.
    """
    kept: list[int] = []
    even = float(np.ptp(x[0])) / max(count - 1, 1)
    for apart, candidates in ((KEYS_CLOSE * even, keys), (CLOSE, wished)):
        for i in candidates:
            if np.abs(x[:, kept] - x[:, [i]]).min(initial=np.inf) >= apart:
                kept.append(i)
    return sorted(kept)


def nearest(times: FloatArray, t: float) -> int:
    """Index of the instant nearest to t."""
    return int(np.abs(times - t).argmin())


def during(span: tuple[float, float], times: FloatArray, shown: Sequence[int]) -> list[int]:
    """Those of the shown instants (indices) that lie in a span; its own middle if none does.

    A span that the row does not reach has none. Ends count to the nearest of the row's instants.
    """
    edge = 0.51 * float(np.ptp(times)) / max(len(times) - 1, 1)
    held = [i for i in shown if span[0] - edge <= times[i] <= span[1] + edge]
    if held or span[1] < times[0] or span[0] > times[-1]:
        return held
    return [nearest(times, (span[0] + span[1]) / 2)]


def _momentary(row: SheetRow) -> list[float]:
    """Middles, s, of marks that are shown for a moment only."""
    return [(a + b) / 2 for a, b in (mark.span for mark in row.marks) if b - a < MOMENTARY]
