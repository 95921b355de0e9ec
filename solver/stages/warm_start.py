"""Warm start: each stance moves rigidly with its contacts, flights blend (thesis 6.4).

That is the thesis's rotating and splicing of stages for the full twists, without the seams. Where
the ground moves, a stance's move goes on with it; a flight begins with the move at its take-off and
ends with that at its landing, which in between is a steady speed on top. Large edits are made by
continuation, in several steps.
"""

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..contacts.footfalls import footfalls
from ..data.contacts import ContactSchedule, Interval, gaps
from ..numerics.rotations import axis_rotation, planar_turn
from ..numerics.splines import dense_instants, greville_abscissae
from ..transcription.motion import Motion
from ..transcription.ride import Ride
from ..transcription.transcription import Transcription

MAX_SHIFT_PER_STEP = 0.5  # m, of a continuation step
MAX_SPEED_PER_STEP = 1.5  # m/s, by which a landing or a stance changes speed
MAX_TURN_PER_STEP = np.radians(45.0)
LOWEST_SAMPLES = 50  # of a contact's height on moving ground
TOGETHER = 0.05  # s, within which both feet leave, or come down
UNEQUAL = 0.02  # m, by which a rigid move of all that stands may miss; toes bend, ground is uneven
UNEQUAL_TURN = np.radians(1.0)  # of a foot to that move's, likewise; on, a way goes off by as much
RIDE_RATE = 60.0  # Hz, at which the move of a stance on moving ground is sampled
MOVED = 1e-3  # m; a contact that goes less far stays where it was
MOSTLY = 0.5  # of a stance; where something unseen carries for less, the body goes on its feet


@dataclass(frozen=True)
class Standing:
    """Where contacts stand: places (n_contacts, 3) m, and the rides that begin there."""

    places: FloatArray
    rides: tuple[Ride | None, ...]

    @staticmethod
    def still(places: FloatArray) -> "Standing":
        """On ground that does not move."""
        return Standing(places, (None,) * len(places))

    @staticmethod
    def of(motion: Motion) -> "Standing":
        return Standing(motion.places, tuple(c.ride for c in motion.transcription.contacts))

    @property
    def moves(self) -> bool:
        return any(ride is not None for ride in self.rides)

    @property
    def share(self) -> float:
        """The share of its speed at which the ground moves: 0 where it stands still."""
        return max((ride.share for ride in self.rides if ride is not None), default=0.0)

    def at(self, contact: int, times: FloatArray) -> FloatArray:
        """(T, 3) m, where a contact stands, or would, at instants (T,) s."""
        ride, place = self.rides[contact], self.places[contact]
        return np.tile(place, (len(times), 1)) if ride is None else ride.poses(times).of(place)

    def lowest(self, schedule: ContactSchedule) -> FloatArray:
        """(n_contacts, 3) m, of each contact where its ground is the lowest while it stands."""
        places = self.places.copy()
        for i, contact in enumerate(schedule.contacts):
            if self.rides[i] is not None:
                at = self.at(i, np.linspace(contact.start, contact.end, LOWEST_SAMPLES))
                places[i] = at[at[:, 2].argmin()]
        return places

    def with_places(self, places: FloatArray) -> "Standing":
        return Standing(places, self.rides)

    def slowed(self, share: float, recorded: "Standing") -> "Standing":
        """On ground that moves at a share of its speed, but for what was recorded on it."""
        rides = tuple(
            ride if ride is None or ride == old else ride.slowed(share)
            for ride, old in zip(self.rides, recorded.rides, strict=True)
        )
        return Standing(self.places, rides)


@dataclass(frozen=True)
class RigidMove:
    """Rigid move of a stance at instants (T,) s from its start to its end; one where it stays.

    turns: (T,) rad, about the vertical through pivots (T, 3) m. shifts: (T, 3) m, world.
    """

    start: float
    end: float
    times: FloatArray
    pivots: FloatArray
    turns: FloatArray
    shifts: FloatArray

    def of(self, points: FloatArray, times: FloatArray) -> FloatArray:
        """Points (N, 3) m moved at instants (N,) s, before the start and after the end as there."""
        pivots, shifts = self._at(self.pivots, times), self._at(self.shifts, times)
        turned = np.einsum("nij,nj->ni", axis_rotation(2, self.turn(times)), points - pivots)
        return np.asarray(turned + pivots + shifts)

    def turn(self, times: FloatArray) -> FloatArray:
        """(N,) rad at instants (N,) s."""
        return np.interp(times, self.times, self.turns)

    def _at(self, values: FloatArray, times: FloatArray) -> FloatArray:
        return np.stack([np.interp(times, self.times, each) for each in values.T], axis=1)

    @property
    def shift(self) -> FloatArray:
        """(3,) m, at the start."""
        return np.asarray(self.shifts[0])

    @property
    def velocities(self) -> FloatArray:
        """(2, 3) m/s of the shift, at the start and at the end."""
        if len(self.times) == 1:
            return np.zeros((2, 3))
        return np.asarray(np.gradient(self.shifts, self.times, axis=0)[[0, -1]])

    def share(self, share: float) -> "RigidMove":
        """A share of the move at the start, for all of the time."""
        return _still(self, self.pivots[0], share * self.turns[0], share * self.shift)

    @property
    def back(self) -> "RigidMove":
        """The inverse of the move at the start, for all of the time."""
        return _still(self, self.pivots[0] + self.shift, -self.turns[0], -self.shift)

    @property
    def straight(self) -> "RigidMove":
        """The move at the start without its turn, for all of the time."""
        return _still(self, self.pivots[0], 0.0, self.shift)


def _still(move: RigidMove, pivot: FloatArray, turn: float, shift: FloatArray) -> RigidMove:
    once = np.array([move.start])
    return RigidMove(move.start, move.end, once, pivot[None], np.array([turn]), shift[None])


def stance_moves(
    schedule: ContactSchedule,
    before: Standing,
    after: Standing,
    wanted: Mapping[str, float] | None = None,
    seats: Collection[Interval] = (),
) -> tuple[RigidMove, ...]:
    """Least-squares rigid move (planar Kabsch) of each stance's contacts.

    Grips and other contacts that were asked for move nothing: the arms reach for them (arm_ik.py).
    wanted: turns of contacts, by names, rad. Places alone cannot tell a half turn left from one
    right, nor a whole turn from none; without a wish a stance is turned as the one before it ended.
    Of a single point they tell no turn at all: it is the one that is wished. seats: the stances in
    which the body stays, and reaches for where its feet are moved to.
    """
    moves: list[RigidMove] = []
    turned = 0.0
    for stance in stances(schedule):
        mine = standing_in(schedule, stance)
        times = np.array([stance.start])
        if any(standing.rides[i] is not None for standing in (before, after) for i in mine):
            count = 2 + int(RIDE_RATE * (stance.end - stance.start))
            times = np.linspace(stance.start, stance.end, count)
        turns = ((wanted or {}).get(schedule.contacts[i].name, 0.0) for i in mine)
        wish = max(turns, key=abs)
        asked = turned + wish
        standings = (before, before) if stance in seats else (before, after)
        move = rigid_move(stance, times, mine, standings, asked)
        if len(mine) == 1 and wish:
            move = replace(move, turns=move.turns + asked - move.turns[0])
        turned += float(move.turns[-1] - move.turns[0])
        moves.append(move)
    return tuple(moves)


def stances(schedule: ContactSchedule) -> tuple[Interval, ...]:
    """Intervals, s, in which contacts that were found stand; between them the body flies, hangs
    where it was asked to, or something unseen carries it from one stance to the next."""
    found = ((c.start, c.end) for c in schedule.contacts if not c.asked_for)
    between = ((each.start, each.end) for each in gaps(found, schedule.duration))
    return gaps(between, schedule.duration)


def standing_in(schedule: ContactSchedule, stance: Interval) -> list[int]:
    """Indices of the contacts that were found and touch in a stance."""
    return [
        i
        for i, c in enumerate(schedule.contacts)
        if c.start < stance.end and c.end > stance.start and not c.asked_for
    ]


def end_move(
    schedule: ContactSchedule, before: Standing, after: Standing, last: RigidMove
) -> RigidMove:
    """The move of what stands where the last of `stance_moves` ends: a foot that stepped on within
    the stance may have been moved otherwise. A single point tells no turn, so the stance's counts.

    Where feet that stand there were moved unequally no rigid move has all of them stay. It is that
    of the foot which came down last, for it stands on for the longest, and of feet that came down
    together of the one that was moved least; turned as far as the foot that was turned least.
    """
    inside = [i for i, c in enumerate(schedule.contacts) if c.end > last.start and not c.asked_for]
    latest = max(schedule.contacts[i].end for i in inside)
    mine = [i for i in inside if schedule.contacts[i].end > latest - TOGETHER]
    end, turn = last.times[-1:], float(last.turns[-1])

    def moved(contacts: Sequence[int]) -> RigidMove:
        return rigid_move(last, end, contacts, (before, after), turn)

    move = moved(mine)
    if len(mine) == 1:
        return replace(move, turns=np.array([turn]))
    steps = footfalls([schedule.contacts[i].touch for i in inside])
    every = [[inside[k] for k in step] for step in steps]
    feet = [foot for foot in every if set(foot) & set(mine)]
    turns = [float(moved(foot).turns[0]) for foot in feet if len(foot) > 1]
    old, new = (np.concatenate([each.at(i, end) for i in mine]) for each in (before, after))
    off = np.linalg.norm(move.of(old, np.repeat(end, len(mine))) - new, axis=1).max()
    if off < UNEQUAL and all(abs(each - move.turns[0]) < UNEQUAL_TURN for each in turns):
        return move
    lasting = [moved([i for i in foot if i in mine]) for foot in _last_down(schedule, feet)]
    staying = min(lasting, key=lambda each: float(np.linalg.norm(each.shifts[0])))
    return replace(staying, turns=np.array([min(turns, key=abs, default=turn)]))


def _last_down(schedule: ContactSchedule, feet: Sequence[list[int]]) -> list[list[int]]:
    """Of feet, each with its contacts, those that came down last, together."""
    landed = [min(schedule.contacts[i].start for i in foot) for foot in feet]
    return [f for f, at in zip(feet, landed, strict=True) if at > max(landed) - TOGETHER]


def rigid_move(
    stance: "Interval | RigidMove",
    times: FloatArray,
    contacts: Sequence[int],
    standings: tuple[Standing, Standing],
    asked: float,
) -> RigidMove:
    """The least-squares rigid move of contacts at instants (T,) s of a stance.

    standings: before and after. asked: rad, the turn at the start, to a whole turn.
    """
    old, new = (np.stack([each.at(i, times) for i in contacts], axis=1) for each in standings)
    pivots, to = old.mean(axis=1), new.mean(axis=1)
    a, b = old - pivots[:, None], new - to[:, None]
    turns = np.unwrap(planar_turn(a, b))
    turns += 2 * np.pi * np.round((asked - turns[0]) / (2 * np.pi))
    return RigidMove(stance.start, stance.end, times, pivots, turns, to - pivots)


def seats(schedule: ContactSchedule, before: Standing, after: Standing) -> tuple[Interval, ...]:
    """The stances of `stance_moves` in which what carries the body unseen stays where it was: some
    contacts are moved and others are not, or otherwise, as by who sits. Where all that stands is
    moved as one, what carries unseen goes with it.
    """
    found = []
    for stance in stances(schedule):
        mine = standing_in(schedule, stance)
        rides = any(each.rides[i] is not None for each in (before, after) for i in mine)
        carried = sum(_shared(stance, each) for each in schedule.unseen)
        if rides or carried < MOSTLY * (stance.end - stance.start):
            continue
        old, new = before.places[mine], after.places[mine]
        away = np.linalg.norm(new - old, axis=1)
        start = np.array([stance.start])
        move = rigid_move(stance, start, mine, (before, after), 0.0)
        off = np.linalg.norm(move.of(old, np.repeat(start, len(mine))) - new, axis=1)
        if away.max() > MOVED and (away.min() <= MOVED or off.max() > UNEQUAL):
            found.append(stance)
    return tuple(found)


def resting(
    schedule: ContactSchedule, seated: Collection[Interval], times: FloatArray
) -> BoolArray:
    """(T,) whether at instants (T,) s something unseen carries in one of the `seats`."""
    return _within(schedule.unseen, times) & _within(seated, times)


def _within(intervals: Collection[Interval], times: FloatArray) -> BoolArray:
    within = [(times >= each.start) & (times <= each.end) for each in intervals]
    return np.asarray(np.any(np.reshape(within, (-1, len(times))), axis=0))


def _shared(one: Interval, other: Interval) -> float:
    return max(0.0, min(one.end, other.end) - max(one.start, other.start))


def warm_start(motion: Motion, moves: tuple[RigidMove, ...]) -> FloatArray:
    """Unknowns (K, n_block) of a motion whose stances make these moves, blended in between."""
    t, x = motion.transcription, motion.x.copy()
    if not moves:
        return x
    layout, basis = t.layout, t.basis
    at = greville_abscissae(basis)
    com, _ = _blend(moves, at, x[:, layout.com])
    x[:, layout.com] = com
    if any(np.abs(move.turns).max() > 1e-6 for move in moves):
        _turn_root(t, x, moves)
        _turn_forces(t, x, moves)
    return x


def _blend(
    moves: tuple[RigidMove, ...], times: FloatArray, points: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Blended moves at instants (T,) s: points (T, 3) moved, and turns (T,) rad."""
    middles = [edge for move in moves for edge in (move.start, move.end)]
    position = np.interp(times, middles, np.repeat(np.arange(len(moves)), 2))
    low = np.floor(position).astype(int)
    high = np.minimum(low + 1, len(moves) - 1)
    share = position - low
    moved = np.stack([move.of(points, times) for move in moves])
    turns = np.stack([move.turn(times) for move in moves])
    each = np.arange(len(times))
    place = (1 - share)[:, None] * moved[low, each] + share[:, None] * moved[high, each]
    return place, (1 - share) * turns[low, each] + share * turns[high, each]


def _turn_root(t: Transcription, x: FloatArray, moves: tuple[RigidMove, ...]) -> None:
    """Turns the root about the vertical, in place, keeping its angles continuous."""
    joint = t.character.joints[0]
    root = t.layout.root_angles
    times = dense_instants(t.basis)
    was = t.basis.combine(x[:, root], times)
    turns = _blend(moves, times, np.zeros((len(times), 3)))[1]
    turned = axis_rotation(2, turns) @ joint.axes.rotation(was)
    angles = joint.axes.angles(turned)
    whole = 2 * np.pi * np.round((was[0] - angles[0]) / (2 * np.pi))
    matrix = t.basis.matrix(times)
    x[:, root] = np.linalg.lstsq(matrix, angles + whole, rcond=None)[0]


def _turn_forces(t: Transcription, x: FloatArray, moves: tuple[RigidMove, ...]) -> None:
    turns = _blend(moves, greville_abscissae(t.basis), np.zeros((len(x), 3)))[1]
    forces = x[:, t.layout.forces].reshape(len(x), t.layout.n_points, 3)
    turned = np.einsum("kij,kpj->kpi", axis_rotation(2, turns), forces)
    x[:, t.layout.forces] = turned.reshape(len(x), -1)


def continuation_steps(moves: tuple[RigidMove, ...]) -> int:
    """Number of continuation steps in which moves relative to each other are made.

    What a take-off's own speed does to the landing after it costs none.
    """
    parts = [1.0]
    for a, b in itertools.pairwise(moves):
        flown = b.start - a.end
        gap = b.shifts[0] - a.shifts[-1] - flown * a.velocities[1]
        braked = b.velocities[0] - a.velocities[1]
        parts += [
            float(np.linalg.norm(gap)) / MAX_SHIFT_PER_STEP,
            abs(b.turns[0] - a.turns[-1]) / MAX_TURN_PER_STEP,
            float(np.linalg.norm(braked)) / MAX_SPEED_PER_STEP,
        ]
    for move in moves:
        gained = np.linalg.norm(move.velocities[1] - move.velocities[0])
        parts.append(float(gained) / MAX_SPEED_PER_STEP)
    return int(np.ceil(max(parts) - 1e-6))


def partial_places(
    schedule: ContactSchedule,
    before: FloatArray,
    after: FloatArray,
    moves: tuple[RigidMove, ...],
    share: float,
) -> FloatArray:
    """Places (n_contacts, 3) m after a share of each stance's whole move from before to after."""
    places = before + share * (after - before)
    for move in moves:
        part, back = move.share(share), move.back
        at = np.array([move.start])
        for i, contact in enumerate(schedule.contacts):
            together = contact.start < move.end and contact.end > move.start
            if together and not contact.asked_for:
                # What the move leaves over (feet that part) comes in by the same share.
                rest = back.of(after[i : i + 1], at) - before[i]
                places[i] = part.of(before[i : i + 1] + share * rest, at)[0]
    return places
