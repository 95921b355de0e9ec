"""Long work on the scene goes in slices, so that Blender can be used meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from hangtime.bridge.armature import incremental
from hangtime.bridge.armature.incremental import SLICE_S, complete, in_slices, one_by_one

FRAMES = np.arange(600.0)
LONG_TAKE = (0.008, 2e-4)  # s to go there or back, and a frame; 2752 frames with 319 curves
MANY_OBJECTS = (0.08, 2.5e-3)  # 2000 beside the armature


class Machine:
    """On which another action costs time to be put on, once its first frame is looked at, and off;
    counts how often it was. longest: slice, s."""

    def __init__(self, switch: float, frame: float) -> None:
        self.now = self.longest = self.switched = 0.0
        self.times, self._switch, self._frame = 0, switch, frame

    def clock(self) -> float:
        return self.now

    @contextmanager
    def showing(self) -> Iterator[None]:
        began = self.now
        self.times += 1
        yield
        self.now += self._switch
        self.switched += 2.0 * self._switch
        self.longest = max(self.longest, self.now - began)

    def look(self, frames: np.ndarray) -> np.ndarray:
        self.now += self._switch + self._frame * len(frames)
        return frames


@pytest.fixture
def machine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Machine:
    made = Machine(*request.param)
    monkeypatch.setattr(incremental, "perf_counter", made.clock)
    return made


@pytest.mark.parametrize("machine", [LONG_TAKE], indirect=True)
def test_whoever_waits_for_all_of_it_has_another_action_shown_once(machine: Machine) -> None:
    found = complete(in_slices(FRAMES, machine.look, machine.showing))

    assert machine.times == 1
    np.testing.assert_array_equal(np.concatenate(found), FRAMES)


@pytest.mark.parametrize("machine", [LONG_TAKE, MANY_OBJECTS], indirect=True)
def test_to_show_another_action_takes_little_more_time_than_what_is_seen_of_it(
    machine: Machine,
) -> None:
    slices = list(in_slices(FRAMES, machine.look, machine.showing))

    assert len(slices) == machine.times < 12  # it was 150 of many objects: four frames a slice
    going = machine.switched / machine.times
    assert machine.longest < SLICE_S + 2.0 * going + 1e-9
    assert machine.switched < 0.6 * machine.now  # first slices, which measure, are short
    assert slices[-1] == 1.0


@pytest.mark.parametrize("machine", [(0.0, 2e-4)], indirect=True)
def test_where_nothing_is_switched_a_slice_lasts_as_it_should(machine: Machine) -> None:
    list(in_slices(FRAMES, machine.look, machine.showing))

    assert SLICE_S - 2e-4 < machine.longest < SLICE_S + 1e-9


@pytest.mark.parametrize("machine", [(0.0, 0.5 * SLICE_S)], indirect=True)
def test_many_things_are_looked_at_in_parts(machine: Machine) -> None:
    """As a result's companions are, of which a face has hundreds."""

    def look(thing: int) -> int:
        machine.look(np.zeros(1))
        return 2 * thing

    slices, shares = one_by_one(range(12), look), list[float]()
    while True:
        try:
            shares.append(next(slices) or 0.0)
        except StopIteration as end:
            found = end.value
            break

    assert found == [2 * thing for thing in range(12)]
    assert len(shares) == 4
    assert shares == sorted(shares)
    assert complete(one_by_one((), look)) == []
