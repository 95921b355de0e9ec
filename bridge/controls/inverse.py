"""Controls such that bodies are where they should be, frame by frame: Levenberg-Marquardt on what
the rig does, measured by trying, so that whatever lies between controls and bodies counts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..armature.channels import proper
from .choice import LEVER
from .posing import Posed, Posing
from .responses import Freedom, Responses, apart, measured
from .targets import Targets

STEPS = 16
UPPER = 0.1  # weight of the upper body: what its spine cannot follow moves no foot
NEAR = 2e-5  # m, beside LEVER times rad: steps that gain less end a frame, as do
LITTLE = 0.03  # those that gain a smaller share of the error
SLOW = 0.25  # share of the error that a step may leave before the rig is tried anew
# Of the squares of a dof's effect; Nielsen, Damping Parameter in Marquardt's Method (1999).
DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-6, 1.0
LESS, MORE = 5.0, 6.0  # by which damping goes down after a gain, and up after none
LONGEST = 0.5  # rad, or m, of one step


@dataclass(frozen=True)
class Inverted:
    """Pose bases (C, 4, 4) of controls at a frame, and what is left: by body m and rad (B,)."""

    bases: FloatArray
    off: FloatArray
    turned: FloatArray


class Inverse:
    """Solves frames one after the other; each begins with what the one before needed."""

    def __init__(self, posing: Posing, responses: Responses, targets: Targets) -> None:
        self._posing, self._targets = posing, targets
        self._groups = apart(responses)
        self._responses = responses
        self._turns = np.tile(np.eye(3), (len(posing.controls), 1, 1))
        self._shifts = np.zeros((len(posing.controls), 3))
        weights = np.where(targets.upper, UPPER, 1.0)
        self._weights = np.repeat(np.concatenate([weights, weights]), 3)
        self.tries = 0

    def solve(self, t: int) -> Inverted:
        """Solve the frame of index t."""
        posing = self._posing
        posing.go_to(float(self._targets.frames[t]))
        animated = posing.bases()
        bases = animated.copy()
        bases[:, :3, :3] = animated[:, :3, :3] @ self._turns
        bases[:, :3, 3] += self._shifts
        fresh, damping = False, DAMPING
        best = self._look(bases, t)
        for _ in range(STEPS):
            posed, error = best
            size = float(np.linalg.norm(error))
            moved = self._stepped(bases, posed, error, t, damping)
            after = self._look(moved, t)
            left = float(np.linalg.norm(after[1]))
            gained = size - left
            if gained > 0.0:
                bases, best = moved, after
            done = gained < max(NEAR, LITTLE * size) if gained > 0.0 else damping > MOST_DAMPING
            if fresh and (done or left < NEAR):
                break
            anew = left > SLOW * size and (gained > 0.0 or not fresh)
            damping = max(damping / LESS, LEAST_DAMPING) if gained > 0.0 else MORE * damping
            if anew:
                self._responses = measured(posing, bases, self._groups)
                self.tries += len(self._groups)
            fresh = anew or (fresh and gained <= 0.0)
        self._turns = np.swapaxes(proper(animated[:, :3, :3]), 1, 2) @ proper(bases[:, :3, :3])
        self._shifts = bases[:, :3, 3] - animated[:, :3, 3]
        error = (best[1] / self._weights).reshape(2, -1, 3)
        return Inverted(
            bases, np.linalg.norm(error[0], axis=1), np.linalg.norm(error[1], axis=1) / LEVER
        )

    def _look(self, bases: FloatArray, t: int) -> tuple[Posed, FloatArray]:
        for index, basis in enumerate(bases):
            self._posing.pose(index, basis)
        self.tries += 1
        posed = self._posing.look()
        return posed, self._error(posed, t)

    def _error(self, posed: Posed, t: int) -> FloatArray:
        """(6 B,) heads in m, then turns times LEVER, that bodies lack; in the armature's axes,
        weighted."""
        wanted = self._targets
        off = wanted.unit[t] * (wanted.heads[t] - posed.bodies[:, :3, 3])
        now = np.swapaxes(proper(posed.bodies[:, :3, :3]), 1, 2)
        turned = LEVER * rotation_vector(wanted.rotations[t] @ now)
        error: FloatArray = self._weights * np.concatenate([off.ravel(), turned.ravel()])
        return error

    def _stepped(
        self, bases: FloatArray, posed: Posed, error: FloatArray, t: int, damping: float
    ) -> FloatArray:
        """Bases after a damped least-squares step."""
        turns, shifts = self._responses.columns(posed, bases)
        count = len(turns)
        unit = self._targets.unit[t]
        rows = np.concatenate(
            [unit * shifts.reshape(count, -1), LEVER * turns.reshape(count, -1)], axis=1
        )
        rows = rows * self._weights
        sizes = np.linalg.norm(rows, axis=1)
        rows = rows / np.where(sizes > 0.0, sizes, 1.0)[:, None]
        normal = rows @ rows.T + damping * np.eye(count)
        step = np.linalg.solve(normal, rows @ error) / np.where(sizes > 0.0, sizes, np.inf)
        changed = bases.copy()
        for index in {dof.control for dof in self._responses.dofs}:
            turn, shift = np.zeros(3), np.zeros(3)
            for dof, amount in zip(self._responses.dofs, step, strict=True):
                if dof.control == index:
                    (turn if dof.freedom is Freedom.TURN else shift)[dof.axis] = amount
            limit = min(1.0, LONGEST / max(float(np.linalg.norm(turn)), 1e-12))
            changed[index, :3, :3] = bases[index, :3, :3] @ rotation_matrix(limit * turn)
            changed[index, :3, 3] += shift
        return changed
