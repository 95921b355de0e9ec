"""A run's stages, timed, and the hook for who watches or halts it."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from ..data.reports.report import StageReport
from ..optimisation.sqp import Step
from ..transcription.motion import Motion


class StageClock:
    """Observer of a run: times its stages. Others show the steps, or halt the run at one."""

    def __init__(self) -> None:
        self.done: list[StageReport] = []

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """A stage of the run."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self.done.append(StageReport(name, time.perf_counter() - began))

    def step(self, step: Step, motion: Motion) -> None:
        """Hears of each step of the optimiser; what it raises ends the run (Stopped: with the
        motion as it stands)."""

    def ended(self, violation: float) -> None:
        """Hears of the violation over its tolerance that a stage's last step left."""
