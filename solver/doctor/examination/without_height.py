"""What is told of a recording whose hips keep one height, beside that."""

from __future__ import annotations

from collections.abc import Callable

from ...analysis.performance import Performance
from ...data.contacts import ContactSchedule
from ..falls import Trusted, find_scale
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from ..stance.footing import find_footing
from ..stance.in_place import find_in_place
from .settled import remedy_of


def find_what_is_left(
    stood: Callable[[Repairs], Performance],
    touched: Callable[[Repairs], ContactSchedule],
    height: Repairs,
) -> list[Finding]:
    """A size that nobody has, another floor, and a way along it that was left out as well. How the
    body falls, and what carries it, is reckoned, and tells nothing.

    stood: the recording as it stands with repairs, and touched: its contacts. height: the remedy
    that gives it back.
    """
    level = stood(Repairs())
    size = find_scale(level, Trusted(fewest=len(level.times) + 1))
    placed = height.joined(remedy_of(size))
    footing = find_footing(stood(placed), touched(placed))
    floor = next((each for each in footing if each.kind is FindingKind.FLOOR), None)
    in_place = find_in_place(stood(placed.joined(remedy_of(floor))))
    return [finding for finding in (size, in_place, floor) if finding is not None]
