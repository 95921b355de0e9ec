"""Contacts that are found again by another analysis, so that what was changed about them stays.

Frames are the scene's, places in Blender units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from math import dist
from typing import TYPE_CHECKING

from .protocols import ContactRow

if TYPE_CHECKING:
    import bpy

SHARED = 0.5  # of the shorter one's frames, in which the same contact touches both times
NEAR = 0.3  # m; a take that was slid, turned or scaled a little has it so far from where it was
SAME_START = 2.0  # frames; the artist's frames stay what they are where it begins as before
UNMOVED = 1e-5  # Blender units

Move = tuple[float, ...]


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
        """As the row is now; its vectors outlive it."""
        held = {each.name: getattr(row, each.name) for each in fields(HeldContact)}
        return HeldContact(**{**held, "found_at": tuple(row.found_at), "at": tuple(row.at)})

    @property
    def move(self) -> Move:
        """By how much it is elsewhere than it was found."""
        return tuple(now - was for now, was in zip(self.at, self.found_at, strict=True))

    @property
    def moved(self) -> bool:
        return max(map(abs, self.move)) > UNMOVED

    @property
    def changed(self) -> bool:
        """Whether the artist has changed anything about it."""
        retimed = (self.start_frame, self.end_frame) != (self.found_start, self.found_end)
        return self.moved or retimed or not self.used or (self.empty or self.on) is not None


def found_again(
    rows: Sequence[ContactRow], held: Sequence[HeldContact], metre: float
) -> dict[int, HeldContact]:
    """What rows of another analysis were before, by index.

    All are, where they are of the same points in the same order and rhythm: then the whole take is
    elsewhere, or later. Else each is of the same point, near by, and touches in about the same
    frames. metre: in Blender units.
    """
    if held and [row.point for row in rows] == [before.point for before in held]:
        later = rows[0].found_start - held[0].found_start
        pairs = zip(rows, held, strict=True)
        if all(_shared(row, before, later) >= SHARED for row, before in pairs):
            return dict(enumerate(held))
    shares = [
        (shared, i, k)
        for i, row in enumerate(rows)
        for k, before in enumerate(held)
        if row.point == before.point and dist(row.found_at, before.found_at) < NEAR * metre
        if (shared := _shared(row, before)) >= SHARED
    ]
    again: dict[int, HeldContact] = {}
    taken: set[int] = set()
    for _, i, k in sorted(shares, reverse=True):
        if i not in again and k not in taken:
            again[i] = held[k]
            taken.add(k)
    return again


def _shared(row: ContactRow, before: HeldContact, later: float = 0.0) -> float:
    """The share of the shorter one's frames in which both touch, if the row's came that later."""
    start, end = row.found_start - later, row.found_end - later
    both = min(end, before.found_end) - max(start, before.found_start)
    return both / max(min(end - start, before.found_end - before.found_start), 1e-9)


def moves(rows: Sequence[ContactRow], again: dict[int, HeldContact]) -> dict[int, Move]:
    """By how much rows are moved, by index. A stance that was moved goes as a whole: what is new in
    it makes the move of what stands nearest."""
    found = {i: before.move for i, before in again.items()}
    for i, row in enumerate(rows):
        others = [k for k in again if rows[k].phase == row.phase]
        if i in found or not others or not all(again[k].moved for k in others):
            continue
        nearest = min(others, key=lambda k: dist(rows[k].found_at, row.found_at))
        found[i] = again[nearest].move
    return found


def frame_of(found: float, was_found: float, was: float) -> float:
    """The artist's frame of a contact's begin or end that is found at another one now."""
    if was == was_found:
        return found
    return was if abs(found - was_found) < SAME_START else was + found - was_found
