"""State machine of a solve that the artist waits for, with its progress text; without Blender."""

from dataclasses import dataclass
from enum import Enum

from ...solver.data.row_kinds import RowKind
from ...solver.worker.protocol import Progress

STAGES = {
    "fit": "fitting the physics",
    "refine": "refining",
    "adapt": "adapting",
    "bounds": "checking in between",
    "explicit": "minimizing effort",
    "examine": "looking for faults",
}


# What is furthest off has a name of the artist's, or is one of the laws of motion.
LAWS = {RowKind.BALANCE.label: "the body's travel", RowKind.MOMENT.label: "the body's spin"}


class SolveState(Enum):
    """States of a solve."""

    READING = "reading the recording"
    SOLVING = "starting"
    STOPPING = "taking the motion as it stands"
    CHECKING = "checking for changes"
    WRITING = "writing keyframes"
    PREPARING = "preparing the drag"
    ENDED = "done"


MOST_TOLD = 1000.0  # times what is allowed
CHECKING, WRITING = 0.9, 0.95  # shares of the whole at which these begin


@dataclass
class Solving:
    """A solve under way. Whoever runs it tells what happens; what cannot happen now raises
    ValueError, for it would be a mistake of ours. of, label: the operator that runs it, and what
    its button says. analysed: what an analysis found is written, and more is to come. written: the
    result is shown, and is looked at and finished. reads: the share of the whole that reading the
    recording is."""

    of: str = ""
    state: SolveState = SolveState.READING
    progress: Progress | None = None
    label: str = "The work"
    analysed: bool = False
    written: bool = False
    reads: float = 0.05
    _part: float = 0.0  # of the current state

    def advance(self, to: SolveState) -> None:
        """The next part begins."""
        order = list(SolveState)
        if order.index(to) <= order.index(self.state):
            raise ValueError(f"{to.name} after {self.state.name}")
        self.state, self._part = to, 0.0

    def did(self, part: float) -> None:
        """So much of the current state's work, 0 to 1, is done; or of its longest piece."""
        self._part = max(self._part, part)

    def again(self) -> None:
        """The analysis is written, and a solve begins after it."""
        self.state, self.progress, self.analysed = SolveState.READING, None, True
        self._part = 0.0

    def heard(self, progress: Progress) -> None:
        """The worker told of a step, or of how far it is."""
        if self.state not in (SolveState.SOLVING, SolveState.STOPPING):
            raise ValueError(f"a step while {self.state.value}")
        self.progress = progress
        self.did(progress.share)

    @property
    def can_stop(self) -> bool:
        """True while the motion as it stands can be asked for."""
        return self.state is SolveState.SOLVING

    def stop(self) -> None:
        """The artist takes the motion as it stands."""
        if not self.can_stop:
            raise ValueError(f"stopped while {self.state.value}")
        self.state = SolveState.STOPPING

    @property
    def has_result(self) -> bool:
        """Whether what it has changed stays when it is ended: a step to undo."""
        return self.analysed or self.written or self.state is SolveState.PREPARING

    @property
    def cancelled(self) -> str:
        """What is told where the artist ends it."""
        if self.state is SolveState.PREPARING:
            return f"{self.state.value.capitalize()} was cancelled; what {self.label} found is kept"
        left = "the new contacts are kept" if self.analysed else "nothing was changed"
        if self.written:
            left = "the result is kept as it is"
        return f"{self.label} was cancelled while {self.doing}; {left}"

    @property
    def share(self) -> float:
        """Of the whole, 0 to 1."""
        match self.state:
            case SolveState.READING:
                begin, end = 0.0, self.reads
            case SolveState.SOLVING | SolveState.STOPPING:
                begin, end = self.reads, CHECKING
            case SolveState.CHECKING:
                begin, end = CHECKING, WRITING
            case SolveState.WRITING | SolveState.PREPARING:
                begin, end = WRITING, 1.0
            case SolveState.ENDED:
                return 1.0
        return begin + (end - begin) * self._part

    def passes(self, event: str) -> bool:
        """True for events ("Z", "LEFTMOUSE") that go on to Blender.

        Nearly all do, so that playback, selection and saving go on; while keys are being written
        an undo would pull the action away from under them.
        """
        return self.state is not SolveState.WRITING or event.startswith(("MOUSEMOVE", "WINDOW"))

    @property
    def doing(self) -> str:
        """The current activity."""
        if self.state is SolveState.SOLVING and self.progress is not None:
            return STAGES.get(self.progress.stage, self.progress.stage)
        return self.state.value

    @property
    def text(self) -> str:
        """Stage, percent and the worst constraint, where there is one."""
        parts = [f"{self.doing}, {100.0 * self.share:.0f} %"]
        told = self.progress if self.state is SolveState.SOLVING else None
        if told is not None and told.worst:
            worst = LAWS.get(told.worst, told.worst)
            parts.append(f"furthest off: {worst} ({_times(told.violation)} allowed)")
        return ", ".join(parts)


def _times(violation: float) -> str:
    """A violation over its tolerance, without exponents."""
    if violation >= MOST_TOLD:
        return f"over {MOST_TOLD:.0f} ×"
    return f"{violation:.0f} ×" if violation >= 10.0 else f"{violation:.1f} ×"
