"""A sketch tells another motion from the same one with other rounding."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.motion_sketch import Apart, MotionSketch
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.doctored import jump
from hypothesis import given
from hypothesis import strategies as st

ROUNDING = 1e-6  # m; what edit mode and back was seen to do is a quarter of it
MOVED = 5e-4  # m


def is_the_jump(recording: Recording) -> bool:
    kept = MotionSketch.from_text(MotionSketch.of(jump()).text)
    assert kept is not None
    return kept.is_near(MotionSketch.of(recording))


@given(seed=st.integers(0, 2**32 - 1))
def test_rounding_makes_no_other_motion(seed: int) -> None:
    off = np.random.default_rng(seed).uniform(-ROUNDING, ROUNDING, jump().heads.shape)
    assert is_the_jump(replace(jump(), heads=jump().heads + off))


@given(st.data())
def test_one_bone_in_one_frame_makes_another(data: st.DataObject) -> None:
    heads = jump().heads.copy()
    place = tuple(data.draw(st.integers(0, size - 1)) for size in heads.shape)
    heads[place] += MOVED
    assert not is_the_jump(replace(jump(), heads=heads))


def test_bones_frames_and_rest_count() -> None:
    motion = jump()
    first, *rest = motion.bones
    for other in (
        replace(motion, frames=motion.frames + 1.0),
        replace(motion, bones=(replace(first, name="Other"), *rest)),
        replace(motion, bones=(replace(first, tail=first.tail + MOVED), *rest)),
        motion.part(slice(1, None)),
    ):
        assert not is_the_jump(other)


def test_which_bones_are_elsewhere_is_told_with_a_frame() -> None:
    motion, heads = jump(), jump().heads.copy()
    heads[7:9, 4] += MOVED
    heads[8, 5] += 2.0 * MOVED
    kept = MotionSketch.from_text(MotionSketch.of(motion).text)
    assert kept is not None
    assert kept.apart(MotionSketch.of(replace(motion, heads=heads))) == Apart((4, 5), 8)


def test_of_an_earlier_versions_sketch_it_is_not_told() -> None:
    before = MotionSketch.from_text(MotionSketch.of(jump()).text.rpartition(" ")[0])
    assert before is not None
    assert before.is_near(MotionSketch.of(jump()))
    assert before.apart(MotionSketch.of(jump())) is None


@pytest.mark.parametrize("text", ["", "no sketch", "layout AAAA", "layout ?", "\u00e4 \u00e4"])
def test_what_is_no_sketch_is_none_or_of_no_motion(text: str) -> None:
    """As in files of earlier versions, or damaged ones."""
    sketch = MotionSketch.from_text(text)
    assert sketch is None or not sketch.is_near(MotionSketch.of(jump()))
