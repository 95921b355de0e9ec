"""What the rigs must reach."""

from __future__ import annotations

from collections.abc import Sequence

from ..figures.limits import WorstFigure
from .result import RigResult

CONVENTIONS = 14
DIFFERENCE_MM, DIFFERENCE_AIM_MM = 10.0, 2.0
FILE_MM, FILE_AIM_MM = 1.0, 0.1
FILE_DEGREES, FILE_AIM_DEGREES = 0.1, 0.01


def figures(results: Sequence[RigResult]) -> list[WorstFigure]:
    """Every figure that these rigs give."""
    known = [r for r in results if not r.unknown]
    strange = [r for r in results if r.unknown]
    found = [
        WorstFigure(
            "conventions mapped with no hand work",
            sum(r.mapped for r in known),
            "1",
            min(CONVENTIONS, len(known)),
            min(CONVENTIONS, len(known)),
            ", ".join(r.name for r in known if not r.mapped),
            least=True,
        ),
        WorstFigure(
            "skeletons of unknown names mapped with no hand work",
            sum(r.mapped for r in strange),
            "1",
            len(strange),
            len(strange),
            ", ".join(r.name for r in strange if not r.mapped),
            least=True,
        ),
    ]
    tried = [r for r in results if r.difference_mm is not None]
    if tried:
        worst = max(tried, key=lambda r: r.difference_mm or 0.0)
        where = f"{worst.name}: {worst.joint}, frame {worst.frame:g}"
        found.append(
            WorstFigure(
                "same edit: largest difference of a joint centre",
                worst.difference_mm or 0.0,
                "mm",
                DIFFERENCE_MM,
                DIFFERENCE_AIM_MM,
                where,
            )
        )
        found += _of_files(tried)
    unsolved = [r.name for r in tried if not r.solved] + [r.name for r in results if r.failed]
    found.append(
        WorstFigure("rigs on which the edit failed", len(unsolved), "1", 0, 0, ", ".join(unsolved))
    )
    return found


def _of_files(tried: Sequence[RigResult]) -> list[WorstFigure]:
    """The worst of all rigs and formats, of places and of turns."""
    every = [(r.name, file) for r in tried for file in r.files]
    if not every:
        return []
    off = max(every, key=lambda each: each[1].mm)
    turned = max(every, key=lambda each: each[1].degrees)
    return [
        WorstFigure(
            "file round trip: largest difference of a bone's place",
            off[1].mm,
            "mm",
            FILE_MM,
            FILE_AIM_MM,
            f"{off[0]}, {off[1].name}",
        ),
        WorstFigure(
            "file round trip: largest difference of a bone's turn",
            turned[1].degrees,
            "°",
            FILE_DEGREES,
            FILE_AIM_DEGREES,
            f"{turned[0]}, {turned[1].name}",
        ),
    ]
