"""The rigs' layouts, the comparison and the verdicts."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.rigs.actor import JOINTS, actor
from hangtime.devtools.rigs.layout import layouts
from hangtime.devtools.rigs.limits import figures
from hangtime.devtools.rigs.rest import rest_bones
from hangtime.devtools.rigs.result import Edited, RigResult, compared
from hangtime.devtools.rigs.table import page

GOOD = RigResult("mixamo", "Mixamo", False, 40, "Mixamo", difference_mm=1.0, solved=True)


def test_every_rig_has_each_joint_once_and_where_the_actor_has_it() -> None:
    performer = actor()
    for layout in layouts():
        assert set(layout.parts) == set(JOINTS), layout.key
        if not layout.lowered:
            heads = {bone.name: bone.head for bone in rest_bones(layout, performer)}
            for joint, bone in layout.parts.items():
                assert heads[bone] == pytest.approx(performer.at(joint), abs=1e-12)


def test_the_largest_difference_is_found_at_frames_of_both() -> None:
    centres = np.zeros((4, 2, 3))
    one = Edited(np.arange(4.0), centres, True)
    other = Edited(np.arange(1.0, 5.0), centres.copy(), True)
    other.centres[1, 1] = [0.0, 0.003, 0.004]
    assert compared(other, one, ("a", "b")) == (pytest.approx(5.0), "b", 2.0)


def test_a_rig_that_is_mapped_wrongly_misses_the_limit_by_name() -> None:
    bad = replace(GOOD, name="Unreal", wrong=("left toe: none",))
    counted = figures([GOOD, bad])[0]
    assert (counted.value, counted.ok, counted.where) == (1, False, "Unreal")
    assert "left toe: none" in page([GOOD, bad], figures([GOOD, bad]), 1.0)


def test_a_difference_beyond_the_limit_is_told_with_its_place() -> None:
    far = replace(GOOD, name="Daz", difference_mm=12.0, joint="foot.l", frame=99.0)
    worst = figures([GOOD, far])[2]
    assert not worst.ok
    assert worst.where == "Daz: foot.l, frame 99"
