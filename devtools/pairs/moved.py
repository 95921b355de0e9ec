"""Landings moved by round distances: what ours change, both ways, with nobody to compare with."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from ...solver.arrays import FloatArray
from .jobs import SolvedJump, SolvedSource
from .jump_frame import JumpFrame
from .jump_measures import JumpMeasures

FORWARD = (-0.2, -0.1, 0.1, 0.2, 0.3)  # m along the jump


@dataclass(frozen=True)
class MovedLanding:
    """A source whose landing was moved by `forward` m. status: of its solve."""

    source: str
    solution: str
    forward: float
    status: str
    before: JumpMeasures
    after: JumpMeasures

    def change(self, measure: str) -> float:
        """How much a measure changed."""
        return float(getattr(self.after, measure) - getattr(self.before, measure))


def moved_name(forward: float) -> str:
    """Of such a target."""
    return f"landing {forward:+g} m"


def moved_offsets(frame: JumpFrame, distances: Iterable[float]) -> dict[str, FloatArray]:
    """By target, (3,) m, world."""
    return {moved_name(forward): forward * frame.axes[:, 0] for forward in distances}


def moved_landings(
    solved: Mapping[str, SolvedSource], solutions: Iterable[str]
) -> list[MovedLanding]:
    """Those that were solved, of every source for which they were asked."""
    kinds = [(solution, forward) for solution in solutions for forward in FORWARD]
    found = []
    for name, source in solved.items():
        for solution, forward in kinds:
            ours = source.adapted.get((moved_name(forward), solution))
            if isinstance(ours, SolvedJump) and isinstance(source.fit, SolvedJump):
                before, after = source.fit.measures, ours.measures
                found.append(MovedLanding(name, solution, forward, ours.status, before, after))
    return found
