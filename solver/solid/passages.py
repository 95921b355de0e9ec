"""Passages: what goes into an object on one side and leaves it on another has one way out.

By the nearest face a limb that passes a thin bar is pushed back until the bar's middle and forth
after it, so that nothing moves. So one way is chosen for all that passes at that time, and for as
long as it does: that along which the least is missing, shortly before and after included. Back and
forth are none then, as what is yet before the bar would have to be behind it.
"""

from collections.abc import Iterator, Set
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.character import Character
from ..data.constants import UP
from ..transcription.motion import Motion
from .mesh_surface import OPPOSITE, MeshSurface
from .penetrations import MOST_NEW, SPACING, Penetrations, placed_at
from .surfaces import Surface, Surfaces
from .way_out import WayOut, as_way

ALIKE = 2  # decimals of two ways out that count as one
TORN = 0.05  # m deep at a first or last instant: beside an edge of an open mesh; 12 m/s are less
AROUND = 0.1  # s, before and after, in which a way out must be none of the way itself
TOGETHER = 2.0 * AROUND  # s, within which what passes does so as one


@dataclass(frozen=True)
class Passable:
    """An object's mesh, whose items begin at `first` among the surfaces', and its ways out, whose
    items begin at `first_way`, one way's after the other's. linked: (B, B), which bodies are one
    limb's: neighbours at a joint, and each itself."""

    mesh: MeshSurface
    ways: tuple[WayOut, ...]
    first: int
    first_way: int
    linked: BoolArray

    def directed(
        self, found: Penetrations, kept: Penetrations, motion: Motion, given_up: Set[str]
    ) -> tuple[Penetrations, Penetrations]:
        """What is found, and of what passes all that is not beyond the object on its way; and what
        is kept: what has rows already, but for those by the nearest face of what passes.

        A passage that has rows keeps to their way. given_up: names of what is not taken along.
        """
        mine = self._of_mesh(found)
        order = np.flatnonzero(mine)[np.argsort(found.times[mine], kind="stable")]
        ends = np.flatnonzero(np.diff(found.times[order]) > TOGETHER) + 1
        parts = found.some(~mine)
        for group in np.split(order, ends) if len(order) else ():
            passing = found.some(group)
            way = self._kept(passing, kept)
            if way is None and self._goes_through(passing, motion):
                way = self._shortest(passing, motion)
            missing = passing if way is None else self._on(way, passing, motion).but(given_up)
            if way is None or not len(missing.items):
                parts = parts.with_more(passing)
                continue
            parts = parts.with_more(missing)
            times = _around(passing, motion)
            during = (kept.times >= times[0]) & (kept.times <= times[-1])
            kept = kept.some(~(during & self._of_mesh(kept)))
        return parts, kept

    def _of_mesh(self, found: Penetrations) -> BoolArray:
        """(M,) which are the mesh's items."""
        last = self.first + len(self.mesh.names)
        return np.asarray((found.items >= self.first) & (found.items < last))

    def _on(self, way: int, passing: Penetrations, motion: Motion) -> Penetrations:
        """All shapes that are not beyond the object on a way, while and where some pass it: one
        that is lifted over it shall not leave the next one in."""
        placed = placed_at(motion, _around(passing, motion))
        instants, items = self.ways[way].beneath(placed)
        over = -self.ways[way].closest(placed, instants, items).distance
        lower = np.full(len(items), passing.lower.min())
        found = Penetrations(
            passing.names,
            self.first_way + way * len(self.mesh.names) + items,
            placed.times[instants],
            over + lower,
            lower,
            np.zeros((len(items), 3)),
        )
        return found.some(found.over > MOST_NEW)

    def _kept(self, passing: Penetrations, rows: Penetrations) -> int | None:
        """The way of rows at about the same time."""
        ways = (rows.items - self.first_way) // len(self.mesh.names)
        start, end = passing.times.min() - TOGETHER, passing.times.max() + TOGETHER
        near = (rows.times >= start) & (rows.times <= end) & (ways >= 0) & (ways < len(self.ways))
        return int(np.bincount(ways[near]).argmax()) if near.any() else None

    def _goes_through(self, passing: Penetrations, motion: Motion) -> bool:
        """Whether a limb's nearest ways out go to opposite sides, or it is torn through."""
        placed = placed_at(motion, passing.times)
        items = passing.items - self.first
        closest = self.mesh.closest(placed, np.arange(len(passing.times)), items)
        _, turns = self.mesh.motion.at(placed.times)
        out = np.einsum("nji,nj->ni", turns, closest.normal)
        if self._opposed(closest.bodies[:, 0], out):
            return True
        within = (passing.times > SPACING) & (passing.times < motion.duration - SPACING)
        ends = np.concatenate([run[[0, -1]] for run in _runs(passing)])
        return bool(((closest.distance[ends] < -TORN) & within[ends]).any())

    def _opposed(self, bodies: IntArray, out: FloatArray) -> bool:
        """Whether ways out (N, 3) of one limb's bodies (N,) go to opposite sides. Most are alike,
        for an object has few faces."""
        unlike = np.unique(np.column_stack([bodies, np.round(out, ALIKE)]), axis=0)
        which, out = unlike[:, 0].astype(int), unlike[:, 1:]
        return bool((self.linked[np.ix_(which, which)] & (out @ out.T < OPPOSITE)).any())

    def _shortest(self, passing: Penetrations, motion: Motion) -> int:
        """The way along which the least is missing."""
        times = _around(passing, motion)
        placed, shapes = placed_at(motion, times), np.unique(passing.items - self.first)
        instants, items = (each.ravel() for each in np.meshgrid(np.arange(len(times)), shapes))
        far = [-way.closest(placed, instants, items).distance.min() for way in self.ways]
        return int(np.argmin(far))


def with_ways(surfaces: Surfaces, character: Character) -> tuple[Surfaces, tuple[Passable, ...]]:
    """The surfaces, and after them the ways out of the meshes among them, which nobody seeks."""
    first, behind = 0, len(surfaces.names)
    ways: list[Surface] = []
    passables, linked = [], _linked(character)
    for part in surfaces.parts:
        if isinstance(part, MeshSurface) and part.names:
            out = ways_out(part)
            passables.append(Passable(part, out, first, behind, linked))
            ways += out
            behind += len(out) * len(part.names)
        first += len(part.names)
    return Surfaces((*surfaces.parts, *ways)), tuple(passables)


def _linked(character: Character) -> BoolArray:
    linked = np.eye(len(character.bodies), dtype=bool)
    for body, joint in enumerate(character.joints):
        if joint.parent >= 0:
            linked[body, joint.parent] = linked[joint.parent, body] = True
    return linked


def ways_out(mesh: MeshSurface) -> tuple[WayOut, ...]:
    """Both ways along the object's own axes, along those that it is longest and shortest along, and
    up and down as it stands at first."""
    thing = mesh.motion.thing
    spread = thing.vertices - thing.vertices.mean(axis=0)
    longest = np.linalg.eigh(spread.T @ spread)[1].T
    lines = [*np.eye(3), *longest, thing.rotations[0].T @ UP]
    ways = dict.fromkeys(as_way(sign * line) for line in lines for sign in (1.0, -1.0))
    none = np.zeros(len(mesh.names))
    return tuple(
        WayOut(mesh.motion, way, mesh.shapes, none, mesh.names, sought=False) for way in ways
    )


def _around(passing: Penetrations, motion: Motion) -> FloatArray:
    """Instants, s, from before to after."""
    start, end = passing.times.min() - AROUND, passing.times.max() + AROUND
    return np.arange(max(start, 0.0), min(end, motion.duration), SPACING)


def _runs(passing: Penetrations) -> Iterator[IntArray]:
    """Indices of each item, in time, parted where it is out."""
    order = np.lexsort((passing.times, passing.items))
    items, times = passing.items[order], passing.times[order]
    ends = np.flatnonzero((np.diff(items) != 0) | (np.diff(times) > 1.5 * SPACING)) + 1
    yield from np.split(order, ends)
