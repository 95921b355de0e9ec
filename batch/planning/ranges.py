"""Ranges in a recipe: numbers for which several values stand, and how these are combined.

forward = { from = 0.0, to = 0.8, steps = 5 }   # both ends included
forward = { from = 0.0, to = 0.8 }              # any number between; of samples alone
forward = [0.0, 0.2, 0.5]                       # these; of keys that hold a number otherwise
kind = { values = ["pca", "ica"] }              # these, of any key
turn = { from = 90, to = 180, steps = 2, both_ways = true }  # with the other sign too: -90, -180
mirrored = [false, true]        # the motion as it was recorded, and mirrored

[batch]                         # optional
combine = "product"             # every value with every other; "zip": the first with the first;
                                # "sample": drawn at random
count = 20                      # samples
seed = 1                        # the same seed draws the same samples; default: 0
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import product
from random import Random
from typing import Any

from ...bridge.recipe_syntax.items import AGAINST, TRAVEL_KEYS
from ...bridge.recipe_syntax.source_lines import KeyPath
from ...bridge.recipe_syntax.table import NumberRange, Source, Table, shown
from ..records.manifest import Value

HEADER = "batch"
# Keys of a recipe that hold one number or flag, so that a list of them can only be a range.
SINGLE = frozenset(
    (
        *(*TRAVEL_KEYS, *AGAINST, "turn", "mass", "height", "share", "gravity", "length"),
        *("thickness", "by", "at_least", "at_most", "fixed", "frame", "start_frame", "end_frame"),
        *("return_frame", "blend_in", "blend_out", "scale", "time_scale", "floor", "factor"),
        *("seconds", "slack", "wider", "cone", "friction", "explained", "dimensions", "mirrored"),
    )
)
RANGE_KEYS = ("from", "to", "steps", "values", "both_ways")
MOST_STEPS = 100_000
COUNT = NumberRange("a whole number above zero", lambda n: n >= 1.0 and n.is_integer())
STEPS = NumberRange(
    f"a whole number from 2 to {MOST_STEPS:,}", lambda n: 2.0 <= n <= MOST_STEPS and n.is_integer()
)
ANY_SEED = NumberRange("a whole number", lambda n: n.is_integer())


class Combine(Enum):
    """How the values of several ranges go together."""

    PRODUCT = "product"
    ZIP = "zip"
    SAMPLE = "sample"


@dataclass(frozen=True)
class ValueRange:
    """What stands for one key of a recipe: its values, or bounds between which it is drawn.

    values: as they are listed; a "zip" may need one twice.
    """

    place: KeyPath
    values: tuple[Value, ...] = ()
    bounds: tuple[float, float] | None = None
    both_ways: bool = False

    @property
    def distinct(self) -> tuple[Value, ...]:
        """The values, none twice."""
        return tuple(dict.fromkeys(self.values))

    def drawn(self, random: Random) -> Value:
        """A value at random."""
        if self.bounds is None:
            return self.distinct[random.randrange(len(self.distinct))]
        sign = random.choice((1, -1)) if self.both_ways else 1
        return _plain(sign * random.uniform(*self.bounds))


@dataclass(frozen=True)
class Combination:
    """What a recipe's table [batch] says."""

    combine: Combine = Combine.PRODUCT
    count: int | None = None
    seed: int = 0


def find_ranges(values: dict[str, Any], source: Source) -> list[ValueRange]:
    """Every range in a recipe's values, in their order. Raises BadRecipe."""
    top = {key: value for key, value in values.items() if key != HEADER}
    return list(_within(top, (), source))


def _within(node: object, place: KeyPath, source: Source) -> Iterator[ValueRange]:
    if isinstance(node, dict):
        if {"from", "to", "values"} & set(node):
            yield _range(Table(source, place, node, RANGE_KEYS))
            return
        for key, held in node.items():
            yield from _within(held, (*place, key), source)
    elif isinstance(node, list):
        if place and place[-1] in SINGLE:
            yield ValueRange(place, _listed(node, place, source))
            return
        for i, held in enumerate(node):
            yield from _within(held, (*place, i), source)


def _range(table: Table) -> ValueRange:
    table.not_both("values", ("from", "to", "steps"))
    both_ways = table.flag("both_ways")
    if "values" in table.values:
        values = table.values["values"]
        if not isinstance(values, list):
            table.refuse("values", f'"values" must be a list in brackets, not {shown(values)}')
        listed = _listed(values, (*table.place, "values"), table.source)
        return ValueRange(table.place, _both_ways(listed, table) if both_ways else listed)
    table.needs(("from",))
    table.needs(("to",))
    low, high, steps = table.number("from"), table.number("to"), table.number("steps", STEPS)
    assert low is not None
    assert high is not None
    if low >= high:
        why = "is empty; write the number itself" if low == high else "is reversed; swap its ends"
        table.source.refuse(table.place, f"the range from {low:g} to {high:g} {why}")
    if steps is None:
        return ValueRange(table.place, bounds=(low, high), both_ways=both_ways)
    count = int(steps)
    numbers = tuple(_plain(low + (high - low) * i / (count - 1)) for i in range(count))
    return ValueRange(table.place, _both_ways(numbers, table) if both_ways else numbers)


def _listed(values: list[Any], place: KeyPath, source: Source) -> tuple[Value, ...]:
    """Single values, at least one."""
    if not values:
        source.refuse(place, "the range is empty; write the values that it shall have")
    for i, value in enumerate(values):
        single = isinstance(value, bool | int | float | str)
        if not single or (isinstance(value, float) and not math.isfinite(value)):
            problem = f"a range holds finite numbers or words, not {shown(value)}"
            source.refuse((*place, i), problem)
    return tuple(values)


def _both_ways(values: Sequence[Value], table: Table) -> tuple[Value, ...]:
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(numbers) < len(values):
        table.refuse("both_ways", "only numbers go both ways; take that away")
    return *numbers, *(-number for number in numbers if number)


def _plain(number: float) -> float:
    """Without the digits that rounding left, such as those of 0.30000000000000004."""
    return float(f"{number:.12g}")


# ---------------------------------------------------------------- combining


def combination(values: dict[str, Any], source: Source) -> Combination:
    """How a recipe's ranges go together. Raises BadRecipe."""
    outer = Table(source, (), {HEADER: values.get(HEADER, {})}, (HEADER,))
    table = outer.table(HEADER, ("combine", "count", "seed"), "key")
    how = table.choice("combine", Combine) or Combine.PRODUCT
    count, seed = table.number("count", COUNT), table.number("seed", ANY_SEED)
    if how is Combine.SAMPLE:
        table.needs(("count",))
    elif "count" in table.values:
        table.refuse("count", '"count" is of samples; write combine = "sample", or take it away')
    return Combination(how, None if count is None else int(count), int(seed or 0))


def count_of(ranges: Sequence[ValueRange], how: Combination, source: Source) -> int:
    """How many variants there will be, before any is made. Raises BadRecipe."""
    if not ranges:
        return 1
    for each in ranges:
        if each.bounds is not None and how.combine is not Combine.SAMPLE:
            problem = 'the range has no "steps"; add them, or draw samples from it: see [batch]'
            source.refuse(each.place, problem)
    every = math.prod(len(each.distinct) for each in ranges)  # 0 where one is drawn between bounds
    match how.combine:
        case Combine.PRODUCT:
            return every
        case Combine.ZIP:
            lengths = [len(each.values) for each in ranges]
            for each, length in zip(ranges, lengths, strict=True):
                if length != lengths[0]:
                    problem = f"this range has {length} values and another {lengths[0]}; "
                    source.refuse(each.place, problem + 'ranges in a "zip" have as many each')
            return len(_zipped(ranges))
    assert how.count is not None
    if 0 < every < how.count:
        problem = f"{how.count} samples of {every} combinations; write at most {every}"
        source.refuse((HEADER, "count"), problem)
    return how.count


def variants(ranges: Sequence[ValueRange], how: Combination) -> Iterator[tuple[Value, ...]]:
    """The values of the ranges, variant by variant; one without any where there is no range."""
    match how.combine:
        case _ if not ranges:
            yield ()
        case Combine.PRODUCT:
            yield from product(*(each.distinct for each in ranges))
        case Combine.ZIP:
            yield from _zipped(ranges)
        case Combine.SAMPLE:
            yield from _samples(ranges, how)


def _zipped(ranges: Sequence[ValueRange]) -> list[tuple[Value, ...]]:
    """The first values of all, the second ones and so on, none of these twice."""
    return [*dict.fromkeys(zip(*(each.values for each in ranges), strict=True))]


def _samples(ranges: Sequence[ValueRange], how: Combination) -> Iterator[tuple[Value, ...]]:
    assert how.count is not None
    random = Random(how.seed)
    if any(each.bounds is not None for each in ranges):
        for _ in range(how.count):
            yield tuple(each.drawn(random) for each in ranges)
        return
    lists = [each.distinct for each in ranges]
    for place in _places(math.prod(map(len, lists)), how.count, random):
        yield _combination_at(place, lists)


def _places(total: int, count: int, random: Random) -> Iterable[int]:
    """So many different numbers below `total`, which no machine may be able to count to."""
    if total <= 2 * count:
        return random.sample(range(total), count)
    found: dict[int, None] = {}
    while len(found) < count:
        found[random.randrange(total)] = None
    return found


def _combination_at(place: int, lists: Sequence[tuple[Value, ...]]) -> tuple[Value, ...]:
    """The combination at a place in the product of lists, the last of which changes first."""
    chosen: list[Value] = []
    for values in reversed(lists):
        place, i = divmod(place, len(values))
        chosen.append(values[i])
    return tuple(reversed(chosen))
