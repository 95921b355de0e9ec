"""What is measured: every edit of `figures` and every result of `gallery`, by what they share."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

from ...solver.data.problem import MotionProblem
from ...solver.data.requests import Requests
from ..figures.clips import CLIPS, EDITS
from ..gallery.jobs import Page, load, names

CASES, RESULTS = "cases.pickle", "results.pickle"  # of a process, in its folder
QUICK = ("broad jump 116 cm, +0.3 m forward", "half_twist_right", "run_hurdle", "crate_landing")


class Source(Enum):
    """Where a case comes from."""

    FIGURES = "Edits of the figures"
    GALLERY = "Results of the gallery"
    SCENE = "Results in a scene"


@dataclass(frozen=True)
class Case:
    """An adaptation: a recording's file and a problem on it."""

    name: str
    source: Source
    clip: Path
    problem: MotionProblem

    def shares_fit(self, other: "Case") -> bool:
        """Whether both have one fit: pins and requests change none."""
        return self.clip == other.clip and _analysed(self.problem) == _analysed(other.problem)

    def solid(self, on: bool) -> MotionProblem:
        """The problem with floor and limbs solid, or not."""
        requests = self.problem.requests
        solution = replace(requests.solution, solid=on)
        return replace(self.problem, requests=replace(requests, solution=solution))


def cases() -> tuple[Case, ...]:
    """All of them. Raises SetUpError where a recording is missing."""
    edits = (
        Case(f"{clip.name}, {edit}", Source.FIGURES, clip.path, clip.problem(edit))
        for clip in CLIPS
        for edit in EDITS
    )
    results = (
        Case(name, source, result.clip, result.problem)
        for page, source in ((Page.THESIS, Source.GALLERY), (Page.SCENE, Source.SCENE))
        for name in names(page)
        for result in (load(name),)
    )
    return (*edits, *results)


def groups(chosen: Iterable[Case]) -> list[tuple[Case, ...]]:
    """Those that share a fit together, in their order."""
    found: list[tuple[Case, ...]] = []
    for case in chosen:
        mine = next((i for i, group in enumerate(found) if group[0].shares_fit(case)), None)
        if mine is None:
            found.append((case,))
        else:
            found[mine] = (*found[mine], case)
    return found


def _analysed(problem: MotionProblem) -> MotionProblem:
    return replace(problem, pins=(), requests=Requests())
