"""The solid world of one adaptation: what goes into what, and the rows that keep it out.

Never tighter than the recording: what the fit has through each other at the same (warped) instant
is allowed, and no more. Of the scene the recording knew only what it stands on. Of other ground as
much is allowed as of its floor, as soles give there likewise, and of obstacles nothing.
"""

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.character import Character
from ..data.contacts import ContactSchedule
from ..data.row_kinds import RowKind
from ..data.scene import CLEARANCE, SceneObject, SceneRole
from ..scene.object_motion import ObjectMotion
from ..scene.triangle_mesh import mesh_of
from ..transcription.constraint import DenseViolation
from ..transcription.guard_rows import GuardRows, chosen
from ..transcription.motion import LastMotion, Motion
from ..transcription.sampling import Channel, ChannelJacobian, State
from .mesh_surface import MeshSurface, scene_shapes
from .passages import Passable, with_ways
from .penetrations import MOST_NEW, SPACING, Penetrations, placed_at
from .shape_changes import AS_IS, ShapeChanges
from .shapes import Capsule, Capsules, capsules, floor_balls, meeting_pairs
from .surfaces import WORLD, Closest, Floor, OwnLimbs, Placed, Surface, Surfaces
from .way_out import WayOut

ROW_SPACING = 0.016  # s, between rows of solids that stay in each other for longer
MOST_ROWS = 600  # at once, which take a program seconds; beyond, rows are further apart
SIDE_REACH = 0.1  # m; how near the fit's solids are to tell on which side they belong

NONE = np.empty(0, dtype=int)
LIMBS = 1  # the first surfaces: those of the body's own limbs

TimeFunction = Callable[[FloatArray], FloatArray]  # of instants (N,) s
Placement = tuple[SceneObject, ObjectMotion]


@dataclass(frozen=True)
class SolidDistance:
    """Distances of the items of penetrations (U,), each at its instant."""

    surface: Surface
    found: Penetrations
    kind: RowKind = RowKind.SOLID

    def some(self, which: BoolArray) -> "SolidDistance":
        """Of some of the items (U,)."""
        return SolidDistance(self.surface, self.found.some(which))

    def value(self, state: State) -> FloatArray:
        """(U, 1) m."""
        return self._closest(state).distance[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        """normal . (J_a - J_b) of the closest points: their sliding along the solids does not
        change the distance to first order."""
        closest, pose = self._closest(state), state.pose
        world = closest.bodies[:, 1] == WORLD
        turn = pose.jacobian_at(closest.bodies[:, 0], closest.at[:, 0])
        turn[~world] -= pose.at(np.flatnonzero(~world)).jacobian_at(
            closest.bodies[~world, 1], closest.at[~world, 1]
        )
        com = closest.normal * world[:, None]
        return [
            ChannelJacobian(
                Channel.ANGLES, 0, np.einsum("ni,nij->nj", closest.normal, turn)[:, None]
            ),
            ChannelJacobian(Channel.COM, 0, com[:, None]),
        ]

    def _closest(self, state: State) -> Closest:
        placed = Placed(state.instants.times, state.pose, state.com())
        each = np.arange(len(placed.times))
        closest = self.surface.closest(placed, each, self.found.items)
        return closest.from_side(self.found.side, placed.pose, each)


@dataclass(frozen=True)
class SolidWorld:
    """Surfaces of a motion, and those of the fit, item by item the same, but that the fit has its
    floor in place of ground, and no obstacles: these come last.

    to_old: the fit's instants (N,) s of the motion's. passables: of the meshes among the surfaces.
    spacing: s, of the instants at which a motion is looked at.
    """

    surfaces: Surfaces
    fitted_surfaces: Surfaces
    fitted: Motion
    to_old: TimeFunction
    passables: tuple[Passable, ...] = ()
    hard: bool = False
    spacing: float = SPACING
    kind: RowKind = RowKind.SOLID

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Of the items."""
        return self.surfaces.names

    def sparse(self) -> "SolidWorld":
        """The same, for which half as many instants are looked at: between them a limb that is
        thrown at 100 m/s² gets in by less than a millimetre more (a dt²/8)."""
        return replace(self, spacing=2.0 * SPACING)

    def limbs_alone(self) -> "SolidWorld":
        """The same for the body's own limbs, which keep out of each other wherever it is."""
        ours, theirs = (
            Surfaces(each.parts[:LIMBS]) for each in (self.surfaces, self.fitted_surfaces)
        )
        return replace(self, surfaces=ours, fitted_surfaces=theirs, passables=())

    def penetrations(self, motion: Motion) -> Penetrations:
        """Where a motion's solids are deeper in each other than the fit's, by MOST_NEW."""
        return self._last.of(motion)

    @cached_property
    def _last(self) -> LastMotion[Penetrations]:
        return LastMotion(self._look)

    def _look(self, motion: Motion) -> Penetrations:
        placed = placed_at(motion, _grid(motion.duration, self.spacing))
        instants, items = self.surfaces.near(placed)
        now = self.surfaces.closest(placed, instants, items)
        deep = now.distance < -MOST_NEW
        instants, items, now = instants[deep], items[deep], now.some(deep)
        lower, side = self._before(placed.times[instants], items)
        over = lower - now.from_side(side, placed.pose, instants).distance
        found = Penetrations(self.names, items, placed.times[instants], over, lower, side)
        return found.some(over > MOST_NEW)

    def _before(self, times: FloatArray, items: IntArray) -> tuple[FloatArray, FloatArray]:
        """What items have in the fit at the motion's instants: distances (N,) m, at most 0, and
        sides (N, 3)."""
        lower, side = np.zeros(len(items)), np.zeros((len(items), 3))
        there = np.flatnonzero(items < len(self.fitted_surfaces.names))
        looked_at, place = np.unique(times[there], return_inverse=True)
        before = placed_at(self.fitted, self.to_old(looked_at))
        was = self.fitted_surfaces.closest(before, place, items[there])
        lower[there] = np.minimum(was.distance, 0.0)
        near = was.distance < SIDE_REACH
        side[there] = was.side(before.pose, place) * near[:, None]
        return lower, side

    def violations(self, motion: Motion) -> list[DenseViolation]:
        """The deepest of each name, deepest first."""
        return self.penetrations(motion).worst()

    def rows(self, motion: Motion, given_up: Set[str]) -> GuardRows | None:
        """A motion's keep-out rows, with more where it penetrates; the same where it does not.

        given_up: names of items that have no rows.
        """
        old = motion.transcription.guard(self.kind)
        found = self.penetrations(motion).but(given_up)
        if not len(found.items):
            return old
        kept = _penetrations(old).but(given_up) if old is not None else found.some(NONE)
        for each in self.passables:
            found, kept = each.directed(found, kept, motion, given_up)
        found = kept.with_more(found.some(_few(found, self.spacing)))
        function = SolidDistance(self.surfaces, found)
        return GuardRows(self.names, found.items, found.times, found.lower, function)


def _few(found: Penetrations, spacing: float) -> IntArray:
    """Indices of those that get rows. Where a body is all in something these are so many that a
    step takes minutes; then they are further apart, and what is left between is found next time."""
    apart = ROW_SPACING
    picked = chosen(found, spacing, apart)
    while len(picked) > MOST_ROWS and apart < found.times.max():
        apart *= 2.0
        picked = chosen(found, spacing, apart)
    return picked


def _penetrations(rows: GuardRows) -> Penetrations:
    assert isinstance(rows.function, SolidDistance)
    return rows.function.found


def _grid(duration: float, spacing: float) -> FloatArray:
    return np.linspace(0.0, duration, 1 + int(np.ceil(duration / spacing)))


# ---------------------------------------------------------------- the body and its floor


def solid_world(
    fitted: Motion,
    reference: Motion,
    floors: tuple[TimeFunction, TimeFunction],
    to_old: TimeFunction,
    scene: Sequence[Placement] = (),
    clears: Mapping[str, Mapping[int, float]] = MappingProxyType({}),
    changes: ShapeChanges = AS_IS,
    known: Set[str] = frozenset(),
) -> SolidWorld:
    """The world of a motion of `reference`'s body. floors: heights, m, of the motion's and the
    fit's. scene: objects and how they move in the motion's time. clears: by object and body, how
    far above it what is over it stays, m. changes: of the shapes of both. known: the objects
    that the recording is on."""
    character = fitted.transcription.character
    pairs = meeting_pairs(character, capsules(character, changes), changes)
    ours, theirs = (
        _surfaces(motion, pairs, floor, changes)
        for motion, floor in zip((reference, fitted), floors, strict=True)
    )
    shapes = scene_shapes(character, reference.transcription.touching, changes)
    grounds, soles, obstacles = list[Surface](), list[Surface](), list[Surface]()
    for thing, moves in scene:
        cleared = clears.get(thing.name, {})
        met = [shape for shape in shapes if shape.body not in cleared]
        surface = _of_object(thing, moves, character, met)
        if thing.role is SceneRole.GROUND:
            grounds.append(surface)
            under = Floor(surface.shapes, floors[1], surface.names)
            soles.append(surface if thing.name in known else under)
        else:
            obstacles.append(surface)
        over = [shape for shape in shapes if shape.body in cleared]
        if over:
            by = np.array([cleared[shape.body] for shape in over])
            called = _names(character, over, CLEARANCE.format(thing.name))
            obstacles.append(WayOut.above(moves, Capsules.of(over), by, called))
    surfaces, passables = with_ways(Surfaces((*ours, *grounds, *obstacles)), character)
    return SolidWorld(surfaces, Surfaces((*theirs, *soles)), fitted, to_old, passables)


def own_overlaps(motion: Motion, floor: TimeFunction, changes: ShapeChanges) -> Penetrations:
    """What a motion's own limbs and its floor have in each other, deeper than MOST_NEW."""
    character = motion.transcription.character
    pairs = meeting_pairs(character, capsules(character, changes), changes)
    own = Surfaces(_surfaces(motion, pairs, floor, changes))
    placed = placed_at(motion, _grid(motion.duration, SPACING))
    instants, items = own.near(placed)
    depth = np.maximum(-own.closest(placed, instants, items).distance, 0.0)
    none, side = np.zeros(len(items)), np.zeros((len(items), 3))
    found = Penetrations(own.names, items, placed.times[instants], depth, none, side)
    return found.some(depth > MOST_NEW)


def _surfaces(
    motion: Motion, pairs: IntArray, floor: TimeFunction, changes: ShapeChanges
) -> tuple[Surface, ...]:
    character = motion.transcription.character
    shapes = capsules(character, changes)
    balls = floor_balls(character, motion.transcription.touching, changes)
    names = [body.name for body in character.bodies]
    both = tuple(
        f"{names[shapes[i].body].capitalize()} in {names[shapes[j].body]}" for i, j in pairs
    )
    under = tuple(f"{names[ball.body].capitalize()} in the floor" for ball in balls)
    limbs = OwnLimbs(Capsules.of(shapes), pairs, both)
    return limbs, Floor(Capsules.of(balls), floor, under)


def _of_object(
    thing: SceneObject, moves: ObjectMotion, character: Character, shapes: Sequence[Capsule]
) -> MeshSurface:
    """The surface of an object. Raises NoFaces."""
    names = _names(character, shapes, thing.name)
    return MeshSurface(mesh_of(thing), moves, Capsules.of(shapes), names)


def _names(character: Character, shapes: Sequence[Capsule], where: str) -> tuple[str, ...]:
    return tuple(f"{character.bodies[s.body].name.capitalize()} in {where}" for s in shapes)


def floor_heights(schedule: ContactSchedule, places: FloatArray) -> TimeFunction:
    """The floor's height, m, at instants (N,) s: where it was found, or lower where a phase's
    contacts are lower, as a landing that is pinned below it makes its own floor.

    places: (n_contacts, 3) m. In flight the lower of the floors before and after counts.
    """
    by_name = {c.name: z for c, z in zip(schedule.contacts, places[:, 2], strict=True)}
    phases = schedule.phases
    own = np.array(
        [
            min([schedule.floor_m, *(by_name[c.name] for c in schedule.of_phase(phase))])
            for phase in phases
        ]
    )
    flying = np.array([not schedule.of_phase(phase) for phase in phases])
    around = np.minimum(np.append(own[1:], own[-1]), np.append(own[0], own[:-1]))
    heights = np.where(flying, around, own)
    ends = np.array([phase.end for phase in phases])[:-1]
    return lambda times: heights[np.searchsorted(ends, times)]
