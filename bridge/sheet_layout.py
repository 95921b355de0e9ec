"""Where everything goes in the picture: pure geometry, no Blender.

Canvas frame: x right along the direction of travel, y away from the viewer, z up.

A jump stays on one spot while it crouches and recovers; drawn in place, those figures would hide
each other. So a row is spread: figures slide to the right as time passes, the faster the more the
body moves without travelling. Every row slides by the same amount at the same time: a landing that
is 0.3 m further in the world is 0.3 m further in the picture.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..solver.recording import FloatArray
from .sheet import Limb, SheetRow

FIGURES = 10
SPACING = 0.7  # m between neighbouring figures, where the spread may choose
CLOSE = 0.35  # m, figures nearer to each other than this hide each other
SMOOTH = 0.15  # s, over which the spread's speed is averaged: a flight's path stays a parabola
TOUCHES = 0.04  # m, a limb nearer to a pin than this is held by it
RAISED = 0.05  # m, a pin this far above the floor stands on a step
STEP_MARGIN = 0.22  # m, how far a step reaches beyond its pins
STEP_GAP = 1.4  # m, pins further apart than this stand on different steps


@dataclass(frozen=True)
class Figure:
    """The body at one instant. centre: (L, 3) m. rotation: (L, 3, 3). com: (3,) m. Canvas frame."""

    time: float
    centre: FloatArray
    rotation: FloatArray
    com: FloatArray


@dataclass(frozen=True)
class Step:
    """A raised floor from x = left to x = right, its top at z = top, m."""

    left: float
    right: float
    top: float


@dataclass(frozen=True)
class Tier:
    """One row, ready to be drawn. path: (T, 3) and pins: (N, 3) m, canvas frame.

    sizes: (L, 3) box extents. proximal: (L,) +1 or -1, the end of each limb's long axis that is
    joined to the heavier neighbour. far: (L,) whether the limb is on the side away from the viewer.
    """

    title: str
    figures: tuple[Figure, ...]
    names: tuple[str, ...]
    sizes: FloatArray
    proximal: FloatArray
    far: NDArray[np.bool_]
    path: FloatArray
    pins: FloatArray
    steps: tuple[Step, ...]

    def corners(self) -> FloatArray:
        """(2, 3) lowest and highest corner of the box that the figures fill."""
        half = [np.abs(figure.rotation) @ self.sizes[:, :, None] / 2 for figure in self.figures]
        reach = np.stack(half)[..., 0]
        centre = np.stack([figure.centre for figure in self.figures])
        return np.array([(centre - reach).min(axis=(0, 1)), (centre + reach).max(axis=(0, 1))])


@dataclass(frozen=True)
class Layout:
    """All rows. floor: z of the ground; left, right: what the figures of any row reach, m."""

    tiers: tuple[Tier, ...]
    floor: float
    left: float
    right: float


def lay_out(rows: Sequence[SheetRow]) -> Layout:
    """Place every row in the canvas frame. Rows need at least one instant and one limb each."""
    axes = canvas_axes(rows)
    turned = [_turn(row, axes) for row in rows]
    lead = turned[0]
    slide = spread(lead, SPACING * (FIGURES - 1))
    wished = lead.times[instants(lead, lead.com[:, 0] + slide)]
    floor = min(_lowest(row) for row in turned)
    tiers = tuple(_tier(r, np.interp(r.times, lead.times, slide), wished, floor) for r in turned)
    reach = np.concatenate([tier.corners()[:, 0] for tier in tiers])
    return Layout(tiers, floor, float(reach.min()), float(reach.max()))


def canvas_axes(rows: Sequence[SheetRow]) -> FloatArray:
    """(3, 3) world to canvas: x along the travel, or where the body faces if it hardly travels."""
    travel = sum((row.com[-1] - row.com[0] for row in rows), np.zeros(3))[:2] / len(rows)
    if np.hypot(*travel) < 0.3:
        trunk = max(rows[0].limbs, key=lambda limb: float(np.prod(limb.size)))
        travel = trunk.rotation[:, :2, 1].mean(axis=0)
    if np.hypot(*travel) < 1e-6:
        travel = np.array([1.0, 0.0])
    x, y = travel / np.hypot(*travel)
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])


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
    return slide - slide[np.argmax(travel)]


def _smooth(x: FloatArray, samples: float) -> FloatArray:
    """Gaussian average over about so many samples; the ends are held."""
    reach = max(int(samples), 1)
    kernel = np.exp(-0.5 * np.linspace(-2.0, 2.0, 2 * reach + 1) ** 2)
    return np.convolve(np.pad(x, reach, mode="edge"), kernel / kernel.sum(), mode="valid")


def instants(row: SheetRow, x: FloatArray, count: int = FIGURES) -> list[int]:
    """Indices of about `count` instants worth showing, x: (T,) m where each would be drawn.

    Key times, ends, lowest and highest; the others are put where the gaps are widest.
    """
    z = row.com[:, 2]
    kept = with_keys(row, x, [0, len(x) - 1, int(z.argmin()), int(z.argmax())])
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(x)))])
    gaps = np.diff(along[kept])
    parts = np.ones(len(gaps), dtype=int)
    while parts.sum() < count - 1 and np.max(gaps / parts, initial=0.0) > 1.4 * CLOSE:
        parts[np.argmax(gaps / parts)] += 1
    shown = set(kept)
    for start, gap, n in zip(along[kept], gaps, parts, strict=False):
        between = start + gap * np.arange(1, n) / n
        shown.update(np.searchsorted(along, between).tolist())
    return sorted(shown)


def with_keys(row: SheetRow, x: FloatArray, wished: Sequence[int]) -> list[int]:
    """Indices of the key times, and of those wished for that no other one hides; in order."""
    kept = {_nearest(row.times, t) for t in row.key_times}
    for i in wished:
        if all(abs(x[i] - x[j]) >= CLOSE for j in kept):
            kept.add(i)
    return sorted(kept)


def _nearest(times: FloatArray, t: float) -> int:
    return int(np.abs(times - t).argmin())


def _turn(row: SheetRow, axes: FloatArray) -> SheetRow:
    limbs = tuple(Limb(m.name, m.size, m.centre @ axes.T, axes @ m.rotation) for m in row.limbs)
    pins = row.pins.reshape(-1, 3) @ axes.T
    return replace(row, limbs=limbs, com=row.com @ axes.T, pins=pins)


def _lowest(row: SheetRow) -> float:
    """The ground: the lowest pin, or without pins the lowest point of the body."""
    if len(row.pins):
        return float(row.pins[:, 2].min())
    drops = [m.centre[:, 2] - np.abs(m.rotation[:, 2]) @ m.size / 2 for m in row.limbs]
    return float(np.min(drops))


def _tier(row: SheetRow, slide: FloatArray, wished: FloatArray, floor: float) -> Tier:
    path = row.com + slide[:, None] * np.array([1.0, 0.0, 0.0])
    shown = with_keys(row, path[:, 0], [_nearest(row.times, t) for t in wished.tolist()])
    centre = np.stack([limb.centre for limb in row.limbs], axis=1)
    rotation = np.stack([limb.rotation for limb in row.limbs], axis=1)
    sizes = np.array([limb.size for limb in row.limbs])
    aside = (centre[:, :, 1] - row.com[:, None, 1]).mean(axis=0)
    if row.pin_times:
        away = _out_of_time(row.pin_times, row.times)
    else:
        away = _distances(row.pins, sizes, centre, rotation) / TOUCHES
    pins = _pins(row.pins, away, slide, shown)
    centre[:, :, 0] += slide[:, None]
    figures = tuple(Figure(float(row.times[i]), centre[i], rotation[i], path[i]) for i in shown)
    return Tier(
        row.title,
        figures,
        tuple(limb.name for limb in row.limbs),
        sizes,
        proximal_ends(sizes, centre, rotation),
        aside > 0.03,
        path,
        pins,
        steps(pins, floor),
    )


def proximal_ends(sizes: FloatArray, centre: FloatArray, rotation: FloatArray) -> FloatArray:
    """(L,) +1 or -1: the end of each limb's long axis that stays nearest to a larger limb's end."""
    limbs = np.arange(len(sizes))
    longest = sizes.argmax(axis=1)
    half = rotation[:, limbs, :, longest].swapaxes(0, 1) * sizes[limbs, longest, None] / 2
    ends = np.stack([centre - half, centre + half], axis=2)  # (T, L, 2, 3)
    volume = sizes.prod(axis=1)
    signs = np.ones(len(sizes))
    for i in limbs:
        larger = ends[:, volume > volume[i] + 1e-12].reshape(len(ends), 1, -1, 3)
        if larger.size:
            apart = np.linalg.norm(ends[:, i, :, None] - larger, axis=3).mean(axis=0)
            signs[i] = 2 * int(apart.min(axis=1).argmin()) - 1
    return signs


def _distances(
    pins: FloatArray, sizes: FloatArray, centre: FloatArray, rotation: FloatArray
) -> FloatArray:
    """(T, P) m from each pin to the nearest limb's box."""
    away = pins[:, None, :] - centre[:, None, :, :]  # (T, P, L, 3)
    local = np.abs(np.einsum("tlij,tpli->tplj", rotation, away)) - sizes / 2
    return np.linalg.norm(local.clip(min=0.0), axis=3).min(axis=2)


def _out_of_time(spans: Sequence[tuple[float, float]], times: FloatArray) -> FloatArray:
    """(T, P) zero in the middle of a pin's span, 1 at its ends, more outside it."""
    first, last = np.array(spans).T
    return np.abs(times[:, None] - (first + last) / 2) / np.maximum((last - first) / 2, 1e-9)


def _pins(pins: FloatArray, away: FloatArray, slide: FloatArray, shown: list[int]) -> FloatArray:
    """(N, 3) each pin under every figure that it holds; one that holds none of them is left out.

    away: (T, P) from how far the body misses each pin; it is held up to 1.
    """
    drawn = []
    for p, place in enumerate(pins):
        held = [i for i in shown if away[i, p] <= 1.0 + 1e-6]
        drawn += [place + np.array([slide[i], 0.0, 0.0]) for i in held]
    return np.array(drawn).reshape(-1, 3)


def steps(pins: FloatArray, floor: float) -> tuple[Step, ...]:
    """Raised floors under the pins (N, 3) that are not on the ground."""
    found: list[Step] = []
    for x, _, z in sorted(pins[pins[:, 2] > floor + RAISED].tolist()):
        wide = Step(x - STEP_MARGIN, x + STEP_MARGIN, z)
        last = found[-1] if found else None
        if last and x - last.right < STEP_GAP - STEP_MARGIN and abs(z - last.top) < RAISED:
            found[-1] = Step(last.left, wide.right, min(z, last.top))
        else:
            found.append(wide)
    return tuple(found)
