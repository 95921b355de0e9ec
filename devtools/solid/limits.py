"""What the solid world must reach, and the verdicts."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from ..checks.joint_ranges import JointExcess
from ..checks.penetrations import Keeper
from ..figures.limits import Limit
from .cases import Source
from .result import CaseResult, Physics

DEPTH = Limit("mm", 5.0, 1.0)
JOINTS = Limit("degrees", 3.0, 0.0)
NOT_SOLVED = Limit("1", 0.0, 0.0)
RATIO, WORST_RATIO = Limit("1", 1.6, 1.15), Limit("1")
PHYSICS = {
    "flight_force": Limit("BW", 0.003, 0.0005),
    "flight_moment": Limit("BW·m", 0.001, 0.0003),
    "ground_force": Limit("BW", 0.003, 0.0005),
    "ground_moment": Limit("BW·m", 0.001, 0.0003),
}
BENT = "joints beyond recording and human range"
# Musts that are not reached yet, each with the value that it must not pass meanwhile.
KNOWN_MISSES: dict[str, float] = {}


@dataclass(frozen=True)
class SolidFigure:
    """One figure over all cases. where: the worst case, and what and when in it.

    known: missed, but no worse than is known.
    """

    name: str
    value: float
    unit: str
    must: float | None
    aim: float | None
    ok: bool
    known: bool
    where: str


def figures(results: Sequence[CaseResult]) -> list[SolidFigure]:
    """Every figure that these cases give."""
    return [_figure(*found) for found in _found(results)]


def faults(result: CaseResult) -> list[str]:
    """What one case misses, in words."""
    if result.failed:
        return [result.failed]
    found = [] if result.solved else ["not solved"]
    for each in result.penetrations:
        if not DEPTH.holds(each.deeper_mm):
            found.append(f"{each.what} by {each.deeper_mm:.1f} mm at frame {each.frame:g}")
    joint = result.joint
    if joint and not JOINTS.holds(joint.degrees):
        found.append(f"{joint.joint} {joint.degrees:.1f}° beyond at frame {joint.frame:g}")
    for name, limit in PHYSICS.items():
        if result.physics and not limit.holds(value := getattr(result.physics, name)):
            found.append(f"{_words(name)} {value:.2g} {limit.unit}")
    return found


def _found(results: Sequence[CaseResult]) -> Iterator[tuple[str, float, Limit, str]]:
    bad = [r.name for r in results if r.failed or not r.solved]
    yield "cases not solved", len(bad), NOT_SOLVED, ", ".join(bad)
    good = [r for r in results if not r.failed]
    for keeper in Keeper:
        deep = [(p, r.name) for r in good for p in r.penetrations if p.keeper is keeper]
        if deep:
            worst, name = max(deep, key=lambda each: each[0].deeper_mm)
            where = f"{name}: {worst.what}, frame {worst.frame:g}" if worst.what else ""
            yield f"deepest new penetration, {keeper.value}", worst.deeper_mm, DEPTH, where
    yield from _worst_joint(BENT, [(r.joint, r.name) for r in good if r.joint])
    free = [r for r in good if r.source is not Source.SCENE]  # there more than a body is solid
    ratios = [(ratio, r.name) for r in free if (ratio := r.ratio) is not None]
    if ratios:
        yield "time with solids over without, median", median(x for x, _ in ratios), RATIO, ""
        yield "time with solids over without, worst", *_split(max(ratios), WORST_RATIO)
    measured = [(r.physics, r.name) for r in good if r.physics]
    for key, limit in PHYSICS.items() if measured else ():
        yield _words(key), *_split(max(_of(key, measured)), limit)


def _worst_joint(
    figure: str, bent: Sequence[tuple[JointExcess, str]]
) -> Iterator[tuple[str, float, Limit, str]]:
    if bent:
        joint, name = max(bent, key=lambda each: each[0].degrees)
        where = f"{name}: {joint.joint}, frame {joint.frame:g}" if joint.joint else ""
        yield figure, joint.degrees, JOINTS, where


def _of(key: str, measured: Sequence[tuple[Physics, str]]) -> Iterator[tuple[float, str]]:
    return ((getattr(physics, key), name) for physics, name in measured)


def _split(worst: tuple[float, str], limit: Limit) -> tuple[float, Limit, str]:
    return worst[0], limit, worst[1]


def _figure(name: str, value: float, limit: Limit, where: str) -> SolidFigure:
    ok = bool(limit.holds(value))
    known = not ok and bool(value <= KNOWN_MISSES.get(name, -math.inf))
    return SolidFigure(name, float(value), limit.unit, limit.must, limit.aim, ok, known, where)


def _words(key: str) -> str:
    return f"{key.replace('_', ': root ')} not explained, rms"
