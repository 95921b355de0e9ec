"""Layout of the picture: pure geometry, no Blender.

Canvas frame: x right along the direction of travel, y away from the viewer, z up.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from .annotations import Bar, Mark, Sphere, Thing, Tint, Tone, at, moved
from .instants import during, instants, nearest, same_instants, spread
from .mark_meshes import Solid, merged, solids
from .sheet import Limb, SheetRow, View

SPACING = 0.7  # m between neighbouring figures, where the spread may choose
TOUCHES = 0.04  # m, a limb nearer to a pin than this is held by it
RAISED = 0.05  # m, a pin this far above the floor stands on a step
STEP_MARGIN = 0.22  # m, how far a step reaches beyond its pins
STEP_GAP = 1.4  # m, pins further apart than this stand on different steps
BESIDE = 0.05  # m from an object, within which a hand's point touches it
RIGHT = np.array([1.0, 0.0, 0.0])
STAGGER = np.array([0.0, 1e-3, -1e-3])  # m; faces of two copies in one plane would be drawn black


@dataclass(frozen=True)
class Figure:
    """The body at one instant. centre: (L, 3) m. rotation: (L, 3, 3). com: (3,) m. Canvas frame.

    tones: by limb (index), where it has a colour of its own.
    """

    time: float
    centre: FloatArray
    rotation: FloatArray
    com: FloatArray
    tones: Mapping[int, Tone]


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
    marks: one solid for each look, pins among them.
    """

    title: str
    figures: tuple[Figure, ...]
    names: tuple[str, ...]
    sizes: FloatArray
    proximal: FloatArray
    far: BoolArray
    path: FloatArray
    pins: FloatArray
    steps: tuple[Step, ...]
    marks: tuple[Solid, ...]

    def reach(self, direction: FloatArray) -> float:
        """How far, m, figures and marks go along a unit direction (3,)."""
        half = [np.abs(direction @ each.rotation) * self.sizes / 2 for each in self.figures]
        both = zip(self.figures, half, strict=True)
        tops = [figure.centre @ direction + each.sum(axis=1) for figure, each in both]
        marks = [mark.mesh.points @ direction for mark in self.marks]
        return float(np.concatenate([*tops, *marks]).max())

    def corners(self) -> FloatArray:
        """(2, 3) lowest and highest corner of the box that figures and marks fill."""
        half = [np.abs(figure.rotation) @ self.sizes[:, :, None] / 2 for figure in self.figures]
        reach = np.concatenate(half)[..., 0]
        centre = np.concatenate([figure.centre for figure in self.figures])
        points = np.concatenate(
            [centre - reach, centre + reach, *(m.mesh.points for m in self.marks)]
        )
        return np.array([points.min(axis=0), points.max(axis=0)])


@dataclass(frozen=True)
class Layout:
    """All rows. floor: z of the ground; low, high: (3,) corners of what any row fills, m."""

    tiers: tuple[Tier, ...]
    floor: float
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class Canvas:
    """World to canvas: axes (3, 3), then shift (3,) m."""

    axes: FloatArray
    shift: FloatArray

    def points(self, world: FloatArray) -> FloatArray:
        return np.asarray(world @ self.axes.T + self.shift)

    def row(self, row: SheetRow) -> SheetRow:
        limbs = tuple(
            Limb(m.name, m.size, self.points(m.centre), self.axes @ m.rotation) for m in row.limbs
        )
        pins = self.points(row.pins.reshape(-1, 3))
        marks = tuple(moved(mark, self.axes, self.shift) for mark in row.marks)
        return replace(row, limbs=limbs, com=self.points(row.com), pins=pins, marks=marks)


def lay_out(rows: Sequence[SheetRow], view: View | None = None) -> Layout:
    """Place every row in the canvas frame. Rows need at least one instant and one limb each."""
    view = view or View()
    canvas = canvas_of(rows, view)
    turned = [canvas.row(row) for row in rows]
    lead = turned[0]
    slide = np.zeros(len(lead.times))
    if not view.in_place:
        slide = spread(lead, SPACING * (view.figures - 1))
    slides = [np.interp(row.times, lead.times, slide) for row in turned]
    same = np.stack([same_instants(lead, row) for row in turned])
    x = np.stack(
        [
            np.interp(each, row.times, row.com[:, 0] + aside)
            for each, row, aside in zip(same, turned, slides, strict=True)
        ]
    )
    wished = same[:, instants(turned, same, x, view.figures)]
    floor = min(_ground(row) for row in turned)
    tiers = tuple(_tier(*each, floor) for each in zip(turned, slides, wished, strict=True))
    reach = np.concatenate([tier.corners() for tier in tiers])
    return Layout(tiers, floor, reach.min(axis=0), reach.max(axis=0))


def canvas_of(rows: Sequence[SheetRow], view: View) -> Canvas:
    """The frame of the picture: its viewer looks at the first row's centre of mass."""
    axes = canvas_axes(rows, view.heading)
    aside = (rows[0].com @ axes.T)[:, 1].mean()
    return Canvas(axes, np.array([0.0, -aside, 0.0]))


def canvas_axes(rows: Sequence[SheetRow], heading: tuple[float, float] | None = None) -> FloatArray:
    """(3, 3) world to canvas: x along the heading, or else the travel, or the world's x."""
    travel = sum((row.com[-1] - row.com[0] for row in rows), np.zeros(3))[:2] / len(rows)
    if heading is not None:
        travel = np.array(heading)
    if np.hypot(*travel) < 1e-6:
        travel = np.array([1.0, 0.0])
    x, y = travel / np.hypot(*travel)
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])


def _ground(row: SheetRow) -> float:
    """As given; else the lowest pin, or without pins the lowest point of the body."""
    if row.ground is not None:
        return row.ground
    if len(row.pins):
        return float(row.pins[:, 2].min())
    drops = [m.centre[:, 2] - np.abs(m.rotation[:, 2]) @ m.size / 2 for m in row.limbs]
    return float(np.min(drops))


def _tier(row: SheetRow, slide: FloatArray, wished: FloatArray, floor: float) -> Tier:
    path = row.com + slide[:, None] * RIGHT
    shown = [nearest(row.times, t) for t in wished.tolist()]
    centre = np.stack([limb.centre for limb in row.limbs], axis=1)
    rotation = np.stack([limb.rotation for limb in row.limbs], axis=1)
    sizes = np.array([limb.size for limb in row.limbs])
    aside = (centre[:, :, 1] - row.com[:, None, 1]).mean(axis=0)
    if row.pin_times:
        held = [during(span, row.times, shown) for span in row.pin_times]
    else:
        near = _distances(row.pins, sizes, centre, rotation) < TOUCHES
        held = [[i for i in shown if near[i, p]] for p in range(len(row.pins))]
    pins = _pins(row.pins, held, slide)
    centre[:, :, 0] += slide[:, None]
    figures = tuple(
        Figure(float(row.times[i]), centre[i], rotation[i], path[i], _tones(row, i)) for i in shown
    )
    drawn = [*map(Sphere, pins), *_marks(row, held, slide, shown)]
    return Tier(
        row.title,
        figures,
        tuple(limb.name for limb in row.limbs),
        sizes,
        proximal_ends(sizes, centre, rotation),
        aside > 0.03,
        path,
        pins,
        () if any(isinstance(mark, Thing) for mark in row.marks) else steps(pins, floor),
        merged(solid for mark in drawn for solid in solids(mark)),
    )


def _marks(
    row: SheetRow, held: Sequence[Sequence[int]], slide: FloatArray, shown: Sequence[int]
) -> Iterable[Mark]:
    """Every mark with every figure it belongs to, where that figure is drawn; what stands still
    where figures are in place, once, as it is with the last of them. held: as of `_pins`."""
    touches = [*zip(row.pins, held, strict=True)]
    for mark in row.marks:
        if isinstance(mark, Sphere):
            touches += ((at(mark, i).place, [i]) for i in during(mark.span, row.times, shown))
    for mark in row.marks:
        when = during(mark.span, row.times, shown)
        if isinstance(mark, Thing | Bar) and not slide.any():
            when = when[-1:]
        if isinstance(mark, Thing):
            yield from _things(mark, touches, slide, when, row.com)
        else:
            yield from (moved(at(mark, i), np.eye(3), slide[i] * RIGHT) for i in when)


def _things(
    thing: Thing,
    touches: Sequence[tuple[FloatArray, Sequence[int]]],
    slide: FloatArray,
    when: Sequence[int],
    com: FloatArray,
) -> Iterable[Thing]:
    """An object with those figures that touch it, as a step goes on below them; one that none does
    as often as it is beside itself, but a wall once, with the figure that comes nearest. touches:
    places (3,) m, before they slide, with instants. com: (T, 3) m, likewise."""
    copies = {i: at(thing, i) for i in when}
    on = [i for i in when if any(i in held and _is_on(copies[i], p) for p, held in touches)]
    if thing.wall and not on:
        when = sorted(when, key=lambda i: _apart(copies[i], com[i]))[:1]
    end = -np.inf
    for k, i in enumerate(on or when):
        low, high = (edge(copies[i].points[:, 0]) + slide[i] for edge in (np.min, np.max))
        if (on and not thing.wall) or low > end:
            end = high
            yield moved(copies[i], np.eye(3), slide[i] * RIGHT + k * STAGGER)


def _apart(thing: Thing, place: FloatArray) -> float:
    """M, level, from the box around an object to a place (3,) m."""
    low, high = thing.points.min(axis=0), thing.points.max(axis=0)
    return float(np.linalg.norm(np.maximum(np.maximum(low - place, place - high), 0.0)[:2]))


def _is_on(thing: Thing, place: FloatArray) -> bool:
    """Whether a point (3,) m is in the box around an object, or nearly."""
    low, high = thing.points.min(axis=0) - BESIDE, thing.points.max(axis=0) + BESIDE
    return bool(((low < place) & (place < high)).all())


def _tones(row: SheetRow, instant: int) -> dict[int, Tone]:
    return {
        i: mark.tone
        for mark in row.marks
        if isinstance(mark, Tint) and during(mark.span, row.times, [instant]) == [instant]
        for i, limb in enumerate(row.limbs)
        if limb.name in mark.limbs
    }


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
    return np.asarray(np.linalg.norm(local.clip(min=0.0), axis=3).min(axis=2))


def _pins(pins: FloatArray, held: Sequence[Sequence[int]], slide: FloatArray) -> FloatArray:
    """(N, 3) each pin at every instant (index) at which it is drawn."""
    drawn = [pin + slide[i] * RIGHT for pin, when in zip(pins, held, strict=True) for i in when]
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
