"""Sequential quadratic programming: the feasible set, steps and how a solve ends (thesis 4.4).

Each step solves the linearised problem (kkt_step.py)

    min  g . d + 1/2 d . W d   subject to   C(x) + C_x d = 0,   lo <= B(x) + B_x d <= hi

with W the metric of tracking_cost.py. With g the gradient of the distance to a target this
*projects* the target onto the feasible set (the fit, projection.py); with g = 0 it is the thesis's
minimum-norm step (the implicit solution, restoration.py), which converges quadratically and stays
near where it began.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..transcription.motion import Motion
from ..transcription.rows import Rows
from ..transcription.transcription import Transcription
from .kkt_step import LinearisedProblem, Remains

NEARLY_FEASIBLE = 200.0  # times the tolerances: the end of a solve, which restoration finishes


@dataclass(frozen=True)
class Step:
    """Record of one step: worst violation over its tolerance before it, whose, and its length.

    worst: a contact's name, a constraint's, or the row kind's where it is nobody's.
    """

    stage: str
    violation: float
    length: float
    worst: str = ""


@dataclass(frozen=True)
class Outcome:
    """End of a solve: unknowns x (K, n_block), their transcription, and places (n_contacts, 3) m.

    violation: the worst over its tolerance.
    """

    x: FloatArray
    transcription: Transcription
    status: Status
    steps: tuple[Step, ...]
    violation: float
    places: FloatArray

    @property
    def solved(self) -> bool:
        return self.status is Status.SOLVED

    def unguarded(self) -> "Outcome":
        """The same without the rows that guarded it."""
        return replace(self, transcription=self.transcription.guarded(()))


Progress = Callable[[Step, Motion], None]
"""Callback after each step, with the motion that stays if it is the last; what it raises ends the
solve."""


class Stopped(Exception):
    """Request to end the solve with the motion as it stands."""

    def __init__(self, motion: Motion) -> None:
        super().__init__()
        self.motion = motion


class Objective(Protocol):
    """Objective to be minimised."""

    def value(self, x: FloatArray) -> float:
        """The objective at unknowns (K, n_block)."""

    def expand(
        self, x: FloatArray, into: BlockBanded | None = None
    ) -> tuple[FloatArray, BlockBanded]:
        """Its gradient (K, n_block) and a positive definite approximation of its Hessian. into: an
        earlier one, which may be overwritten."""


@dataclass(frozen=True)
class FeasibleSet:
    """Motions that satisfy a transcription's rows with pins at places (n_contacts, 3) m, world.

    basis: (n_block, k), the changes of a block that are allowed (thesis 5), None all.
    """

    transcription: Transcription
    places: FloatArray
    basis: FloatArray | None = None

    def rows(self, x: FloatArray) -> Rows:
        """Constraint rows at unknowns x (K, n_block)."""
        return self.transcription.rows(x, self.places)

    def values(self, x: FloatArray) -> FloatArray:
        """(R,) values of `rows` without their Jacobian."""
        return self.transcription.values(x, self.places)

    def motion(self, x: FloatArray) -> Motion:
        """Unknowns x (K, n_block) as a motion."""
        return Motion(self.transcription, x, self.places)

    def violation(self, x: FloatArray) -> float:
        """The worst violation over its tolerance; at most 1 means that x (K, n_block) is in it."""
        return worst_violation(self.rows(x))

    def linearise(
        self, rows: Rows, metric: BlockBanded, last: Remains | None = None
    ) -> LinearisedProblem:
        """The linearised problem of these rows with metric W; last: see LinearisedProblem."""
        t = self.transcription
        return LinearisedProblem(t, rows, metric, basis=self.basis, last=last)

    def outcome(
        self, x: FloatArray, status: Status, steps: list[Step], violation: float
    ) -> Outcome:
        """End of a solve in this set."""
        return Outcome(x, self.transcription, status, tuple(steps), violation, self.places)


def worst_violation(rows: Rows) -> float:
    """The worst violation over its kind's tolerance; at most 1 means that all rows hold."""
    return float((np.abs(rows.violation()) / rows.tolerance).max())
