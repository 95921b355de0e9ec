"""The controls that an animator would use, of all that move the bodies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ..armature import fcurves
from .posing import Posing
from .responses import FELT, Dof, Freedom, Responses, free_dofs, measured

LEVER = 0.3  # m, by which turns of bodies count beside shifts
NEW = 0.15  # share of what a dof does that others must not do already
LEAST = 0.05  # m a rad, or m a m: what does less is of no use
PART = 0.05  # of a turn, by which a body that follows in full may miss it
WHOLE = 0.6  # of the bodies, which more than legs and pelvis are
_STILL = 1e-6  # of a curve's values


def felt_controls(posing: Posing, bases: FloatArray) -> list[int]:
    """Controls that move any body, by one try each of all their channels."""
    for index, basis in enumerate(bases):
        posing.pose(index, basis)
    before, found = posing.look().bodies, []
    for index, name in enumerate(posing.controls):
        own = list(free_dofs(posing.armature, [name]))
        basis = bases[index]
        for dof in own:
            basis = dof.applied(basis, dof.step)
        posing.pose(index, basis)
        if np.abs(posing.look().bodies - before).max() > 1e-5:
            found.append(index)
        posing.pose(index, bases[index])
    return found


def all_responses(posing: Posing, bases: FloatArray) -> Responses:
    """Responses of every dof of every control, one after the other."""
    every = np.ones(len(posing.bodies), bool)
    dofs = free_dofs(posing.armature, posing.controls)
    return measured(posing, bases, [[(dof, every)] for dof in dofs])


def used_dofs(posing: Posing, bases: FloatArray, responses: Responses, unit: float) -> list[int]:
    """Dofs that together pose the bodies, as few as do; in the order of preference.

    First those whose curves move in the take, then what moves most bodies. unit: m in the
    armature's unit.
    """
    posed = posing.look()
    turns, shifts = responses.columns(posed, bases)
    rows = np.concatenate([LEVER * turns.reshape(len(turns), -1), unit * shifts[:, 0]], axis=1)
    by_freedom = np.array([1.0 if d.freedom is Freedom.TURN else unit for d in responses.dofs])
    rows = rows / by_freedom[:, None]
    chosen: list[int] = []
    basis = np.zeros((0, rows.shape[1]))
    for d in _preferred(posing, responses):
        size = np.linalg.norm(rows[d])
        rest = rows[d] - basis.T @ (basis @ rows[d])
        rest -= basis.T @ (basis @ rest)
        left = np.linalg.norm(rest)
        if left > max(NEW * size, LEAST):
            chosen.append(d)
            basis = np.vstack([basis, rest / left])
    return chosen


def _preferred(posing: Posing, responses: Responses) -> list[int]:
    """All dofs, the preferred first.

    Of the controls that move the whole figure the last below the others leads, and the rest come
    last. A shift that turns the same bodies as its control's turns bends what is rigid (a tweak, a
    stretched spine): late.
    """
    controls = _followers(responses)
    moving = _moving(posing.armature)
    whole = [c for c, of in controls.items() if of[0] and of.mean() > WHOLE]
    turned = _turned_by(responses, Freedom.TURN)
    bends = {c: (of & turned[c]).any() for c, of in _turned_by(responses, Freedom.SHIFT).items()}
    axes = Counter(d.control for d in responses.dofs if d.freedom is Freedom.TURN)

    shares = _shared(responses)

    def key(d: int) -> tuple[bool, bool, bool, bool, bool, int, int, int, bool, int]:
        dof = responses.dofs[d]
        keyed = (posing.controls[dof.control], dof.freedom) in moving
        turn = dof.freedom is Freedom.TURN
        leads = bool(whole) and dof.control == whole[-1]
        return (
            dof.control in whole[:-1],
            not leads,
            not turn and bool(bends[dof.control]),
            not keyed,
            bool(shares[dof.control]),
            -int(controls[dof.control].sum()),
            -axes[dof.control],
            dof.control,
            not turn,
            dof.axis,
        )

    return sorted(range(len(responses.dofs)), key=key)


def _followers(responses: Responses) -> dict[int, BoolArray]:
    """(B,) bodies that follow each control, by index, parents first."""
    found: dict[int, BoolArray] = {}
    for dof, follow in zip(responses.dofs, responses.follow, strict=True):
        found[dof.control] = found.get(dof.control, follow) | follow
    return found


def _shared(responses: Responses) -> dict[int, bool]:
    """Whether some bodies follow the turns of each control by a part only, as those of a foot's
    roll do: after those that all follow in full."""
    amount = np.linalg.norm(responses.turns, axis=2)
    part = (responses.follow & (np.abs(amount - 1.0) > PART)).any(1)
    found = {dof.control: False for dof in responses.dofs}
    for dof, shared in zip(responses.dofs, part, strict=True):
        if dof.freedom is Freedom.TURN:
            found[dof.control] |= bool(shared)
    return found


def _turned_by(responses: Responses, freedom: Freedom) -> dict[int, BoolArray]:
    """(B,) bodies that each control turns by turning or shifting."""
    turned = np.abs(responses.turns).max(2) > FELT
    found = {dof.control: np.zeros(turned.shape[1], bool) for dof in responses.dofs}
    for dof, of in zip(responses.dofs, turned, strict=True):
        if dof.freedom is freedom:
            found[dof.control] = found[dof.control] | of
    return found


def _moving(armature: bpy.types.Object) -> set[tuple[str, Freedom]]:
    """Controls whose turns or places change in the take."""
    found = set()
    for curve in fcurves.curves_of(armature):
        name, values = fcurves.bone_of(curve.data_path), fcurves.keys(curve)[:, 1]
        if name is None or not len(values) or np.ptp(values) < _STILL:
            continue
        if curve.data_path.endswith("location"):
            found.add((name, Freedom.SHIFT))
        elif "rotation" in curve.data_path:
            found.add((name, Freedom.TURN))
    return found


def by_control(dofs: Sequence[Dof], controls: Sequence[str]) -> dict[str, set[Freedom]]:
    """What is used of each control."""
    found: dict[str, set[Freedom]] = {}
    for dof in dofs:
        found.setdefault(controls[dof.control], set()).add(dof.freedom)
    return found
