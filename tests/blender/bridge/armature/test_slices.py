"""Long work on the scene goes in slices, so that Blender can be used meanwhile."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter, sleep

import numpy as np
from hangtime.bridge.armature.incremental import LONGEST_SLICE_S, complete, in_slices

FRAMES = np.arange(600.0)
FRAME_S, SWITCH_S = 2e-4, 0.008  # as of a take of 2752 frames with 319 curves


class Switching:
    """Another action, which costs time to be put on and off; counts how often it was."""

    times = 0

    @contextmanager
    def __call__(self) -> Iterator[None]:
        self.times += 1
        sleep(SWITCH_S)
        yield
        sleep(SWITCH_S)


def _look(frames: np.ndarray) -> np.ndarray:
    sleep(FRAME_S * len(frames))
    return frames


def test_whoever_waits_for_all_of_it_has_another_action_shown_once() -> None:
    switching = Switching()

    found = complete(in_slices(FRAMES, _look, switching))

    assert switching.times == 1
    np.testing.assert_array_equal(np.concatenate(found), FRAMES)


def test_to_show_another_action_takes_no_more_time_than_what_is_seen_of_it() -> None:
    switching, longest, began = Switching(), 0.0, perf_counter()
    slices = in_slices(FRAMES, _look, switching)

    for _ in slices:
        longest = max(longest, perf_counter() - began)
        began = perf_counter()

    assert switching.times < 30  # it was 150: four frames a slice
    assert longest < 3.0 * LONGEST_SLICE_S  # the machine may be busy
