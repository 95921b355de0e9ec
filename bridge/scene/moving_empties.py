"""Contacts that are placed by empties which move in time: where those are as the stance begins.

All of a stance is placed as of its first frame, so that a foot's contacts keep their distances, and
whatever frame is shown tells the same. There the contact stays, unless it stands on what moves: an
empty has no surface to ride on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from ..movable import may_move
from ..properties.settings import HangtimeSettings
from ..properties.stances import follow_moving, may_mark, stance_frames
from ..rows.phases import listed
from ..rows.protocols import ContactRow
from .seen import Showing, seen_at, simulate

INSTANTS = 9  # of a stance, at which its empties are looked at
FELT = 0.01  # m; a foot that is off by more is seen to slide on what the empty hangs on


@dataclass(frozen=True)
class LeftEmpty:
    """An empty that goes on while its contact, of this name, stands: so far, m, from one scene
    frame to another."""

    contact: str
    empty: str
    away: float
    first: float
    last: float


@dataclass(frozen=True)
class _Marked:
    """A contact's name, the empty that places it, and instants (N,) of its stance, scene frames,
    of which it stands until `last`; rides: on something that moves."""

    contact: str
    empty: bpy.types.Object
    frames: FloatArray
    rides: bool

    @staticmethod
    def of(settings: HangtimeSettings, row: ContactRow) -> _Marked:
        first, _ = stance_frames(settings, row.phase) or (row.start_frame, row.end_frame)
        frames = np.linspace(first, max(first, row.end_frame), INSTANTS)
        rides = row.on is not None and may_move(row.on)
        return _Marked(row.name, row.empty, frames, rides)


def take_places(settings: HangtimeSettings, showing: Showing) -> Incremental[tuple[LeftEmpty, ...]]:
    """Puts contacts where the moving empties that mark them are as their stances begin.

    Returns the empties that do not stay there, of contacts that stay. showing: as of `in_slices`.
    """
    marked = [_Marked.of(settings, row) for row in listed(settings) if _moves(row)]
    if not marked:
        return ()
    frames = np.unique([each.frames for each in marked])
    yield from simulate([each.empty for each in marked], frames[-1], showing)
    look = partial(_places, [each.empty for each in marked])
    seen = np.concatenate((yield from in_slices(frames, look, showing)))
    paths = [seen[np.searchsorted(frames, each.frames), i] for i, each in enumerate(marked)]
    follow_moving(
        settings, {each.contact: path[0] for each, path in zip(marked, paths, strict=True)}
    )
    metres = metres_per_unit(current_scene())
    return tuple(
        LeftEmpty(each.contact, each.empty.name, away, each.frames[0], each.frames[-1])
        for each, path in zip(marked, paths, strict=True)
        if not each.rides and (away := metres * _farthest(path)) > FELT
    )


def _moves(row: ContactRow) -> bool:
    marks = row.used and row.empty is not None and may_mark(row.empty, row.id_data)
    return marks and may_move(row.empty)


def _places(empties: Sequence[bpy.types.Object], frames: FloatArray) -> FloatArray:
    """(T, N, 3) places of N objects, Blender units."""
    return np.array(seen_at(empties, frames, lambda seen: seen.matrix_world.translation.to_tuple()))


def _farthest(path: FloatArray) -> float:
    """From where a path (T, 3) begins."""
    return float(np.linalg.norm(path - path[0], axis=1).max())
