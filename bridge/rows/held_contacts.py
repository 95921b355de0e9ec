"""Contacts that are found again by another analysis, so that what was changed about them stays.

Frames are the scene's, places in Blender units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import dist, isfinite
from typing import TYPE_CHECKING

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import axis_rotation, planar_turn
from .protocols import ContactRow

if TYPE_CHECKING:
    import bpy

SHARED = 0.5  # of the shorter one's frames, in which the same contact touches both times
NEAR = 0.3  # m; a take that was slid, turned or scaled a little has it so far from where it was
SPREAD = 0.5  # m, of contacts about their middle, from which on they tell how far a take was turned
SLIGHT = 0.01  # m, and rad
SAME_START = 2.0  # frames; the artist's frames stay what they are where it begins as before
UNMOVED = 1e-5  # Blender units


@dataclass(frozen=True)
class HeldContact:
    """What a contact's row holds, to be put into one again. on, empty: objects, or None."""

    name: str
    point: str
    bone: str
    phase: str
    added: bool
    used: bool
    empty: bpy.types.Object | None
    on: bpy.types.Object | None
    found_start: float
    found_end: float
    start_frame: float
    end_frame: float
    found_at: tuple[float, ...]
    at: tuple[float, ...]

    @staticmethod
    def of(row: ContactRow) -> HeldContact:
        """As the row is now; its vectors outlive it. What is no number is as it was found."""
        held = {each.name: getattr(row, each.name) for each in fields(HeldContact)}
        held["found_at"], held["at"] = tuple(row.found_at), tuple(row.at)
        for name, found in (("at", "found_at"), ("start_frame", "found_start")):
            if not np.isfinite(held[name]).all():
                held[name] = held[found]
        if not isfinite(held["end_frame"]):
            held["end_frame"] = held["found_end"]
        return HeldContact(**held)

    @property
    def move(self) -> FloatArray:
        """(3,) by how much it is elsewhere than it was found."""
        return np.subtract(self.at, self.found_at)

    @property
    def moved(self) -> bool:
        return bool(np.abs(self.move).max() > UNMOVED)

    @property
    def changed(self) -> bool:
        """Whether the artist has changed anything about it."""
        retimed = (self.start_frame, self.end_frame) != (self.found_start, self.found_end)
        return self.moved or retimed or not self.used or (self.empty or self.on) is not None


@dataclass(frozen=True)
class Displacement:
    """How a take goes from where it was: turned about the vertical, rad, then shifted, (3,), and so
    many frames later."""

    turn: float = 0.0
    shift: FloatArray | tuple[float, ...] = (0.0, 0.0, 0.0)
    later: float = 0.0

    @staticmethod
    def between(
        rows: Sequence[ContactRow], before: Sequence[HeldContact], metre: float
    ) -> Displacement:
        """In the least-squares sense (planar Kabsch), from contacts before to the rows that they
        are; turned only where these are far enough apart to tell."""
        was = np.array([contact.found_at for contact in before])
        now = np.array([tuple(row.found_at) for row in rows])
        a, b = was - was.mean(axis=0), now - now.mean(axis=0)
        turn = 0.0
        if np.sqrt((a[:, :2] ** 2).sum(axis=1).mean()) > SPREAD * metre:
            told = float(planar_turn(a, b))
            turn = told if abs(told) > SLIGHT else 0.0
        shift = now.mean(axis=0) - axis_rotation(2, turn) @ was.mean(axis=0)
        starts = zip(rows, before, strict=True)
        return Displacement(
            turn, shift, float(np.median([row.found_start - c.found_start for row, c in starts]))
        )

    def slight(self, metre: float) -> bool:
        """Whether it is no more than another analysis may differ."""
        far = bool(np.abs(self.shift).max() > SLIGHT * metre)
        return not (far or self.turn or abs(self.later) >= SAME_START)

    def direction(self, move: FloatArray) -> FloatArray:
        """(3,) a move, turned as the take."""
        return np.asarray(axis_rotation(2, self.turn) @ move)

    def place(self, at: Sequence[float]) -> FloatArray:
        """(3,) where what was at a place is now."""
        return np.asarray(self.direction(np.asarray(at)) + self.shift)

    def contact(self, held: HeldContact) -> HeldContact:
        """One that the artist made, taken along."""
        return replace(
            held,
            found_at=tuple(self.place(held.found_at)),
            at=tuple(self.place(held.at)),
            found_start=held.found_start + self.later,
            found_end=held.found_end + self.later,
            start_frame=held.start_frame + self.later,
            end_frame=held.end_frame + self.later,
        )


@dataclass(frozen=True)
class FoundAgain:
    """What rows were before, by index, and how the take goes from there."""

    contacts: Mapping[int, HeldContact]
    displacement: Displacement


def found_again(
    rows: Sequence[ContactRow], held: Sequence[HeldContact], metre: float
) -> FoundAgain:
    """What the rows of another analysis were before.

    Each is of the same point, near by, and touches in about the same frames. Where something that
    was changed is not found so, all are, if they are of the same points in the same order, rhythm
    and places: then the whole take is elsewhere, or later. metre: in Blender units.
    """
    near = _near(rows, held, metre)
    found = set(map(id, near.values()))
    if not all(id(each) in found for each in held if each.changed):
        near = _as_a_whole(rows, held, metre) or near
    if not near:
        return FoundAgain({}, Displacement())
    some, before = [rows[i] for i in near], list(near.values())
    return FoundAgain(near, Displacement.between(some, before, metre))


def _near(
    rows: Sequence[ContactRow], held: Sequence[HeldContact], metre: float
) -> dict[int, HeldContact]:
    """One by one; of several those that have the most frames in common."""
    pairs = [
        (_common(row, before), before.changed, -i, -k)
        for i, row in enumerate(rows)
        for k, before in enumerate(held)
        if row.point == before.point and dist(row.found_at, before.found_at) < NEAR * metre
        if _shared(row, before) >= SHARED
    ]
    found: dict[int, HeldContact] = {}
    taken: set[int] = set()
    for *_, i, k in sorted(pairs, reverse=True):
        if -i not in found and -k not in taken:
            found[-i] = held[-k]
            taken.add(-k)
    return found


def _as_a_whole(
    rows: Sequence[ContactRow], held: Sequence[HeldContact], metre: float
) -> dict[int, HeldContact]:
    """All of them, or none."""
    if not held or [row.point for row in rows] != [before.point for before in held]:
        return {}
    by = Displacement.between(rows, held, metre)
    alike = all(
        dist(by.place(before.found_at), row.found_at) < NEAR * metre
        and _shared(row, before, by.later) >= SHARED
        for row, before in zip(rows, held, strict=True)
    )
    return dict(enumerate(held)) if alike else {}


def _common(row: ContactRow, before: HeldContact, later: float = 0.0) -> float:
    """Frames in which both touch, if the row's came that later."""
    end = min(row.found_end - later, before.found_end)
    return end - max(row.found_start - later, before.found_start)


def _shared(row: ContactRow, before: HeldContact, later: float = 0.0) -> float:
    """The share of the shorter one's frames in which both touch."""
    spans = (row.found_end - row.found_start, before.found_end - before.found_start)
    return _common(row, before, later) / max(min(spans), 1e-9)


def movers(rows: Sequence[ContactRow], again: Mapping[int, HeldContact]) -> dict[int, HeldContact]:
    """Whose move rows make, by index: their own. A stance that was moved goes as a whole: what is
    new in it goes where what stands nearest does."""
    found = dict(again)
    for i, row in enumerate(rows):
        others = [k for k in again if rows[k].phase == row.phase]
        if i in found or not others or not all(again[k].moved for k in others):
            continue
        found[i] = again[min(others, key=lambda k: dist(rows[k].found_at, row.found_at))]
    return found


def frame_of(found: float, was_found: float, was: float) -> float:
    """The artist's frame of a contact's begin or end that is found at another one now."""
    if was == was_found:
        return found
    return was if abs(found - was_found) < SAME_START else was + found - was_found
