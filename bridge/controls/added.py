"""Controls added to those that a motion needs, where these leave more of it than may be.

A limb in inverse kinematics that stretches shortens both its bones alike, so a knee may stand off
its place though hip and foot are at theirs; the control at the knee shifts it there. Which controls
do most is forward selection in least squares (Miller, Subset Selection in Regression, 2002, 3.1).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from .choice import Group, all_responses
from .control_rig import ControlRig, rig_of
from .inverse import Inverted
from .kept import FAR_MM, TURNED_DEG
from .needed import DEAR, LEVER, effects_at
from .responses import Freedom

GAIN = 0.3  # share that a further control must take away of what is left at some frame
MOST = 4  # bodies, at whose worst frames all controls are tried


@dataclass(frozen=True)
class _Lack:
    """What bodies lack at a frame, (6 B,) m, and what each dof does about it, (D, 6 B)."""

    lacks: FloatArray
    done: FloatArray

    def left(self, dofs: Sequence[int]) -> float:
        """m² that least squares of these dofs leave."""
        rows = self.done[list(dofs)]
        normal = rows @ rows.T + DEAR**2 * np.eye(len(rows))
        rest = self.lacks - np.linalg.solve(normal, rows @ self.lacks) @ rows
        return float(rest @ rest)


def with_added(
    rig: ControlRig,
    frames: FloatArray,
    solved: Sequence[Inverted],
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[ControlRig]:
    """A rig with shifts of further controls; the very same where all bodies are near enough, or
    nothing helps. solved: at frames (T,)."""
    at = _missed_at(solved)
    if not at:
        return rig
    index = {float(frames[t]): t for t in at}

    def look(part: FloatArray) -> list[_Lack]:
        with rig.felt.posing.kept():
            return [_lack(rig, float(frame), solved[index[float(frame)]]) for frame in part]

    parts = yield from in_slices(frames[at], look, showing)
    added = _chosen(rig, [each for part in parts for each in part])
    return rig_of(rig.felt, [*rig.groups, *added]) if added else rig


def _missed_at(solved: Sequence[Inverted]) -> list[int]:
    """Indices of the frames at which bodies miss most, of those that miss too much."""
    off = 1e3 / FAR_MM * np.stack([each.off for each in solved])
    turned = np.degrees(np.stack([each.turned for each in solved])) / TURNED_DEG
    share = np.maximum(off, turned)
    worst = share.max(0)
    bodies = [b for b in np.argsort(-worst) if worst[b] > 1.0][:MOST]
    return sorted({int(share[:, b].argmax()) for b in bodies})


def _lack(rig: ControlRig, frame: float, solved: Inverted) -> _Lack:
    posing = rig.felt.posing
    posing.go_to(frame)
    bases, world = posing.bases(), posing.object_to_world()
    for name, basis in zip(rig.controls, solved.bases, strict=True):
        bases[posing.controls.index(name)] = basis
    responses, posed = all_responses(posing, bases), posing.look()
    unit = metres_per_unit(current_scene()) * float(np.cbrt(np.linalg.det(world[:3, :3])))
    done = effects_at(responses, posed, bases, [-1] * len(posing.bodies), unit).done
    lacks = np.concatenate([solved.lacks.ravel(), LEVER * solved.lacked_turns.ravel()])
    return _Lack(lacks, done)


def _chosen(rig: ControlRig, lacks: Sequence[_Lack]) -> list[Group]:
    """Groups of dofs that are not used and help most, one after the other."""
    dofs = rig.felt.looks[0].responses.dofs
    used = {(group.control, group.freedom) for group in rig.groups}
    shifts: dict[int, list[int]] = {}
    for d, dof in enumerate(dofs):
        if dof.freedom is Freedom.SHIFT and (dof.control, dof.freedom) not in used:
            shifts.setdefault(dof.control, []).append(d)
    others = [Group(control, Freedom.SHIFT, tuple(own)) for control, own in shifts.items()]
    chosen = [d for group in rig.groups for d in group.dofs]
    added: list[Group] = []
    while others:
        left = np.array([lack.left(chosen) for lack in lacks])
        live = np.flatnonzero(left > (FAR_MM / 1e3) ** 2)
        if not len(live):
            break
        tried = np.array([[lacks[i].left([*chosen, *g.dofs]) for i in live] for g in others])
        best = int(tried.sum(1).argmin())
        if (tried[best] > (1.0 - GAIN) * left[live]).all():
            break
        group = others.pop(best)
        added.append(group)
        chosen += group.dofs
    return added
