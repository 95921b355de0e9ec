"""One adaptation beside the person: distances by phase, and shares of the person's change."""

from dataclasses import asdict, dataclass

from .clips import Jump
from .jobs import SolvedJump, SolvedSource
from .jump_frame import JumpFrame
from .jump_measures import JumpMeasures
from .phased_jump import PhasedJump

Distances = dict[str, float]  # cm, by phase
LEAST_CHANGE = 1e-9  # of a measure; less has no share


@dataclass(frozen=True)
class RecordedJump:
    """A jump as it was recorded."""

    jump: Jump
    frame: JumpFrame
    phases: PhasedJump
    bones: tuple[tuple[int, int], ...]  # (parent, child) joints


@dataclass(frozen=True)
class ComparedPair:
    """A source adapted to a target's landing, beside the target. changes in m and as measured.

    further: m, how much further the target lands. unchanged, slid, ours, bound: distances of the
    recording, the recording slid, the adaptation and the target's own fit to the target's
    recording. before, after, person: measures of the source's fit, ours, the target's fit.
    """

    source: str
    target: str
    solution: str
    further: float
    status: str
    seconds: float
    unchanged: Distances
    slid: Distances
    ours: Distances
    bound: Distances
    before: JumpMeasures
    after: JumpMeasures
    person: JumpMeasures

    @property
    def to_itself(self) -> bool:
        """Whether nothing was moved at all."""
        return self.source == self.target

    def found_change(self, measure: str) -> float:
        """How much ours changed of a measure."""
        return float(getattr(self.after, measure) - getattr(self.before, measure))

    def persons_change(self, measure: str) -> float:
        """How much the person changed of a measure."""
        return float(getattr(self.person, measure) - getattr(self.before, measure))

    def share(self, measure: str) -> float | None:
        """The found part of the person's change; None where the person changed nothing."""
        whole = self.persons_change(measure)
        return self.found_change(measure) / whole if abs(whole) > LEAST_CHANGE else None

    def gain(self, phase: str) -> float:
        """How much nearer to the target than the slid recording, as a share."""
        return 1.0 - self.ours[phase] / self.slid[phase]

    def record(self) -> dict[str, object]:
        """As JSON."""
        shares = {name: self.share(name) for name in asdict(self.before)}
        return asdict(self) | {"shares": shares}


@dataclass(frozen=True)
class FailedPair:
    """A pair without an adaptation, and why."""

    source: str
    target: str
    solution: str
    why: str


def compare(
    source: RecordedJump,
    target: RecordedJump,
    solution: str,
    solved: SolvedSource,
    targets_fit: SolvedJump | str,
) -> ComparedPair | FailedPair:
    """The pair's numbers; why there are none where a solve failed."""
    names = source.jump.name, target.jump.name, solution
    ours = solved.adapted.get((names[1], solution), "the source has no fit")
    for part in (solved.fit, targets_fit, ours):
        if isinstance(part, str):
            return FailedPair(*names, part)
        if not part.solved:
            return FailedPair(*names, part.status)
    assert isinstance(ours, SolvedJump)
    assert isinstance(solved.fit, SolvedJump)
    assert isinstance(targets_fit, SolvedJump)
    move = target.frame.landing - source.frame.landing
    truth = target.phases
    return ComparedPair(
        *names,
        float(move[0]),
        ours.status,
        ours.seconds,
        source.phases.distances(truth),
        source.phases.slid(move).distances(truth),
        ours.phases.distances(truth),
        targets_fit.phases.distances(truth),
        solved.fit.measures,
        ours.measures,
        targets_fit.measures,
    )
