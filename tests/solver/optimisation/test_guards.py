"""Which guards are in the way: those whose rows pull, and none where nothing does."""

from dataclasses import replace

import numpy as np
from hangtime.solver.human.human_guard import RangeLeft, recorded_ranges
from hangtime.solver.optimisation.guards import in_the_way
from hangtime.solver.optimisation.sqp import FeasibleSet
from hangtime.solver.transcription.guard_rows import GuardRows
from hangtime.tests.helpers.toy_problems import metric, stood


def kept(beyond: dict[str, float]) -> tuple[set[str], tuple[str, ...]]:
    """What is in the way of a valid motion whose joints all keep to ranges that they are in, but
    for those, rad beyond; and the joints' names."""
    motion, ranges = stood(), recorded_ranges(stood())
    names, count = tuple(each.name for each in ranges), len(ranges)
    items, times = np.arange(count), np.full(count, 0.5 * motion.duration)
    function = RangeLeft(ranges, items, np.ones(count, dtype=bool))
    t = motion.transcription
    loose = replace(t, guards=(GuardRows(names, items, times, np.zeros(count), function),))
    left = loose.guard_rows(motion.x).value
    lower = left - 0.1 + np.array([0.1 + beyond[n] if n in beyond else 0.0 for n in names])
    tight = replace(t, guards=(GuardRows(names, items, times, lower, function),))
    return in_the_way(FeasibleSet(tight, motion.places), metric(motion), motion.x), names


def test_nothing_is_in_the_way_of_a_motion_that_keeps_to_all() -> None:
    assert kept({})[0] == set()


def test_the_joint_that_is_beyond_its_range_is_in_the_way() -> None:
    for name in kept({})[1]:
        assert kept({name: 0.2})[0] == {name}
