"""What the doctor must reach."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.doctor.finding import FindingKind
from .measure import Examined

NOISE = "30 Hz, 3 mm and 1° noise"
ANY = "size × 1.6"  # no ratio of units
# A fall tells a size half as well as a clock, and half of the clips have falls of 0.2 s or less.
KNOWN_ANY = 5.0


@dataclass(frozen=True)
class DoctorFigure:
    """One figure over all clips. must, aim: bounds, lower ones where `least`. where: the worst.

    known: what a must that is not reached yet must not pass meanwhile.
    """

    name: str
    value: float
    unit: str
    must: float
    aim: float
    where: str = ""
    least: bool = False
    known: float | None = None

    @property
    def ok(self) -> bool:
        """Whether it keeps what it must."""
        return self.value >= self.must if self.least else self.value <= self.must

    @property
    def missed(self) -> bool:
        """Whether it misses what it must, and not as is known."""
        if self.ok or self.known is None:
            return not self.ok
        return self.value < self.known if self.least else self.value > self.known


def figures(examined: Sequence[Examined]) -> list[DoctorFigure]:
    """Every figure that these give."""
    clean = [each for each in examined if each.kind is None]
    damaged = [each for each in examined if each.kind is not None]
    alarms = [each for each in clean if each.false]
    made = [
        DoctorFigure(
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
        DoctorFigure(
            *("damages named rightly (recall)", 100.0 * right / len(damaged), "%", 90.0, 98.0),
            f"{len(missed)} of {len(damaged)} missed",
            least=True,
        ),
        DoctorFigure(
            *("findings that are right (precision)", 100.0 * right / (right + false), "%"),
            *(90.0, 98.0),
            f"{false} others",
            least=True,
        ),
    ]
    for words, alike, known in (
        ("time scale", [e for e in damaged if e.kind is FindingKind.TIME_SCALE], None),
        (
            "wrong unit",
            [e for e in damaged if e.kind is FindingKind.SIZE and e.damage != ANY],
            None,
        ),
        (ANY, [e for e in damaged if e.damage == ANY], KNOWN_ANY),
    ):
        told = [(100.0 * e.scale_error, e) for e in alike if e.scale_error is not None]
        if told:
            worst, where = max(told, key=lambda pair: pair[0])
            middle = round(float(np.median([error for error, _ in told])), 6)
            at = f"worst {worst:.1f}: {where.clip}, {where.damage}"
            name = f"{words}: recovered, off by (median)"
            made.append(DoctorFigure(name, middle, "%", 3.0, 1.0, at, known=known))
    noisy = [100.0 * each.after for each in damaged if each.damage == NOISE]
    if noisy:
        name = "joint centres off after noise was smoothed (mean)"
        made.append(DoctorFigure(name, float(np.mean(noisy)), "cm", 2.5, 1.5))
    return made
