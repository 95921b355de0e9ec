"""A wrong size, a wrong clock, or both, told by the height and the falls of a recording."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

from ...analysis.carried_by import agreed_rate
from ...analysis.performance import Performance, find_contacts, perform
from ...body.character import build_character
from ...data.constants import STANDARD_GRAVITY
from ...data.contacts import ContactSchedule
from ...data.recording import Recording
from ..falls import ALL, Spans, Trusted, find_scale, meets, refined
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from ..stance.footing import spans_of
from ..stance.in_place import find_in_place
from .repair import repaired

READ_HEIGHTS = (0.7, 3.0)  # m; beyond, a figure was read at a wrong scale, or is nobody's


def find_scales(
    performed: Callable[[Repairs], Performance],
    touched: Callable[[Repairs], ContactSchedule],
    trusted: Trusted,
) -> tuple[Finding, ...]:
    """performed: the recording with repairs; touched: its contacts. trusted: the falls that tell a
    clock.

    Where the fall does not fit a person's size, the clock is wrong too, as after an import without
    scale and frame rate: then neither remedy does without the other, and there is none instead.
    """
    scale, falling = _scale_at(performed, Repairs(), trusted)
    if scale is None or scale.kind is not FindingKind.SIZE or scale.remedy is None:
        scale = scale or _slow_fall(performed(Repairs()), touched(Repairs()))
        return () if scale is None else (scale,)
    # Where soles begin and how high feet are lifted is told best at the right size.
    scale = refined(scale, performed(scale.remedy), falling)
    sized = scale.remedy or Repairs()
    clock, _ = _scale_at(performed, sized, trusted)
    clock = clock or _slow_fall(performed(sized), touched(sized))
    if clock is None or clock.kind is FindingKind.SIZE:
        return (scale,)
    return replace(scale, alternative=None), replace(clock, alternative=None)


def odd_size(recording: Recording, height: float, chosen: Mapping[str, str]) -> float | None:
    """What makes a person of a figure of so many m that was read at a wrong scale, as `diagnose`
    tells it; None of others. chosen: bones by parts of the body, as in a problem."""
    if READ_HEIGHTS[0] < height < READ_HEIGHTS[1]:
        return None

    @cache
    def performed(repairs: Repairs) -> Performance:
        placed = repaired(recording, repairs, chosen)
        return perform(placed, build_character(placed, chosen=chosen))

    scales = find_scales(performed, lambda repairs: find_contacts(performed(repairs)), ALL)
    sizes = (each.remedy.scale for each in scales if each.remedy)
    return next((size for size in sizes if size != 1.0), None)


def without_unseen(
    performance: Performance, schedule: ContactSchedule, carried: Spans
) -> ContactSchedule:
    """A schedule in which nothing unseen carries where contacts do that are stated. carried: scene
    frames of these."""
    spans = spans_of(performance, schedule.unseen)
    every = zip(schedule.unseen, spans, strict=True)
    return replace(schedule, unseen=tuple(u for u, span in every if not meets(span, carried)))


def _slow_fall(performance: Performance, schedule: ContactSchedule) -> Finding | None:
    """A wrong clock by which most of the time in the air is no fall, as an analysis refuses it.
    Feet that slide below hips in place carry, though no contact is found of them."""
    rate = agreed_rate(performance, schedule)
    if rate is None or find_in_place(performance) is not None:
        return None
    factor = performance.recording.rate / rate
    places = spans_of(performance, schedule.unseen)
    remedy = Repairs(time_scale=factor)
    return Finding(
        FindingKind.TIME_SCALE, STANDARD_GRAVITY * factor**2, "m/s²", places, remedy=remedy
    )


def _scale_at(
    performed: Callable[[Repairs], Performance], placed: Repairs, trusted: Trusted
) -> tuple[Finding | None, Trusted]:
    """A wrong scale of the recording that is placed so, and the falls that tell it: at the clock
    that they tell, what is carried unseen shows that it is no fall."""
    scale = find_scale(performed(placed), trusted)
    if scale is None or scale.remedy is None or not scale.frames:
        return scale, trusted
    mended = performed(placed.joined(scale.remedy))
    carried = spans_of(mended, find_contacts(mended).unseen)
    trusted = replace(trusted, but=(*trusted.but, *carried))
    return find_scale(performed(placed), trusted), trusted
