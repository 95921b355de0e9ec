"""What a person sees while a job runs: a line a stage, with its time and the worst violation."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TextIO

from ...solver.optimisation.sqp import Step
from ...solver.transcription.motion import Motion

WIDTH = 24


@dataclass
class Stage:
    """One stage: seconds so far, the solver's steps and the last one's worst violation."""

    name: str
    start: float
    seconds: float = 0.0
    steps: int = 0
    violation: float | None = None

    @property
    def line(self) -> str:
        """How it stands; a violation of 1 is what is allowed."""
        line = f"{self.name:<{WIDTH}}{self.seconds:6.1f} s"
        if self.violation is not None:
            line += f"   step {self.steps}, worst violation {self.violation:.3g} × allowed"
        return line


class Stages:
    """Prints the stages of a job to `out`, in place where that is a terminal."""

    def __init__(self, out: TextIO) -> None:
        self.out = out
        self.live = out.isatty()
        self.began = time.monotonic()
        self.done: list[Stage] = []
        self._current: Stage | None = None

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """A stage, such as "Fitting the physics"."""
        self._current = Stage(name, time.monotonic())
        self._show(self._current)
        end = "   failed\n"
        try:
            yield
            end = "\n"
        finally:
            stage, self._current = self._current, None
            self._show(stage, end)
            self.done.append(stage)

    def step(self, step: Step, _motion: Motion) -> None:
        """Notes a step of the solver in the stage that runs."""
        if self._current is not None:
            self._current.steps += 1
            self._current.violation = step.violation
            self._show(self._current)

    def ended(self, violation: float) -> None:
        """Notes where the solver's last step led; a step itself tells where it began."""
        if self._current is not None:
            self._current.violation = violation

    def as_json(self) -> list[dict[str, object]]:
        """Every stage that has ended: name, seconds, and the solver's iterations where it ran."""
        return [
            {"name": s.name, "seconds": s.seconds} | ({"iterations": s.steps} if s.steps else {})
            for s in self.done
        ]

    @property
    def total(self) -> float:
        """Seconds since the job began."""
        return time.monotonic() - self.began

    def _show(self, stage: Stage, end: str = "") -> None:
        stage.seconds = time.monotonic() - stage.start
        if self.live:
            self.out.write(f"\r\x1b[K{stage.line}{end}")
        elif end:
            self.out.write(f"{stage.line}{end}")
        self.out.flush()
