"""The controls that an animator would use, of all that move the bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ..armature import fcurves
from .needed import Effects, needed
from .posing import Posing
from .responses import Dof, Freedom, Responses, Trial, disjoint, free_dofs, measured

PART = 0.05  # of a turn, by which a body that follows in full may miss it
WHOLE = 0.6  # of the bodies, which more than legs and pelvis are
TORN = 0.3  # share of a control's effect that pulls bodies apart (a tweak, a stretched spine)
_STILL = 1e-6  # of a curve's values


@dataclass(frozen=True)
class Group:
    """The dofs of one freedom of a control, by index; its size goes with its turns."""

    control: int
    freedom: Freedom
    dofs: tuple[int, ...]


def moved_by_controls(posing: Posing, bases: FloatArray) -> FloatArray:
    """(C, B + C) how much each control moves bodies and controls, by one try each of all its
    channels: the largest change of a pose's entries."""
    for index, basis in enumerate(bases):
        posing.pose(index, basis)
    before, found = posing.look(), []
    for index, name in enumerate(posing.controls):
        basis = bases[index]
        for dof in free_dofs(posing.armature, [name]):
            basis = dof.applied(basis, dof.step)
        posing.pose(index, basis)
        after = posing.look()
        changes = np.concatenate([after.bodies - before.bodies, after.controls - before.controls])
        found.append(np.abs(changes).max((1, 2)))
        posing.pose(index, bases[index])
    return np.stack(found)


def all_responses(posing: Posing, bases: FloatArray, moved: BoolArray) -> Responses:
    """Responses of every dof of every control; at once those of controls that move nothing in
    common. moved: (C, B + C) the bodies and controls that each moves there at all."""
    count, dofs = len(posing.bodies), list(free_dofs(posing.armature, posing.controls))
    trials = [Trial(d, moved[d.control, :count], moved[d.control, count:]) for d in dofs]
    of_control = [[t for t in trials if t.dof.control == c] for c in range(len(bases))]
    own = np.eye(len(bases), len(bases) + count, count, dtype=bool)
    groups = [
        [trial for trial in together if trial is not None]
        for controls in disjoint(list(moved | own))
        for together in zip_longest(*(of_control[c] for c in controls))
    ]
    found = measured(posing, bases, groups)
    order = [found.dofs.index(dof) for dof in dofs]
    return found.part(order, range(len(bases)))


def used_groups(posing: Posing, looks: Sequence[tuple[Responses, Effects]]) -> list[Group]:
    """Groups of dofs that together pose the bodies, as few as do. looks: the same dofs at several
    frames."""
    wanted = _preferred(posing, looks)
    return [wanted[g] for g in needed([g.dofs for g in wanted], [each for _, each in looks])]


def _preferred(posing: Posing, looks: Sequence[tuple[Responses, Effects]]) -> list[Group]:
    """All groups, the preferred first: those whose curves move in the take, then what moves most
    bodies.

    Of the controls that move the whole figure the last below the others leads, and the rest come
    last. What pulls apart bodies that hang together comes late.
    """
    dofs = looks[0][0].dofs
    follow = np.any([responses.follow for responses, _ in looks], axis=0)
    torn = np.max([effects.torn for _, effects in looks], axis=0) > TORN
    shared = np.any([_shared(responses) for responses, _ in looks], axis=0)
    by_control = {d.control: np.zeros(follow.shape[1], bool) for d in dofs}
    for dof, of in zip(dofs, follow, strict=True):
        by_control[dof.control] |= of
    whole = [c for c, of in by_control.items() if of[0] and of.mean() > WHOLE]
    moving = _moving(posing.armature)

    def key(group: Group) -> tuple[bool, bool, bool, bool, bool, int, int, int, bool]:
        control = group.control
        own = [d for d in group.dofs if dofs[d].freedom is group.freedom]
        tears = bool(torn[own].any())
        return (
            control in whole[:-1],
            not whole or control != whole[-1],
            tears,
            (posing.controls[control], group.freedom) not in moving,
            bool(shared[own].any()),
            int(by_control[control].sum()) * (1 if tears else -1),
            -len(own),
            control,
            group.freedom is not Freedom.TURN,
        )

    return sorted(_groups(dofs), key=key)


def _groups(dofs: Sequence[Dof]) -> list[Group]:
    found: dict[tuple[int, Freedom], list[int]] = {}
    for d, dof in enumerate(dofs):
        freedom = Freedom.TURN if dof.freedom is Freedom.SIZE else dof.freedom
        found.setdefault((dof.control, freedom), []).append(d)
    return [Group(control, freedom, tuple(own)) for (control, freedom), own in found.items()]


def _shared(responses: Responses) -> BoolArray:
    """(D,) whether some bodies follow a turn by a part only, as those of a foot's roll do: after
    those that all follow in full."""
    amount = np.linalg.norm(responses.turns, axis=2)
    turn = np.array([dof.freedom is Freedom.TURN for dof in responses.dofs])
    return np.asarray(turn & (responses.follow & (np.abs(amount - 1.0) > PART)).any(1))


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
