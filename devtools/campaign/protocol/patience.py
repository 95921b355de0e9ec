"""Solves in this process end after a while, as when the artist presses Esc."""

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np

from ....solver.optimisation.sqp import Step
from ....solver.transcription.motion import Motion
from ....solver.worker.stage_clock import StageClock


class _Enough(Exception):
    """Ends a solve that has had its time."""


class _ImpatientClock(StageClock):
    """Ends the solve after a while. Raises ValueError for a step that is no number."""

    def __init__(self, seconds: float) -> None:
        super().__init__()
        self._until = time.process_time() + seconds

    def step(self, step: Step, motion: Motion) -> None:
        if not (np.isfinite(step.violation) and np.isfinite(motion.x).all()):
            raise ValueError(f"not finite after a step of {step.stage}")
        if time.process_time() > self._until:
            raise _Enough


@contextmanager
def at_most(seconds: float) -> Iterator[StageClock]:
    """Context of a solve, with its clock: it ends after so many s of this process, in steps."""
    with suppress(_Enough):
        yield _ImpatientClock(seconds)
