"""Which bodies controls lead, by what the controls were seen to do."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import BoolArray
from .responses import Freedom, Responses

FULL = 0.05  # of a turn, by which a body that follows in full may miss it


def ranks(responses: Responses) -> list[list[int]]:
    """The controls that can be shifted, in as few groups as come by themselves of which none is
    moved by a later one nor by its own."""
    left = sorted({dof.control for dof in responses.dofs if dof.shifts})
    moves = np.zeros((responses.moved.shape[1],) * 2, dtype=bool)
    for dof, moved in zip(responses.dofs, responses.moved, strict=True):
        moves[dof.control] |= moved
    found = []
    while left:
        first = [c for c in left if not moves[left, c].any()] or left[:1]
        found.append(first)
        left = [c for c in left if c not in first]
    return found


def led_by(responses: Responses, control: int) -> int | None:
    """The first body that turns with a control in full, or else is moved by it."""
    dofs = responses.dofs
    turns = [d for d in _own(responses, control) if dofs[d].freedom is Freedom.TURN]
    amounts = np.linalg.norm(responses.turns[turns], axis=2)
    full = (np.abs(amounts - 1.0) < FULL).all(0) & bool(turns)
    found = np.flatnonzero(full if full.any() else moved_by(responses, control))
    return int(found[0]) if len(found) else None


def moved_by(responses: Responses, control: int) -> BoolArray:
    """(B,) whether a control moves each body."""
    return np.asarray(responses.follow[_own(responses, control)].any(axis=0))


def movers(responses: Responses) -> BoolArray:
    """(C,) whether each control moves any body."""
    count = responses.moved.shape[1]
    return np.array([moved_by(responses, c).any() for c in range(count)], dtype=bool)


def _own(responses: Responses, control: int) -> list[int]:
    """The dofs of a control."""
    return [d for d, dof in enumerate(responses.dofs) if dof.control == control]
