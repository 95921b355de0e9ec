"""Size and clock, and how the body stands: each as the other leaves it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce

from ...analysis.performance import Performance
from ...data.contacts import ContactSchedule
from ..falls import Trusted
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from .scales import find_scales

LIFTING = (FindingKind.TILTED, FindingKind.RISING, FindingKind.FLOATING)
"""What moves feet that stand up and down, so that the wrong moments are taken for falls."""


@dataclass(frozen=True)
class Stance:
    """What is wrong with how the body stands. drifts: that its floor slopes, and that it drifts or
    floats. footing: on what height it stands without these, and what carries it."""

    drifts: tuple[Finding, ...]
    footing: tuple[Finding, ...]

    @property
    def level(self) -> Repairs:
        """With which feet that stand stay at one height."""
        every = (*self.drifts, *self.footing)
        return joined_remedies([finding for finding in every if finding.kind in LIFTING])


def settled(
    scales: tuple[Finding, ...],
    standing: Callable[[Repairs], Stance],
    performed: Callable[[Repairs], Performance],
    touched: Callable[[Repairs], ContactSchedule],
    trusted: Trusted,
) -> tuple[tuple[Finding, ...], Stance]:
    """Wrong scales, and how the body stands without them. scales: of the recording as it stands.
    standing: how it does so at scales; the others: see `find_scales`.

    A steady rise leaves gravity as it is, but not which moments seem to be falls: scales are sought
    anew with it repaired, and are those then, if without these it still rises.
    """
    placed = joined_remedies(scales)
    stance = standing(placed)
    level = stance.level
    if level == Repairs():
        return scales, stance

    def levelled(sought: Repairs) -> Repairs:
        """With scales that are sought, at which it rises so many times faster."""
        faster = sought.scale / placed.scale * placed.time_scale / sought.time_scale
        return sought.joined(replace(level, rise=faster * level.rise))

    anew = find_scales(
        lambda sought: performed(levelled(sought)),
        lambda sought: touched(levelled(sought)),
        trusted,
    )
    if anew == scales:
        return scales, stance
    left = standing(joined_remedies(anew))
    return (scales, stance) if left.level == Repairs() else (anew, left)


def remedy_of(finding: Finding | None) -> Repairs:
    """What it leaves undone where it has none."""
    return (finding and finding.remedy) or Repairs()


def joined_remedies(findings: Sequence[Finding]) -> Repairs:
    """All remedies together."""
    return reduce(Repairs.joined, map(remedy_of, findings), Repairs())
