"""State machine of a solve that the artist waits for, with its progress text; without Blender."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from ...solver.data.row_kinds import RowKind
from ...solver.worker.protocol import Progress
from .pace import Pace

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
SOLVES_S = 5.0  # what a solve is expected to last, until it tells
MOST_LOOKS = 3.0  # at each frame; a piece that has lasted longer is what its state takes long for


@dataclass
class Solving:
    """A solve under way. Whoever runs it tells what happens; what cannot happen now raises
    ValueError, for it would be a mistake of ours. of, label: the operator that runs it, and what
    its button says. analysed: what an analysis found is written, and more is to come. written: the
    result is shown, and is looked at and finished. looks: how often each state that is to come
    looks at every frame, where reading the recording does so once: by this it is known early what
    share of the whole each is."""

    of: str = ""
    state: SolveState = SolveState.READING
    progress: Progress | None = None
    label: str = "The work"
    analysed: bool = False
    written: bool = False
    looks: Mapping[SolveState, float] = field(default_factory=dict)
    pace: Pace = field(default_factory=Pace)
    _reads_s: float = 0.0  # what reading the recording lasts: the longest piece before a solve

    def advance(self, to: SolveState) -> None:
        """The next part begins."""
        order = list(SolveState)
        if order.index(to) <= order.index(self.state):
            raise ValueError(f"{to.name} after {self.state.name}")
        self._begin(to)

    def _begin(self, state: SolveState) -> None:
        self.state = state
        self.pace.next_part()

    def did(self, part: float) -> None:
        """So much of a piece of the current state's work, 0 to 1, is done."""
        if part <= 0.0:
            return
        piece = self.pace.lasts(part)
        if self.state in (SolveState.READING, SolveState.CHECKING):
            self._reads_s = max(self._reads_s, piece)
        order = list(SolveState)
        to_come = order[order.index(self.state) + 1 :]
        later = sum(self.looks.get(state, 0.0) for state in to_come) * self._reads_s
        later += SOLVES_S * (self.state is SolveState.READING)
        tells = part * piece > MOST_LOOKS * self._reads_s  # how long its state takes, too
        own = 0.0 if tells else self.looks.get(self.state, 0.0) * self._reads_s
        self.pace.expect(piece, own, later)

    def again(self) -> None:
        """The analysis is written, and a solve begins after it."""
        self.progress, self.analysed = None, True
        self._begin(SolveState.READING)

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
        """Of the whole, 0 to 1, by the time that it takes."""
        return 1.0 if self.state is SolveState.ENDED else self.pace.share

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
