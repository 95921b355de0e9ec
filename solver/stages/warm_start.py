"""Warm start: each stance moves rigidly with its contacts, flights blend (thesis 6.4).

That is the thesis's rotating and splicing of stages for the full twists, without the seams. Large
edits are made by continuation, in several steps.
"""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, PhaseKind
from ..numerics.rotations import axis_rotation
from ..transcription.motion import Motion
from ..transcription.transcription import Transcription
from .fit import dense_instants, greville_abscissae

MAX_SHIFT_PER_STEP = 0.5  # m, of a continuation step
MAX_TURN_PER_STEP = np.radians(45.0)


@dataclass(frozen=True)
class RigidMove:
    """Rigid move of a stance that lasts from start to end, s.

    turn: rad, about the vertical through pivot (3,) m. shift: (3,) m, world.
    """

    start: float
    end: float
    pivot: FloatArray
    turn: float
    shift: FloatArray

    def of(self, points: FloatArray) -> FloatArray:
        """Points (T, 3) m moved."""
        return np.asarray(
            (points - self.pivot) @ axis_rotation(2, self.turn).T + self.pivot + self.shift
        )


def stance_moves(
    schedule: ContactSchedule,
    before: FloatArray,
    after: FloatArray,
    wanted: Mapping[str, float] | None = None,
) -> tuple[RigidMove, ...]:
    """Least-squares rigid move (planar Kabsch) of each ground phase's contacts.

    before, after: (n_contacts, 3) m. Grips and other contacts that were asked for move nothing: the
    arms reach for them (arm_ik.py). wanted: turns by phase, rad. Places alone cannot tell a half
    turn left from one right, nor a whole turn from none.
    """
    moves = []
    for phase in schedule.phases:
        if phase.kind is not PhaseKind.GROUND:
            continue
        mine = [
            i
            for i, c in enumerate(schedule.contacts)
            if c.start < phase.end and c.end > phase.start and not c.asked_for
        ]
        if not mine:
            continue
        old, new = before[mine], after[mine]
        pivot, to = old.mean(axis=0), new.mean(axis=0)
        a, b = old - pivot, new - to
        turn = np.arctan2(
            (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(),
            (a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]).sum(),
        )
        asked = (wanted or {}).get(phase.name, 0.0)
        turn += 2 * np.pi * np.round((asked - turn) / (2 * np.pi))
        moves.append(RigidMove(phase.start, phase.end, pivot, float(turn), to - pivot))
    return tuple(moves)


def warm_start(motion: Motion, moves: tuple[RigidMove, ...]) -> FloatArray:
    """Unknowns (K, n_block) of a motion whose stances make these moves, blended in between."""
    t, x = motion.transcription, motion.x.copy()
    if not moves:
        return x
    layout, basis = t.layout, t.basis
    at = greville_abscissae(basis)
    com, _ = _blend(moves, at, x[:, layout.com])
    x[:, layout.com] = com
    if any(abs(move.turn) > 1e-6 for move in moves):
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
    moved = np.stack([move.of(points) for move in moves])
    turns = np.array([move.turn for move in moves])
    each = np.arange(len(times))
    place = (1 - share)[:, None] * moved[low, each] + share[:, None] * moved[high, each]
    return place, (1 - share) * turns[low] + share * turns[high]


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
    """Number of continuation steps in which moves relative to each other are made."""
    relative = [b.shift - a.shift for a, b in itertools.pairwise(moves)]
    turns = [b.turn - a.turn for a, b in itertools.pairwise(moves)]
    furthest = max((float(np.linalg.norm(shift)) for shift in relative), default=0.0)
    largest = max((abs(turn) for turn in turns), default=0.0)
    parts = np.array([furthest / MAX_SHIFT_PER_STEP, largest / MAX_TURN_PER_STEP])
    return max(1, int(np.ceil(parts.max() - 1e-6)))


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
        part = RigidMove(move.start, move.end, move.pivot, share * move.turn, share * move.shift)
        back = RigidMove(move.start, move.end, move.pivot + move.shift, -move.turn, -move.shift)
        for i, contact in enumerate(schedule.contacts):
            if contact.start < move.end and contact.end > move.start:
                # What the move leaves over (feet that part) comes in by the same share.
                rest = back.of(after[i : i + 1]) - before[i]
                places[i] = part.of(before[i : i + 1] + share * rest)[0]
    return places
