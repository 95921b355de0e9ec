"""Figures and their limits: each one's name, unit, what it must reach and what it aims at."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Limit:
    """A promise. must, aim: None where a figure is only told; at_least: the more the better."""

    unit: str
    must: float | None = None
    aim: float | None = None
    at_least: bool = False

    def holds(self, value: float) -> bool:
        """True where a value keeps the promise."""
        if self.must is None:
            return True
        return value >= self.must if self.at_least else value <= self.must


LIMITS = {
    "solved": Limit("1 = yes", 1.0, 1.0, at_least=True),
    "flight: root force not explained, rms": Limit("BW", 0.003, 0.0005),
    "flight: root force not explained, max": Limit("BW"),
    "flight: root moment not explained, rms": Limit("BW·m", 0.001, 0.0003),
    "flight: root moment not explained, max": Limit("BW·m"),
    "ground: root force not explained, rms": Limit("BW", 0.02, 0.005),
    "ground: root force not explained, max": Limit("BW"),
    "ground: root moment not explained, rms": Limit("BW·m", 0.02, 0.005),
    "ground: root moment not explained, max": Limit("BW·m"),
    "npz: flight: root force not explained, rms": Limit("BW"),
    "npz: flight: root moment not explained, rms": Limit("BW·m"),
    "npz: ground: root force not explained, rms": Limit("BW"),
    "npz: ground: root moment not explained, rms": Limit("BW·m"),
    "largest joint torque": Limit("N·m"),
    "pinned point's drift in Blender": Limit("mm", 1.0, 0.1),
    "pinned point above its place in Blender": Limit("mm", 10.0, 3.0),
    "pinned point's drift after FBX": Limit("mm", 2.0, 0.5),
    "pinned point above its place after FBX": Limit("mm", 10.0, 3.0),
    "fit to recording: joint centres, rms": Limit("cm", 2.5, 1.2),
    "fit to recording: pelvis at the apex": Limit("cm", 2.0, 0.5),
    "fit": Limit("s", 4.0, 1.0),
    "adaptation from the stored fit": Limit("s", 0.5, 0.1),
    # What a busy machine cannot lengthen: tells whether a missed time is the method's or the day's.
    "fit, processor's time": Limit("s"),
    "adaptation from the stored fit, processor's time": Limit("s"),
    "steps of the adaptation": Limit("1"),
    "IPOPT peer": Limit("s"),
    "IPOPT peer: iterations": Limit("1"),
    "IPOPT peer: worst violation over tolerance": Limit("1"),
    "IPOPT peer: distance over ours": Limit("1"),
    "times faster than the IPOPT peer": Limit("1", 5.0, 20.0, at_least=True),
}


@dataclass(frozen=True)
class Figure:
    """One measured number. clip: what it was measured on; edit: which, "fit" for the fit."""

    name: str
    value: float
    unit: str
    must: float | None
    aim: float | None
    ok: bool
    clip: str
    edit: str


@dataclass(frozen=True)
class WorstFigure:
    """One figure over all cases. must, aim: bounds, lower ones where `least`. where: the worst.

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
    def reached(self) -> bool:
        """Whether it is what is aimed at."""
        return self.value >= self.aim if self.least else self.value <= self.aim

    @property
    def missed(self) -> bool:
        """Whether it misses what it must, and not as is known."""
        if self.ok or self.known is None:
            return not self.ok
        return self.value < self.known if self.least else self.value > self.known


def figure(
    name: str, value: float, clip: str, edit: str, limits: Mapping[str, Limit] = LIMITS
) -> Figure:
    """A measured number beside its promise. Raises KeyError for a name without one."""
    limit = limits[name]
    value = float(value)
    return Figure(name, value, limit.unit, limit.must, limit.aim, limit.holds(value), clip, edit)


def table(figures: Sequence[Figure], limits: Mapping[str, Limit] = LIMITS) -> str:
    """Every figure's worst value over clips and edits, where that was, and the misses."""
    lines = [f"{'figure':58}{'worst':>10}  {'unit':8}{'must':>8}{'aim':>8}  where"]
    for name, limit in limits.items():
        mine = [f for f in figures if f.name == name]
        if not mine:
            continue
        worst = (min if limit.at_least else max)(mine, key=lambda f: f.value)
        must, aim = ("" if x is None else f"{x:g}" for x in (limit.must, limit.aim))
        where = f"{worst.clip}, {worst.edit}"
        missed = sum(not f.ok for f in mine)
        note = f"  MISSED in {missed} of {len(mine)}" if missed else ""
        lines.append(
            f"{name:58}{worst.value:10.3g}  {limit.unit:8}{must:>8}{aim:>8}  {where}{note}"
        )
    return "\n".join(lines)


def write(figures: Sequence[Figure], path: Path) -> None:
    """figures.json: a list of records."""
    records = [asdict(f) for f in figures]
    path.write_text(json.dumps(records, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
