"""The protocol of cases: from seed and number to how a case ended.

A family's `run` does one case. It returns where all went well, and raises the product's own Fault
(or Said) where that refused with words. It sets `taken_on` once the first gate is passed. Changed
and LeftBehind tell what else is wrong. Any other exception is a crash: it ends the process, as a
fault of the memory would.
"""

import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TypeVar

import numpy as np

from ....operators.words.messages import sentence
from ....solver.data.faults import Fault

T = TypeVar("T")


class Ending(StrEnum):
    """How a case ended; the first two are as they should be."""

    SUCCESS = "success"
    NAMED_FAULT = "named fault"
    CRASH = "crash"
    HANG = "hang"
    CHANGED = "changed"
    LEFTOVER = "leftover"

    @property
    def good(self) -> bool:
        return self in (Ending.SUCCESS, Ending.NAMED_FAULT)


class Said(Exception):
    """A refusal in words that Blender reports."""


class Changed(Exception):
    """What the artist has was changed: the recording, another action, the selection."""


class LeftBehind(Exception):
    """Something that a case made is still there: a file, a data-block, a process."""


@dataclass
class HostileCase:
    """One case while it runs.

    folder: empty, its own; what it leaves there is no leftover. taken_on: whether what it made was
    read, analysed or solved; what is refused at the first gate tries the gate alone.
    """

    rng: np.random.Generator
    folder: Path
    taken_on: bool = False

    def chance(self, share: float) -> bool:
        """True in this share of cases."""
        return bool(self.rng.random() < share)

    def pick(self, things: Sequence[T]) -> T:
        """One of them."""
        return things[int(self.rng.integers(len(things)))]


@dataclass(frozen=True)
class Family:
    """A kind of cases. share: weight among the families. bound: s that a case may take."""

    name: str
    share: float
    bound: float
    run: Callable[[HostileCase], None]


@dataclass(frozen=True)
class CaseOutcome:
    """How a case of a family ended; detail: the fault's sentence or the traceback."""

    number: int
    family: str
    ending: Ending
    detail: str = ""
    seconds: float = 0.0
    taken_on: bool = False


def run_case(family: Family, number: int, seed: int, folder: Path) -> CaseOutcome:
    """Does one case; its folder is removed where it ended well. A crash is the process's own."""
    shutil.rmtree(folder, ignore_errors=True)
    scratch = folder / "scratch"  # for what the product keeps while it works
    scratch.mkdir(parents=True)
    tempfile.tempdir = str(scratch)
    case = HostileCase(np.random.default_rng([seed, number]), folder)
    began = time.monotonic()
    ending, detail = _ended(family, case)
    seconds = time.monotonic() - began
    left = [path.name for path in scratch.iterdir()]
    if ending.good and left:
        ending, detail = Ending.LEFTOVER, f"temporary files: {', '.join(left)}"
    if ending.good:
        shutil.rmtree(folder, ignore_errors=True)
    return CaseOutcome(number, family.name, ending, detail, seconds, case.taken_on)


def _ended(family: Family, case: HostileCase) -> tuple[Ending, str]:
    try:
        family.run(case)
    except Fault as fault:  # named where it can be said
        return Ending.NAMED_FAULT, f"{type(fault).__name__}: {sentence(fault)}"
    except Said as told:
        return Ending.NAMED_FAULT, f"Said: {told}"
    except Changed as problem:
        return Ending.CHANGED, str(problem)
    except LeftBehind as problem:
        return Ending.LEFTOVER, str(problem)
    return Ending.SUCCESS, ""
