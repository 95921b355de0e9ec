"""What ends `dev.py keys` with 1."""

from hangtime.devtools.figures.limits import Figure, figure
from hangtime.devtools.keys.limits import LIMITS, RATE, missed

TURNED = "bones turned, every frame"


def found(name: str, value: float) -> Figure:
    return figure(name, value, "clip", "edit", LIMITS)


def test_more_keys_than_promised_are_a_miss() -> None:
    good, bad = found(RATE, 11.9), found(RATE, 12.1)
    assert missed([good, bad]) == [bad]


def test_single_precision_is_no_miss_and_more_is() -> None:
    assert not missed([found(TURNED, 0.20001)])
    assert missed([found(TURNED, 0.21)])
    assert not missed([found("time", 1000.0)])
