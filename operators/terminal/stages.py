"""Progress of a headless job on the terminal: a line a stage, with time and worst violation."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TextIO

from ...solver.data.reports.report import StageReport
from ...solver.optimisation.sqp import Step
from ...solver.transcription.motion import Motion
from ...solver.worker.stage_clock import StageClock
from .interrupts import raise_unheard

WIDTH = 24


@dataclass
class StageLine:
    """One stage: seconds so far, the optimiser's steps and the last one's worst violation."""

    name: str
    start: float
    seconds: float = 0.0
    steps: int = 0
    violation: float | None = None

    @property
    def text(self) -> str:
        """The stage as a line; a violation of 1 is what is allowed."""
        line = f"{self.name:<{WIDTH}}{self.seconds:6.1f} s"
        if self.violation is not None:
            line += f"   step {self.steps}, worst violation {self.violation:.3g} × allowed"
        return line


class Stages(StageClock):
    """Observer that prints the stages of a job to `out`, in place where that is a terminal."""

    def __init__(self, out: TextIO) -> None:
        super().__init__()
        self.out = out
        self.live = out.isatty()
        self.began = time.monotonic()
        self._current: StageLine | None = None

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        raise_unheard()
        self._current = StageLine(name, time.monotonic())
        self._show(self._current)
        end = "   failed\n"
        try:
            yield
            end = "\n"
        except KeyboardInterrupt:
            end = "   cancelled\n"
            raise
        finally:
            stage, self._current = self._current, None
            self._show(stage, end)
            self.done.append(StageReport(name, stage.seconds, stage.steps or None))

    def step(self, step: Step, motion: Motion) -> None:  # noqa: ARG002
        if self._current is not None:
            self._current.steps += 1
            self._current.violation = step.violation
            self._show(self._current)

    def ended(self, violation: float) -> None:
        if self._current is not None:  # a step itself tells where it began
            self._current.violation = violation

    @property
    def total(self) -> float:
        """Seconds since the job began."""
        return time.monotonic() - self.began

    def _show(self, stage: StageLine, end: str = "") -> None:
        stage.seconds = time.monotonic() - stage.start
        if self.live:
            self.out.write(f"\r\x1b[K{stage.text}{end}")
        elif end:
            self.out.write(f"{stage.text}{end}")
        self.out.flush()
