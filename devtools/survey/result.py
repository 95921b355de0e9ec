"""What became of one edit, and of one kind of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from statistics import median


class EditEnding(Enum):
    """How an edit ended."""

    SOLVED = "solved"
    IMPOSSIBLE = "told impossible"  # by name: before the solve, or as what no body can do
    MISSED = "missed"  # the steps ended short of it, and what conflicts is named
    SKIPPED = "skipped"  # the figure lacks the part that it is about, or the recording a flight
    CRASHED = "crashed"  # an exception that is no fault in words, or no answer in its time


@dataclass(frozen=True)
class EditResult:
    """One edit of a window. seconds: of the processor for the adaptation, without the fit, and for
    the look at the recording where it failed; the clock's where nothing else runs. steps: of the
    optimiser. said: the headline, or the fault."""

    recording: str
    frames: tuple[float, float]
    edit: str
    ending: EditEnding
    seconds: float
    steps: int
    said: str

    @property
    def where(self) -> str:
        """Recording and frames."""
        return f"{self.recording} {self.frames[0]:g}-{self.frames[1]:g}"


@dataclass(frozen=True)
class KindOfEdit:
    """All edits of a kind."""

    name: str
    results: Sequence[EditResult]

    def count(self, ending: EditEnding) -> int:
        return sum(result.ending is ending for result in self.results)

    @property
    def tried(self) -> Sequence[EditResult]:
        """Those that were not skipped; all where all were."""
        kept = [each for each in self.results if each.ending is not EditEnding.SKIPPED]
        return kept or self.results

    @property
    def seconds(self) -> float:
        """The median."""
        return median(result.seconds for result in self.tried)

    @property
    def steps(self) -> float:
        """The median."""
        return median(result.steps for result in self.tried)

    @property
    def slowest(self) -> EditResult:
        """The one that took longest."""
        return max(self.results, key=lambda result: result.seconds)

    @property
    def most_steps(self) -> int:
        """The most that one of them took."""
        return max(result.steps for result in self.results)


def kinds(results: Sequence[EditResult]) -> list[KindOfEdit]:
    """In the order in which they come first."""
    names = dict.fromkeys(result.edit for result in results)
    return [KindOfEdit(name, [r for r in results if r.edit == name]) for name in names]
