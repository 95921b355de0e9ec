"""Signed distances that may not become negative: of limbs from each other, and from a floor.

A surface knows its *items*, each one distance: `near` finds those worth a look at, `closest` gives
them with what their Jacobian needs. Meshes are in mesh_surface.py, ways out of them in way_out.py.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.kinematics import Pose
from ..scene.object_motion import ObjectMotion
from .bounds import ManyBounds, ObjectBounds
from .segments import closest_shares
from .shapes import Capsules

WORLD = -1  # in place of a body
CROSSED = 0.5  # of the radii: how far axes that crossed may be apart for the way back to be shorter
OPPOSITE = 0.5  # the cosine beyond which a side is another one
TOUCHING = 1e-4  # m between two axes, below which their separation points nowhere
_NONE = np.empty(0, dtype=int)


@dataclass(frozen=True)
class Placed:
    """Poses at instants (N,) s, and centres of mass (N, 3) m, world."""

    times: FloatArray
    pose: Pose
    com: FloatArray

    def at(self, instants: IntArray) -> "Placed":
        """At some of the instants."""
        return Placed(self.times[instants], self.pose.at(instants), self.com[instants])

    @property
    def joints(self) -> FloatArray:
        """(2, N, 3) m, world: least and greatest of the joints' centres at each instant."""
        centres = self.pose.centres
        return np.asarray([centres.min(axis=1) + self.com, centres.max(axis=1) + self.com])


def axes_in(
    motion: ObjectMotion, shapes: Capsules, placed: Placed, instants: IntArray, items: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Ends (N, 3) m of shapes' axes in the own axes of an object that moves."""
    places, turns = motion.at(placed.times)
    from_object = (placed.com - places)[instants]
    start, end = (
        np.einsum("nji,nj->ni", turns[instants], each + from_object)
        for each in shapes.some_ends(placed.pose, instants, items)
    )
    return start, end


@dataclass(frozen=True)
class Closest:
    """N signed distances, m: negative where one solid is in the other.

    normal: (N, 3) unit, from the second to the first. bodies: (N, 2), WORLD where the second is no
    body. at: (N, 2, 3) m from the centre of mass, their closest points, on axes, not on skins.
    apart: (N,) m between axes that may cross, infinite where there are none.
    """

    distance: FloatArray
    normal: FloatArray
    bodies: IntArray
    at: FloatArray
    apart: FloatArray

    def some(self, which: IntArray | BoolArray) -> "Closest":
        """Of some of the items."""
        return Closest(
            self.distance[which],
            self.normal[which],
            self.bodies[which],
            self.at[which],
            self.apart[which],
        )

    def side(self, pose: Pose, instants: IntArray) -> FloatArray:
        """(N, 3) the normals in the second bodies' frames: on which side the first one is."""
        turns = pose.rotations[instants, self.bodies[:, 1]]
        return np.asarray(np.einsum("nji,nj->ni", turns, self.normal))

    def from_side(self, side: FloatArray, pose: Pose, instants: IntArray) -> "Closest":
        """The same seen from the side (N, 3) on which the first ones belong; zero, if any.

        Where axes have crossed, the distance goes on below minus the radii: so depth stays signed,
        and the way out stays the one back, as long as that is the shorter.
        """
        reach = self.apart - self.distance
        crossed = self.apart < CROSSED * reach
        crossed &= np.einsum("ni,ni->n", self.side(pose, instants), side) < -OPPOSITE
        way = np.where(crossed, -1.0, 1.0)
        distance = np.where(crossed, -self.apart - reach, self.distance)
        return replace(self, distance=distance, normal=way[:, None] * self.normal)


class Surface(Protocol):
    """What solids are kept out of. Its items are counted from 0, each with a name."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of the items, such as "Left hand in right thigh"."""

    @property
    def bounds(self) -> ObjectBounds | None:
        """Beyond which nothing is near; None where that cannot be told."""

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Instants (M,) and items (M,) whose distance may be negative."""

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """The distances of items (N,) at instants (N,), indices."""


@dataclass(frozen=True)
class OwnLimbs:
    """Pairs (P, 2) of a body's capsules."""

    shapes: Capsules
    pairs: IntArray
    names: tuple[str, ...]
    bounds: ClassVar[None] = None

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Exactly those that are in each other."""
        start, end = self.shapes.ends(placed.pose)
        along = end - start
        instants, items = self._meeting_spheres(start + 0.5 * along)
        pairs = self.pairs[items]
        (p, q), (u, v) = ([each[instants, pairs[:, k]] for k in (0, 1)] for each in (start, along))
        s, t = closest_shares(p, u, q, v)
        gap = p + s[:, None] * u - q - t[:, None] * v
        meet = np.einsum("mi,mi->m", gap, gap) < self.shapes.radius[pairs].sum(axis=1) ** 2
        return instants[meet], items[meet]

    def _meeting_spheres(self, middle: FloatArray) -> tuple[IntArray, IntArray]:
        """Instants (M,) and items (M,) of capsules whose spheres about their middles (N, C, 3) m
        meet."""
        # (N, C, C), of all with all: to gather the pairs would take longer.
        apart = middle @ np.swapaxes(-2.0 * middle, 1, 2)
        square = (middle**2).sum(axis=2)
        apart += square[:, :, None]
        apart += square[:, None]
        instants, first, second = np.nonzero(apart < self._reach)
        return instants, self._item[first, second]

    @cached_property
    def _reach(self) -> FloatArray:
        """(C, C) m², within which the spheres of a pair meet; nothing for what is no pair."""
        half = 0.5 * np.linalg.norm(self.shapes.end - self.shapes.start, axis=1)
        reach = np.full(self._item.shape, -np.inf)
        first, second = self.pairs.T
        reach[first, second] = (half + self.shapes.radius)[self.pairs].sum(axis=1) ** 2
        return reach

    @cached_property
    def _item(self) -> IntArray:
        """(C, C) items of the pairs."""
        count = len(self.shapes.radius)
        item = np.zeros((count, count), dtype=int)
        first, second = self.pairs.T
        item[first, second] = np.arange(len(self.pairs))
        return item

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """Between the closest points of the axes, less the radii."""
        pairs = self.pairs[items]
        at = instants[:, None], self.shapes.bodies[pairs]
        turns, centres = placed.pose.rotations[at], placed.pose.centres[at]
        start, end = (
            centres + np.einsum("nsij,nsj->nsi", turns, local[pairs])
            for local in (self.shapes.start, self.shapes.end)
        )
        along = end - start
        shares = np.stack(
            closest_shares(start[:, 0], along[:, 0], start[:, 1], along[:, 1]), axis=1
        )
        points = start + shares[..., None] * along
        gap = points[:, 0] - points[:, 1]
        apart = np.linalg.norm(gap, axis=1)
        across = _directions(np.cross(along[:, 0], along[:, 1]))
        normal = np.where((apart > TOUCHING)[:, None], _directions(gap), across)
        radii = self.shapes.radius[pairs].sum(axis=1)
        inside = ((shares > 0.0) & (shares < 1.0)).all(axis=1)
        axes = np.where(inside, apart, np.inf)
        return Closest(apart - radii, normal, at[1], points, axes)


@dataclass(frozen=True)
class Floor:
    """A level floor under balls (a capsule's ends); height: m, world, at instants (N,) s."""

    balls: Capsules
    height: Callable[[FloatArray], FloatArray]
    names: tuple[str, ...]
    bounds: ClassVar[None] = None

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Exactly those below."""
        centre, _ = self.balls.ends(placed.pose)
        above = centre[..., 2] + (placed.com[:, 2] - self.height(placed.times))[:, None]
        instants, items = np.nonzero(above < self.balls.radius)
        return instants, items

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """Heights of the balls' lowest points above the floor."""
        bodies = self.balls.bodies[items]
        turns, centres = (
            placed.pose.rotations[instants, bodies],
            placed.pose.centres[instants, bodies],
        )
        at = centres + np.einsum("nij,nj->ni", turns, self.balls.start[items])
        level = placed.com[:, 2] - self.height(placed.times)
        above = at[:, 2] + level[instants] - self.balls.radius[items]
        up = np.tile([0.0, 0.0, 1.0], (len(items), 1))
        both = np.stack([bodies, np.full(len(items), WORLD)], axis=1)
        return Closest(above, up, both, np.stack([at, at], axis=1), np.full(len(items), np.inf))


@dataclass(frozen=True)
class Surfaces:
    """Several surfaces as one: items are counted on from each to the next."""

    parts: tuple[Surface, ...]
    bounds: ClassVar[None] = None

    @cached_property
    def names(self) -> tuple[str, ...]:
        return tuple(name for part in self.parts for name in part.names)

    @cached_property
    def _first(self) -> IntArray:
        """(P,) the parts' first items."""
        counts = [len(part.names) for part in self.parts]
        return np.cumsum([0, *counts[:-1]])

    @cached_property
    def _bounds(self) -> dict[int, ObjectBounds]:
        """Of the parts that have any, by index."""
        return {k: p.bounds for k, p in enumerate(self.parts) if p.bounds is not None}

    @cached_property
    def _many(self) -> ManyBounds:
        return ManyBounds(tuple(self._bounds.values()))

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Of every part, which is asked about the instants at which it is not far."""
        instants, items = [_NONE], [_NONE]
        met = self._many.met(placed.times, placed.joints)
        at = {k: np.flatnonzero(row) for k, row in zip(self._bounds, met, strict=True)}
        for k, part in enumerate(self.parts):
            if k not in at:
                when, which = part.near(placed)
            elif len(at[k]):
                when, which = part.near(placed.at(at[k]))
                when = at[k][when]
            else:
                continue
            instants.append(when)
            items.append(which + self._first[k])
        return np.concatenate(instants), np.concatenate(items)

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """Each item by its own part."""
        n = len(items)
        distance, apart, normal = np.empty(n), np.empty(n), np.empty((n, 3))
        bodies, at = np.empty((n, 2), dtype=int), np.empty((n, 2, 3))
        owner = np.searchsorted(self._first, items, side="right") - 1
        for k in np.unique(owner).tolist():
            mine = np.flatnonzero(owner == k)
            found = self.parts[k].closest(placed, instants[mine], items[mine] - self._first[k])
            distance[mine], normal[mine], bodies[mine] = found.distance, found.normal, found.bodies
            at[mine], apart[mine] = found.at, found.apart
        return Closest(distance, normal, bodies, at, apart)


def _directions(vectors: FloatArray) -> FloatArray:
    """(N, 3) unit vectors; zero where there is no direction."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-12))
