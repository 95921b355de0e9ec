"""Progress of a batch on the terminal: counts, rate, time left, and what did not come out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from time import monotonic
from typing import TextIO

from ..records.manifest import CellPlan
from ..records.result import CellResult, State
from .reasons import told

SILENCE_S = 10.0  # between lines where there is no terminal to write in place
STILL_S = 60.0  # the same, while no cell ends


class Progress:
    """Writes to `out`, in place where that is a terminal.

    total: cells of the batch; done: how many of each state there are already.
    """

    def __init__(
        self,
        out: TextIO,
        total: int,
        done: Counter[State],
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._out, self._total, self._clock = out, total, clock
        self._counts = done.copy()
        self._began = self._last = clock()
        self._now = self._shown = 0
        self._live = out.isatty()

    def ended(self, plan: CellPlan, result: CellResult) -> None:
        """A cell has ended."""
        self._counts[result.state] += 1
        self._now += 1
        if result.state is not State.DONE:
            self.note(told(plan, result))
        self.tick(last=sum(self._counts.values()) == self._total)

    def note(self, text: str) -> None:
        """A line that stays."""
        self._out.write(f"\r\x1b[K{text}\n" if self._live else f"{text}\n")
        self._out.flush()

    def tick(self, *, last: bool = False) -> None:
        """Shows how it stands, now and then."""
        if self._live:
            self._out.write(f"\r\x1b[K{self.line()}" + ("\n" if last else ""))
            self._out.flush()
            return
        silence = STILL_S if self._now == self._shown else SILENCE_S
        if last or self._clock() - self._last >= silence:
            self._last, self._shown = self._clock(), self._now
            self.note(self.line())

    def line(self) -> str:
        """Such as "12 of 60 cells, 1 no solution; 1.5 a second, 32 s left"."""
        ended = sum(self._counts.values())
        others = [f"{n} {s.value}" for s, n in self._counts.items() if n and s is not State.DONE]
        text = ", ".join([f"{ended} of {self._total} cells", *others])
        seconds = self._clock() - self._began
        if not self._now or not seconds:
            return text
        rate = self._now / seconds
        pace = f"{rate:.1f} a second" if rate >= 1.0 else f"{1.0 / rate:.1f} s each"
        left = self._total - ended
        return f"{text}; {pace}" + (f", {duration(left / rate)} left" if left else "")


def duration(seconds: float) -> str:
    """Such as "45 s", "3 min", "2.5 h"."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
