"""What the doctor must reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...solver.doctor.finding import FindingKind
from ..figures.limits import WorstFigure
from .measure import Examined

NOISE = "30 Hz, 3 mm and 1° noise"
ANY = "size × 1.6"  # no ratio of units


def figures(examined: Sequence[Examined]) -> list[WorstFigure]:
    """Every figure that these give."""
    clean = [each for each in examined if each.kind is None]
    damaged = [each for each in examined if each.kind is not None]
    alarms = [each for each in clean if each.false]
    made = [
        WorstFigure(
            *("false alarms on clean clips", len(alarms), "1", 0, 0),
            ", ".join(f"{each.clip}: {', '.join(each.false)}" for each in alarms),
        )
    ]
    if not damaged:
        return made
    missed = [each for each in damaged if not each.found]
    right = len(damaged) - len(missed)
    false = sum(len(each.false) for each in damaged)
    made += [
        WorstFigure(
            *("damages named rightly (recall)", 100.0 * right / len(damaged), "%", 90.0, 98.0),
            f"{len(missed)} of {len(damaged)} missed",
            least=True,
        ),
        WorstFigure(
            *("findings that are right (precision)", 100.0 * right / (right + false), "%"),
            *(90.0, 98.0),
            f"{false} others",
            least=True,
        ),
    ]
    for words, alike in (
        ("time scale", [e for e in damaged if e.kind is FindingKind.TIME_SCALE]),
        ("wrong unit", [e for e in damaged if e.kind is FindingKind.SIZE and e.damage != ANY]),
        (ANY, [e for e in damaged if e.damage == ANY]),
    ):
        told = [(100.0 * e.scale_error, e) for e in alike if e.scale_error is not None]
        if told:
            worst, where = max(told, key=lambda pair: pair[0])
            middle = round(float(np.median([error for error, _ in told])), 6)
            at = f"worst {worst:.1f}: {where.clip}, {where.damage}"
            name = f"{words}: recovered, off by (median)"
            made.append(WorstFigure(name, middle, "%", 3.0, 1.0, at))
    noisy = [100.0 * each.after for each in damaged if each.damage == NOISE]
    if noisy:
        name = "joint centres off after noise was smoothed (mean)"
        made.append(WorstFigure(name, float(np.mean(noisy)), "cm", 2.5, 1.5))
    return made
