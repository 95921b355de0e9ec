"""Pairs whose changes are known."""

from dataclasses import fields, replace

from hangtime.devtools.pairs.compare import ComparedPair
from hangtime.devtools.pairs.jump_measures import JumpMeasures

BEFORE = JumpMeasures(**{field.name: 10.0 for field in fields(JumpMeasures)})


def changed(by: float) -> JumpMeasures:
    """Every measure more by so much."""
    return JumpMeasures(**{field.name: 10.0 + by for field in fields(JumpMeasures)})


def pair(further: float, person: float, ours: float, *, target: str = "target") -> ComparedPair:
    """A pair whose person and whose adaptation change every measure by so much."""
    slid = {"crouch": 4.0, "flight": 4.0, "landing": 4.0}
    near = dict.fromkeys(slid, 1.0)
    made = ComparedPair(
        "source",
        target,
        "implicit",
        further,
        "solved",
        0.1,
        slid,
        slid,
        slid,
        near,
        BEFORE,
        changed(ours),
        changed(person),
    )
    return replace(made, ours={"crouch": 3.0, "flight": 2.0, "landing": 8.0})
