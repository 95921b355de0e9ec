"""What each degree of freedom of the controls does to the bodies, measured by small changes.

A response is kept in the control's own axes, and as what is different from a rigid follower: so it
holds at other frames too for whatever follows in that way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..accessors import pose_of
from ..armature.channels import proper
from .driven import stretching
from .posing import Posed, Posing

TURN_STEP = 0.001  # rad
SHIFT_STEP = 0.001  # Blender units
SIZE_STEP = 0.001  # of the size
FELT = 2e-3  # of a step; what answers by less does not follow


class Freedom(Enum):
    """What a degree of freedom changes."""

    TURN = "turn"
    SHIFT = "shift"
    SIZE = "size"


@dataclass(frozen=True)
class Dof:
    """Degree of freedom of a control, by index: a turn about one of its own axes, a shift along one
    of those in which its channels count, or its size along all."""

    control: int
    freedom: Freedom
    axis: int

    @property
    def step(self) -> float:
        """The change by which it is tried."""
        steps = {Freedom.TURN: TURN_STEP, Freedom.SHIFT: SHIFT_STEP, Freedom.SIZE: SIZE_STEP}
        return steps[self.freedom]

    @property
    def shifts(self) -> bool:
        """Whether it is counted in units of length."""
        return self.freedom is Freedom.SHIFT

    def applied(self, basis: FloatArray, amount: float) -> FloatArray:
        """A pose basis (4, 4), changed by that much."""
        changed = basis.copy()
        if self.freedom is Freedom.SHIFT:
            changed[self.axis, 3] += amount
        elif self.freedom is Freedom.SIZE:
            changed[:3, :3] = (1.0 + amount) * basis[:3, :3]
        else:
            changed[:3, :3] = basis[:3, :3] @ rotation_matrix(amount * np.eye(3)[self.axis])
        return changed


def axes_of(dofs: Sequence[Dof], posed: Posed, bases: FloatArray) -> FloatArray:
    """(D, 3, 3) axes of the responses, in the armature's space. bases: (C, 4, 4)."""
    own = posed.frame_axes @ proper(bases[:, :3, :3])
    controls = [dof.control for dof in dofs]
    shifts = np.array([dof.shifts for dof in dofs])[:, None, None]
    return np.where(shifts, posed.place_axes[controls], own[controls])


@dataclass(frozen=True)
class Columns:
    """What dofs do at a pose: turns and shifts (D, B, 3) in the armature's space; and the axes
    (D, 3, 3) there in which responses are kept."""

    axes: FloatArray
    turns: FloatArray
    shifts: FloatArray


@dataclass(frozen=True)
class Responses:
    """Of dofs D on bodies B and controls C.

    turns: (D, B, 3), in the control's axes. shifts: (D, B, 3) of the heads, likewise, without those
    of a rigid turn about the control. follow: (D, B). moved: (D, C), other controls that move.
    """

    dofs: tuple[Dof, ...]
    turns: FloatArray
    shifts: FloatArray
    follow: BoolArray
    moved: BoolArray

    def columns(self, posed: Posed, bases: FloatArray) -> Columns:
        """What the dofs do at another pose."""
        axes = axes_of(self.dofs, posed, bases)
        to_axes = np.swapaxes(axes, 1, 2)
        turns = self.turns @ to_axes
        return Columns(axes, turns, self.shifts @ to_axes + _rigid(self.dofs, turns, posed))

    def corrected(
        self, columns: Columns, before: Posed, step: FloatArray, after: Posed
    ) -> Responses:
        """Such that a step (D,) from a pose, where these have those columns, does what it was seen
        to do, by the least change of what follows (Schubert, Modification of a Quasi-Newton Method
        for Nonlinear Equations with a Sparse Jacobian, 1970)."""
        turned = rotation_vector(_turned(before, after))
        apart = after.bodies[:, :3, 3] - before.bodies[:, :3, 3]
        own = step[:, None] * self.follow
        squares = (own**2).sum(0)
        share = (own / np.where(squares > 0.0, squares, 1.0))[..., None]
        turns_more = share * (turned - np.tensordot(step, columns.turns, 1))
        shifts_more = share * (apart - np.tensordot(step, columns.shifts, 1))
        shifts_more -= _rigid(self.dofs, turns_more, before)
        return replace(
            self,
            turns=self.turns + turns_more @ columns.axes,
            shifts=self.shifts + shifts_more @ columns.axes,
        )

    def part(self, chosen: Sequence[int], controls: Sequence[int]) -> Responses:
        """Those of some dofs, which are of some controls; among these alone."""
        rows, kept = list(chosen), list(controls)
        dofs = (self.dofs[d] for d in rows)
        return Responses(
            tuple(replace(dof, control=kept.index(dof.control)) for dof in dofs),
            self.turns[rows],
            self.shifts[rows],
            self.follow[rows],
            self.moved[np.ix_(rows, kept)],
        )

    def of_controls(self, chosen: BoolArray) -> Responses:
        """Those of the dofs of some controls (C,), which keep their indices."""
        rows = [d for d, dof in enumerate(self.dofs) if chosen[dof.control]]
        return self.part(rows, range(len(chosen)))


def _rigid(dofs: Sequence[Dof], turns: FloatArray, posed: Posed) -> FloatArray:
    """(D, B, 3) shifts of heads that turn (D, B, 3) rigidly about their controls."""
    places = posed.controls[[dof.control for dof in dofs], :3, 3]
    arms = posed.bodies[:, :3, 3] - places[:, None]
    rigid = np.array([dof.freedom is Freedom.TURN for dof in dofs])
    return np.asarray(rigid[:, None, None] * np.cross(turns, arms))


def free_dofs(armature: bpy.types.Object, controls: Sequence[str]) -> Iterator[Dof]:
    """The degrees of freedom that are not locked. Sizes only of what is in a chain that stretches:
    one bends by shortening its bones as well, and its size makes up for that."""
    stretched = stretching(armature)
    for index, name in enumerate(controls):
        bone = pose_of(armature).bones[name]
        for freedom, locked in (
            (Freedom.TURN, bone.lock_rotation),
            (Freedom.SHIFT, bone.lock_location),
        ):
            yield from (Dof(index, freedom, axis) for axis in range(3) if not locked[axis])
        if name in stretched and not any(bone.lock_scale):
            yield Dof(index, Freedom.SIZE, 0)


@dataclass(frozen=True)
class Trial:
    """A dof that is tried, and what can follow it: bodies (B,) and controls (C,)."""

    dof: Dof
    bodies: BoolArray
    controls: BoolArray


def measured(posing: Posing, bases: FloatArray, groups: Iterable[Sequence[Trial]]) -> Responses:
    """Responses at the scene's frame with pose bases (C, 4, 4). groups: what is tried at once."""
    for index, basis in enumerate(bases):
        posing.pose(index, basis)
    before = posing.look()
    dofs, turns, shifts, follow, moved = [], [], [], [], []
    for group in groups:
        for dof in (trial.dof for trial in group):
            posing.pose(dof.control, dof.applied(bases[dof.control], dof.step))
        after = posing.look()
        turned = rotation_vector(_turned(before, after))
        apart = after.bodies[:, :3, 3] - before.bodies[:, :3, 3]
        change = np.abs(after.controls - before.controls).max((1, 2))
        for trial in group:
            dof = trial.dof
            posing.pose(dof.control, bases[dof.control])
            turn, shift = turned / dof.step, apart / dof.step
            felt = np.maximum(np.abs(turn).max(1), np.abs(shift).max(1)) > FELT
            dofs.append(dof)
            turns.append(turn)
            shifts.append(shift)
            follow.append(felt & trial.bodies)
            others = np.arange(len(change)) != dof.control
            moved.append((change / dof.step > FELT) & others & trial.controls)
    keep, axes = np.stack(follow), axes_of(dofs, before, bases)
    turns_of, kept = np.stack(turns), keep[..., None]
    shifts_of = np.stack(shifts) - _rigid(dofs, turns_of, before)
    return Responses(
        tuple(dofs),
        np.where(kept, turns_of @ axes, 0.0),
        np.where(kept, shifts_of @ axes, 0.0),
        keep,
        np.stack(moved),
    )


def _turned(before: Posed, after: Posed) -> FloatArray:
    """(B, 3, 3) turns of the bodies between poses."""
    return after.body_turns @ np.swapaxes(before.body_turns, 1, 2)


def apart(responses: Responses) -> list[list[Trial]]:
    """The dofs in as few groups as come by themselves of which no two share a follower."""
    every = zip(responses.dofs, responses.follow, responses.moved, strict=True)
    trials = [Trial(*each) for each in every]
    own = np.eye(responses.moved.shape[1], dtype=bool)
    moved = [np.append(each.bodies, own[each.dof.control]) for each in trials]
    return [[trials[d] for d in group] for group in disjoint(moved)]


def disjoint(sets: Sequence[BoolArray]) -> list[list[int]]:
    """Sets (M,) of things, by index, in as few groups as come by themselves of which no two share
    one; the largest first."""
    groups: list[tuple[list[int], BoolArray]] = []
    for i in np.argsort([-own.sum() for own in sets], kind="stable").tolist():
        free = next((group for group in groups if not (group[1] & sets[i]).any()), None)
        if free is None:
            groups.append(([i], sets[i].copy()))
        else:
            free[0].append(i)
            free[1][:] |= sets[i]
    return [group for group, _ in groups]
