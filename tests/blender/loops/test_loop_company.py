"""Helper bones of a loop stay on the body in every repetition, wherever the travel is."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.poses import sample
from hangtime.bridge.rows.choices import LoopRoot
from hangtime.operators.words.take_text import take_lines, take_record
from hangtime.tests.blender.helpers.figures.company import ON, at, beside, take
from hangtime.tests.blender.helpers.figures.cycle import FRAMES, looped

pytestmark = pytest.mark.usefixtures("_enabled")

CLOSE = 5e-4  # m and turns: single precision, metres away


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
@pytest.mark.parametrize("root", list(LoopRoot))
def test_helper_bones_stay_on_the_body(root: LoopRoot, mode: str) -> None:
    armature = take(mode)
    was = sample(armature, FRAMES[:1])
    _, written = looped(armature, root)
    between = np.arange(FRAMES[0] - 30.0, FRAMES[-1] + 31.0)
    now = sample(armature, between)
    for helper, body in ON.items():
        off = beside(now, helper, body) - beside(was, helper, body)
        assert np.abs(off).max() < CLOSE, helper
    assert np.abs(at(now, "prop")[:, :3, 3] - at(now, "foot")[:, :3, 3]).max() > 0.1
    assert written.companions.root is None
    assert dict(written.companions.followers) == ON
    assert take_record(written)["bones_kept_on_body"] == ON
    assert any("ik_foot (foot)" in line for line in take_lines(written))


def test_a_take_without_helper_bones_says_nothing_of_them() -> None:
    armature = take(baked=False)
    _, written = looped(armature, LoopRoot.HIPS)
    assert written.companions.followers == ()
    assert take_lines(written) == []
