"""Monotonic progress fraction of a solve, 0 to 1, from its steps."""

from dataclasses import dataclass, field
from math import log

from ..optimisation.sqp import Step

# What each stage's end is worth; those that come later are worth the rest, ever less.
ENDS = {"fit": 0.5, "refine": 0.6, "adapt": 0.9, "bounds": 0.95, "explicit": 0.97}
STAGES_PER_SPAN = 3.0  # a stage of steps begun again counts as another third of what is left


@dataclass
class ProgressFraction:
    """Monotonic progress fraction. The logarithm of a stage's violation falls roughly evenly."""

    share: float = 0.0
    _stage: str = ""
    _first: float = field(default=1.0)
    _begun: float = 0.0

    def step(self, step: Step) -> float:
        """The fraction done once this step is, which began from its violation."""
        begins_again = step.violation > self._first
        if step.stage != self._stage or begins_again:
            self._stage, self._first = step.stage, max(step.violation, 1.0)
            self._begun = self.share
        end = max(ENDS.get(step.stage, 1.0), self._begun)
        left = log(max(step.violation, 1.0)) / log(self._first) if self._first > 1.0 else 0.0
        done = self._begun + (end - self._begun) * (1.0 - left) * (1.0 - 1.0 / STAGES_PER_SPAN)
        self.share = max(self.share, done)
        return self.share
