"""All results of a run: pairs, figures over them, and what the performer's own jumps tell."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from .compare import ComparedPair, FailedPair
from .jump_measures import JumpMeasures
from .limits import FAR, MEASURES, NULL, PairsFigure, figures
from .moved import MovedLanding


@dataclass(frozen=True)
class OwnJump:
    """A performer's own jump: how far its feet go, m, and the measures of its fit."""

    name: str
    distance: float
    measures: JumpMeasures


@dataclass(frozen=True)
class Results:
    """Results of a run; the first solution is the one that is judged."""

    solutions: tuple[str, ...]
    pairs: tuple[ComparedPair, ...]
    failed: tuple[FailedPair, ...]
    figures: tuple[PairsFigure, ...]
    jumps: tuple[OwnJump, ...]
    landings: tuple[MovedLanding, ...]

    @classmethod
    def of(
        cls,
        solutions: tuple[str, ...],
        pairs: Sequence[ComparedPair | FailedPair],
        distances: Mapping[str, float],
        landings: Sequence[MovedLanding],
    ) -> "Results":
        """Results of pairs. distances: of the jumps, m."""
        compared = tuple(pair for pair in pairs if isinstance(pair, ComparedPair))
        fits = {pair.source: pair.before for pair in compared}
        return cls(
            solutions,
            compared,
            tuple(pair for pair in pairs if isinstance(pair, FailedPair)),
            tuple(f for solution in solutions for f in figures(compared, solution)),
            tuple(OwnJump(n, distances[n], fits[n]) for n in distances if n in fits),
            tuple(landings),
        )

    def moved(self, solution: str) -> list[ComparedPair]:
        """The pairs of two jumps by a solution."""
        return [p for p in self.pairs if p.solution == solution and not p.to_itself]

    def near(self, solution: str) -> list[ComparedPair]:
        """Those that land within `NULL` of each other: two takes of one jump."""
        return [pair for pair in self.moved(solution) if abs(pair.further) < NULL]

    def far(self, solution: str) -> list[ComparedPair]:
        """Those whose landing moves by `FAR` or more."""
        return [pair for pair in self.moved(solution) if abs(pair.further) >= FAR]

    def missed(self) -> list[PairsFigure]:
        """Figures of the first solution that are not as they must be."""
        return [f for f in self.figures if not f.ok and f.solution == self.solutions[0]]

    def by_name(self) -> dict[str, list[PairsFigure]]:
        """The figures by name, one a solution."""
        found: dict[str, list[PairsFigure]] = {}
        for figure in self.figures:
            found.setdefault(figure.name, []).append(figure)
        return found

    def write(self, path: Path) -> None:
        """figures.json."""
        content = {
            "measures": {name: words[:2] for name, words in MEASURES.items()},
            "figures": [_as_json(figure) for figure in self.figures],
            "jumps": [asdict(jump) for jump in self.jumps],
            "moved landings": [asdict(each) for each in self.landings],
            "pairs": [pair.record() for pair in self.pairs],
            "failed": [asdict(pair) for pair in self.failed],
        }
        path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _as_json(figure: PairsFigure) -> dict[str, object]:
    """JSON knows no infinity."""
    limits = {"must": figure.must, "aim": figure.aim}
    finite = {name: None if math.isinf(x[1]) else list(x) for name, x in limits.items()}
    return asdict(figure) | finite | {"ok": figure.ok}
