"""What the doctor must reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...solver.doctor.finding import FindingKind
from ..figures.limits import WorstFigure
from .fits import NOISE, WITHOUT_FLIGHT, FittedClip
from .measure import Examined

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


def fit_figures(fitted: Sequence[FittedClip]) -> list[WorstFigure]:
    """Every figure of the fits."""
    failed = [each for each in fitted if not each.valid]
    valid = 100.0 * (1.0 - len(failed) / len(fitted))
    where = "; ".join(f"{each.clip}, {each.damage or 'clean'}" for each in failed)
    made = [WorstFigure("fits that end with a valid motion", valid, "%", 100.0, 100.0, where, True)]
    noisy = [each for each in fitted if each.valid and each.damage == NOISE]
    grounded = [each for each in fitted if each.valid and each.damage == WITHOUT_FLIGHT]
    if noisy:
        off = 100.0 * float(np.mean([each.off_original for each in noisy]))
        worst = max(noisy, key=lambda each: each.slides)
        made += [
            WorstFigure(f"{NOISE}: joint centres off (mean)", off, "cm", 2.5, 1.5),
            WorstFigure(
                f"{NOISE}: sliding left", 1000.0 * worst.slides, "mm", 5.0, 1.0, worst.clip
            ),
        ]
    if grounded:
        worst = max(grounded, key=lambda each: each.off_fitted)
        name, off = f"{WITHOUT_FLIGHT}: joint centres off (worst)", 100.0 * worst.off_fitted
        made.append(WorstFigure(name, off, "cm", 2.5, 1.5, worst.clip))
    return made
