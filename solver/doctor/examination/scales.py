"""A wrong size, a wrong clock, or both, told by the height and the falls of a recording."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...analysis.performance import Performance
from ..falls import Trusted, find_scale, refined
from ..finding import Finding, FindingKind
from ..footing import unseen_places
from ..repairs import Repairs


def find_scales(
    performed: Callable[[Repairs], Performance], trusted: Trusted
) -> tuple[Finding, ...]:
    """performed: the recording with repairs. trusted: the falls that tell a clock.

    Where the fall does not fit a person's size, the clock is wrong too, as after an import without
    scale and frame rate: then neither remedy does without the other, and there is none instead.
    """
    scale, falling = _scale_at(performed, Repairs(), trusted)
    if scale is None or scale.kind is not FindingKind.SIZE or scale.remedy is None:
        return () if scale is None else (scale,)
    # Where soles begin and how high feet are lifted is told best at the right size.
    scale = refined(scale, performed(scale.remedy), falling)
    clock, _ = _scale_at(performed, scale.remedy or Repairs(), trusted)
    if clock is None:
        return (scale,)
    return replace(scale, alternative=None), replace(clock, alternative=None)


def _scale_at(
    performed: Callable[[Repairs], Performance], placed: Repairs, trusted: Trusted
) -> tuple[Finding | None, Trusted]:
    """A wrong scale of the recording that is placed so, and the falls that tell it: at the clock
    that they tell, what is carried unseen shows that it is no fall."""
    scale = find_scale(performed(placed), trusted)
    if scale is None or scale.remedy is None or not scale.frames:
        return scale, trusted
    carried = unseen_places(performed(placed.joined(scale.remedy)))
    trusted = replace(trusted, but=(*trusted.but, *carried))
    return find_scale(performed(placed), trusted), trusted
