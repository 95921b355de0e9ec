"""Limits of the validation: each figure's name, unit, what it must reach and what it aims at."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import mean, median

from .contacts import EventKind
from .forces import FORWARD, LEFT, UP
from .result import Measured, TrialResult


@dataclass(frozen=True)
class ValidationLimit:
    """Upper bound that a figure must keep, and the one that is aimed at; None: only told."""

    unit: str
    must: float | None = None
    aim: float | None = None


RATIO_MEAN = "vertical rms at 15 Hz over plain differentiation's, mean"
RATIO_WORST = "vertical rms at 15 Hz over plain differentiation's, worst trial"
LIMITS = {
    RATIO_MEAN: ValidationLimit("1", 0.85, 0.65),
    RATIO_WORST: ValidationLimit("1", 1.0, 0.85),
    "vertical rms at 15 Hz, mean": ValidationLimit("BW", 0.128, 0.10),
    "forward rms at 15 Hz, mean": ValidationLimit("BW", 0.065, 0.05),
    "sideways rms at 15 Hz, mean": ValidationLimit("BW", 0.038, 0.03),
    "walk: vertical rms at 15 Hz": ValidationLimit("BW", 0.06),
    "total variation of the vertical over the plates', mean": ValidationLimit("1", 1.15, 1.05),
    "largest step within 2 ms": ValidationLimit("BW", 0.15, 0.05),
    "touch-down and lift-off: median": ValidationLimit("ms", 5.0, 3.0),
    "touch-down and lift-off: worst mean of a trial": ValidationLimit("ms", 15.0, 10.0),
    "touch-downs and lift-offs not found": ValidationLimit("1"),
    "centre of pressure, mean": ValidationLimit("cm"),
    "loaded point: slide": ValidationLimit("mm", 5.0, 1.0),
    "loaded point: under its surface": ValidationLimit("mm", 5.0, 1.0),
    "loaded point: above its surface": ValidationLimit("mm", 10.0, 3.0),
    "jerk of hands at touch-down, fit over recording, worst": ValidationLimit("1"),
    "knee, peak torque": ValidationLimit("N·m/kg"),
    "joint centres, rms, worst trial": ValidationLimit("cm", 1.6, 1.2),
    "joint centres, first and last ten frames, worst": ValidationLimit("cm", 2.5, 1.5),
    "trials refused": ValidationLimit("1", 0.0, 0.0),
}


@dataclass(frozen=True)
class ValidationFigure:
    """One figure over all trials. trial: the worst one, empty where it is of all of them."""

    name: str
    value: float
    unit: str
    must: float | None
    aim: float | None
    ok: bool
    trial: str


def figures(results: Sequence[TrialResult]) -> list[ValidationFigure]:
    """Every figure that these trials give."""
    return [_figure(name, value, trial) for name, value, trial in _found(results)]


def _figure(name: str, value: float, trial: str) -> ValidationFigure:
    limit = LIMITS[name]
    ok = limit.must is None or bool(value <= limit.must)
    return ValidationFigure(name, float(value), limit.unit, limit.must, limit.aim, ok, trial)


def _found(results: Sequence[TrialResult]) -> Iterator[tuple[str, float, str]]:
    """Name, value and trial. A walk counts by its own error, and for its contacts and motion."""
    every = [(r.trial, r.measured) for r in results if r.measured]
    walks = [(r.trial, r.measured) for r in results if r.measured and r.kind == "walk"]
    fast = [each for each in every if each not in walks]
    if fast:
        yield from _forces(fast)
    if walks:
        vertical, where = max((m.error().ours[UP], trial) for trial, m in walks)
        yield "walk: vertical rms at 15 Hz", vertical, where
    if every:
        yield from _contacts(every)
        yield from _motions(every)
    yield "trials refused", len(results) - len(every), ""


Trials = Sequence[tuple[str, Measured]]


def _forces(fast: Trials) -> Iterator[tuple[str, float, str]]:
    errors = [(trial, m.error()) for trial, m in fast]
    ratios = [(e.ours[UP] / e.baseline[UP], trial) for trial, e in errors]
    yield RATIO_MEAN, mean(ratio for ratio, _ in ratios), ""
    yield RATIO_WORST, *max(ratios)
    for axis, index in (("vertical", UP), ("forward", FORWARD), ("sideways", LEFT)):
        yield f"{axis} rms at 15 Hz, mean", mean(e.ours[index] for _, e in errors), ""
    name = "total variation of the vertical over the plates', mean"
    yield name, mean(m.total_variation[0] / m.total_variation[1] for _, m in fast), ""


def _contacts(every: Trials) -> Iterator[tuple[str, float, str]]:
    late = [e.late_ms for _, m in every for e in m.events]
    found = [abs(each) for each in late if each is not None]
    if found:
        yield "touch-down and lift-off: median", median(found), ""
        means = [
            (abs(each), trial)
            for trial, m in every
            for kind in EventKind
            if (each := m.mean_late(kind)) is not None
        ]
        yield "touch-down and lift-off: worst mean of a trial", *max(means)
    yield "touch-downs and lift-offs not found", len(late) - len(found), ""
    apart = [m.pressure.distance_cm for _, m in every if m.pressure]
    if apart:
        yield "centre of pressure, mean", mean(apart), ""


def _motions(every: Trials) -> Iterator[tuple[str, float, str]]:
    yield "largest step within 2 ms", *max((m.steps[0].jump, trial) for trial, m in every)
    yield "loaded point: slide", *max((m.hold.slide_mm, trial) for trial, m in every)
    yield "loaded point: under its surface", *max((m.hold.under_mm, trial) for trial, m in every)
    yield "loaded point: above its surface", *max((m.hold.above_mm, trial) for trial, m in every)
    jerks = [(m.hand_jerk.ratio, trial) for trial, m in every if m.hand_jerk]
    if jerks:
        yield "jerk of hands at touch-down, fit over recording, worst", *max(jerks)
    yield "knee, peak torque", *max((m.torques_per_kg.knee, trial) for trial, m in every)
    near = [(m.closeness, trial) for trial, m in every]
    yield "joint centres, rms, worst trial", *max((c.whole_cm, trial) for c, trial in near)
    ends = [(max(c.first_cm, c.last_cm), trial) for c, trial in near]
    yield "joint centres, first and last ten frames, worst", *max(ends)
