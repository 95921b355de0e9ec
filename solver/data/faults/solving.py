"""Faults of a run: its recipe, its output, its pins together, and solves that failed."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ..problem import Mend
from ..row_kinds import Violation
from ..status import Status
from .base import Fault

WHOLE = 0.995  # of the way, which rounds to all of it


@dataclass
class BadRecipe(Fault):
    """A recipe with an unknown key, bone or phase, or a value of the wrong kind."""

    path: str
    line: int | None
    problem: str


@dataclass
class BadBonePreset(BadRecipe):
    """The same of a file that holds nothing but a recipe's bones."""


@dataclass
class OutputNotWritable(Fault):
    """The output folder cannot be made or written."""

    path: str
    problem: str


@dataclass
class NotWrittenOver(Fault):
    """A file that a run would make is there already."""

    path: str


@dataclass
class OutputFolderBusy(Fault):
    """Another process is writing its results into the output folder."""

    path: str


@dataclass
class WouldReplaceInput(Fault):
    """A file of the result would take the place of one that it is made from: the recording, its
    skeleton, the recipe, an object's mesh, what a scene links."""

    path: str


@dataclass
class ContradictoryPins(Fault):
    """Two pins that no pose can hold at once."""

    first: str
    second: str
    metres: float


@dataclass(frozen=True)
class Damage:
    """What is wrong with a recording: the kind of finding by its word, its amount in `unit`, the
    bone that shows it most, first and last scene frames of its places, the bone that leaves its
    place where a length changes, what mends it if that is of the poses, and what durations times
    it are right by."""

    kind: str
    amount: float
    unit: str
    frames: tuple[tuple[float, float], ...]
    part: str
    end: str
    mend: tuple[Mend, ...] = ()
    time_scale: float = 1.0


@dataclass
class NoSolution(Fault):
    """The solver ended without meeting every constraint; worst first.

    reached: the share of the way that the best motion found goes. damages: of the recording, which
    may be the cause. fit_off_cm: how far, rms, the fit is off the recording where that is too far
    to begin from; 0 where it is near. asked: names of all that was asked for.
    """

    reason: Status
    worst: tuple[Violation, ...] = ()
    reached: float = 0.0
    damages: tuple[Damage, ...] = ()
    fit_off_cm: float = 0.0
    asked: tuple[str, ...] = ()

    @property
    def goes_part(self) -> bool:
        """Whether the best motion goes a part of the way, by which less can be asked: one that goes
        all of it fails for something else."""
        return 0.0 < self.reached < WHOLE


@dataclass
class NoFit(NoSolution):
    """The same for the recording's own motion, before any pin has moved.

    sound: first and last frame of the longest part in which everything holds; None where none is
    worth keeping.
    """

    sound: tuple[int, int] | None = None


@dataclass
class PinLetGo(Fault):
    """A pin moves only contacts that the fit let go, as no motion holds them beside the others, and
    no other pin moves their stance."""

    pin: str
    contacts: tuple[str, ...]


@dataclass
class WorkerDied(Fault):
    """The process that solves ended without an answer; detail: what it last said, or its code."""

    detail: str


@dataclass
class NotComputable(Fault):
    """Masses, forces and weights so far apart that the solver's equations have no solution in
    floating-point numbers."""


@contextmanager
def computable() -> Iterator[None]:
    """Context, or decorator, of what solves equations. Raises NotComputable where they cannot be
    solved in numbers."""
    try:
        yield
    except np.linalg.LinAlgError as error:
        raise NotComputable from error
