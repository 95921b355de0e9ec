"""Figures over all pairs, and what each must reach and aims at."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .compare import ComparedPair

FAR = 0.10  # m; pairs whose landing moves by as much are told apart
NULL = 0.02  # m; pairs whose landing moves by less should change nothing
ANY = -math.inf, math.inf


@dataclass(frozen=True)
class PairsLimit:
    """Least and largest value that a figure must have, and those that are aimed at."""

    unit: str
    must: tuple[float, float] = ANY
    aim: tuple[float, float] = ANY


MEASURES = {  # of a jump: words, unit, and the least change of which a share says anything
    "crouch_cm": ("crouch", "cm", 1),
    "take_off_speed": ("take-off up", "m/s", 0.05),
    "forward_speed": ("take-off forward", "m/s", 0.05),
    "lean_cm": ("lean at take-off", "cm", 1),
    "reach_cm": ("reach at landing", "cm", 1),
    "apex_cm": ("apex", "cm", 1),
    "flight_time_ms": ("flight time", "ms", 10),
    "arm_swing_deg": ("arm swing", "°", 5),
    "push_time_ms": ("push time", "ms", 10),
    "peak_push_bw": ("peak push", "BW", 0.1),
}
TIMES = PairsLimit("1", (0.5, 1.2), (0.8, 1.1))
AMPLITUDES = PairsLimit("1", (0.3, 1.2), (0.6, 1.2))
ARMS = PairsLimit("1", (0.3, 1.2), (0.7, 1.2))
LONGER = PairsLimit("1", (0.45, 1.2), (0.8, 1.2))
TOLD = PairsLimit("1")
SLOPES = {
    "crouch_cm": AMPLITUDES,
    "take_off_speed": TIMES,
    "flight_time_ms": TIMES,
    "arm_swing_deg": ARMS,
}
PERCENT = PairsLimit("%")
NEARER = PairsLimit("%", (90.0, 100.0), (95.0, 100.0))
GAIN = PairsLimit("%", (10.0, 100.0), (30.0, 100.0))
NULLS = {
    "crouch_cm": PairsLimit("cm", (0.0, 0.5), (0.0, 0.0)),
    "flight_time_ms": PairsLimit("ms", (0.0, 5.0), (0.0, 0.0)),
}


@dataclass(frozen=True)
class PairsFigure:
    """A number over `count` pairs by a solution. value: None where no pair tells it."""

    name: str
    value: float | None
    unit: str
    must: tuple[float, float]
    aim: tuple[float, float]
    count: int
    solution: str

    @property
    def ok(self) -> bool:
        """Whether it is as it must be; what nothing tells is not judged."""
        return self.value is None or self.must[0] <= self.value <= self.must[1]


def figures(pairs: Sequence[ComparedPair], solution: str) -> Iterator[PairsFigure]:
    """Every figure of the pairs of one solution."""
    mine = [pair for pair in pairs if pair.solution == solution]
    moved = [pair for pair in mine if not pair.to_itself]
    far = [pair for pair in moved if abs(pair.further) >= FAR]
    longer = [pair for pair in moved if pair.further >= FAR]

    def tell(
        name: str, value: float | None, limit: PairsLimit, over: Sequence[ComparedPair]
    ) -> PairsFigure:
        return PairsFigure(name, value, limit.unit, limit.must, limit.aim, len(over), solution)

    for measure, (words, _, _) in MEASURES.items():
        limit = SLOPES.get(measure, TOLD)
        yield tell(f"{words}: slope", slope(moved, measure), limit, moved)
        yield tell(f"{words}: slope, 10 cm or more", slope(far, measure), limit, far)
        if measure == "crouch_cm":
            words = f"{words}: slope, longer by 10 cm or more"
            yield tell(words, slope(longer, measure), LONGER, longer)
    for phase in ("crouch", "flight", "landing"):
        judged = phase != "landing"
        for words, some in (("", moved), (", 10 cm or more", far)):
            gains = [pair.gain(phase) for pair in some]
            nearer = 100.0 * float(np.mean([g > 0.0 for g in gains])) if gains else None
            mean = 100.0 * float(np.mean(gains)) if gains else None
            name = f"joint centres, {phase}{words}"
            yield tell(f"{name}: nearer than slid", nearer, NEARER if judged else PERCENT, some)
            yield tell(f"{name}: mean gain", mean, GAIN if judged else PERCENT, some)
    own = [pair for pair in mine if pair.to_itself]
    near = [pair for pair in moved if abs(pair.further) < NULL]
    for words, some in (("own landing", own), ("landing within 2 cm", near)):
        for measure, limit in NULLS.items():
            worst = max((abs(pair.found_change(measure)) for pair in some), default=None)
            yield tell(f"null pairs, {words}: {MEASURES[measure][0]}, worst", worst, limit, some)


def slope(pairs: Sequence[ComparedPair], measure: str) -> float | None:
    """Least-squares slope through the origin of the found change by the person's; 1 is all."""
    found = np.array([pair.found_change(measure) for pair in pairs])
    person = np.array([pair.persons_change(measure) for pair in pairs])
    squared = float(person @ person)
    return float(found @ person) / squared if squared > 0.0 else None


@dataclass(frozen=True)
class WithDistance:
    """Changes of a measure in proportion to how much further the landing is, least squares.

    person, ours: change per metre. share: of the squares of the person's changes that this
    explains; it is also the slope that so good a prediction would have.
    """

    person: float
    ours: float
    share: float


def with_distance(pairs: Sequence[ComparedPair], measure: str) -> WithDistance | None:
    """What distance alone tells of a measure; None where no landing or no measure differs."""
    person = np.array([pair.persons_change(measure) for pair in pairs])
    found = np.array([pair.found_change(measure) for pair in pairs])
    further = np.array([pair.further for pair in pairs])
    squares, changes = float(further @ further), float(person @ person)
    if min(squares, changes) <= 0.0:
        return None
    told = float(person @ further)
    return WithDistance(
        told / squares, float(found @ further) / squares, told**2 / squares / changes
    )
