"""The whole body drifts or floats while its feet stand: each as the remedies before leave it."""

from __future__ import annotations

from collections.abc import Callable

from ...analysis.performance import Performance
from ..figure import Figure
from ..finding import Finding
from ..repairs import Repairs
from ..stance.floating import find_floating
from ..stance.footing import find_rise, find_sliding


def find_drifts(
    stood: Callable[[Repairs], Performance], figure: Figure, placed: Repairs
) -> list[Finding]:
    """At one speed upwards, at one along the floor, and at speeds that change.

    stood: the recording with repairs, as seen from what it stands on. placed: those that give it
    its right size and time. What floats may seem to drift at one speed, too: where its own remedy
    leaves no such drift, there is none.
    """
    steady = _steady(stood, figure, placed)
    joined = placed
    for finding in steady:
        joined = joined.joined(finding.remedy or Repairs())
    floating = find_floating(stood(joined).recording, figure)
    if floating is None:
        return steady
    assert floating.remedy is not None
    alone = find_floating(stood(placed).recording, figure)
    if alone is not None and not _steady(stood, figure, placed.joined(floating.remedy)):
        return [alone]
    return [*steady, floating]


def _steady(
    stood: Callable[[Repairs], Performance], figure: Figure, placed: Repairs
) -> list[Finding]:
    rise = find_rise(stood(placed).recording, figure)
    level = placed if rise is None else placed.joined(rise.remedy or Repairs())
    sliding = find_sliding(stood(level), figure)
    return [finding for finding in (rise, sliding) if finding is not None]
