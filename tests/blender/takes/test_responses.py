"""What controls do to bodies, measured and corrected; and which a motion needs."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.controls.choice import all_responses, moved_by_controls
from hangtime.bridge.controls.needed import Effects, needed
from hangtime.bridge.controls.posing import Posing
from hangtime.tests.blender.helpers.ik_rig import ik_rig

pytestmark = pytest.mark.usefixtures("_enabled")
SHIFT = 0.05  # Blender units, far from a small one: the leg bends


def test_a_step_corrects_what_it_showed_and_nothing_that_does_not_follow() -> None:
    rig = ik_rig()
    posing = Posing(rig, ["hips", "stand.L"], ["thigh.L", "shin.L", "shin.R"])
    with posing.kept():
        posing.go_to(1.0)
        bases, before = posing.bases(), posing.look()
        found = all_responses(posing, bases, moved_by_controls(posing, bases) > 0.0)
        rise = next(d for d, dof in enumerate(found.dofs) if dof.control == 1 and dof.shifts)
        step = np.eye(len(found.dofs))[rise] * SHIFT
        posing.pose(1, found.dofs[rise].applied(bases[1], SHIFT))
        after = posing.look()
    corrected = found.corrected(found.columns(before, bases), before, step, after)
    seen = after.bodies[:, :3, 3] - before.bodies[:, :3, 3]
    told, first = (
        np.tensordot(step, each.columns(before, bases).shifts, 1) for each in (corrected, found)
    )
    assert np.linalg.norm(first[1] - seen[1]) > 1e-4  # the leg does not bend in proportion
    np.testing.assert_allclose(told[1], seen[1], atol=1e-6)
    others = [d for d in range(len(found.dofs)) if d != rise]
    np.testing.assert_array_equal(corrected.shifts[others], found.shifts[others])
    np.testing.assert_array_equal(corrected.shifts[~found.follow], 0.0)


def test_what_moves_nothing_in_common_is_tried_at_once_and_answers_as_it_does_alone() -> None:
    rig = ik_rig()
    posing = Posing(rig, ["stand.L", "stand.R", "chest"], ["shin.L", "shin.R", "hand.L"])
    with posing.kept():
        posing.go_to(1.0)
        bases = posing.bases()
        moved = moved_by_controls(posing, bases) > 0.0
        at_once = all_responses(posing, bases, moved)
        alone = all_responses(posing, bases, np.ones_like(moved))
    assert not (moved[0] & moved[1]).any()
    assert at_once.dofs == alone.dofs
    for name in ("turns", "shifts"):
        np.testing.assert_allclose(getattr(at_once, name), getattr(alone, name), atol=1e-4)
    np.testing.assert_array_equal(at_once.follow, alone.follow)
    np.testing.assert_array_equal(at_once.moved, alone.moved)


@pytest.mark.parametrize("unit", [1.0, 1e-12])
def test_as_many_dofs_are_kept_as_the_bodies_have(unit: float) -> None:
    """Of a tiny armature a metre of a control moves bodies by 1e12 m."""
    random = np.random.default_rng(0)
    wanted = np.linalg.qr(random.normal(size=(12, 9)))[0].T
    done = random.normal(size=(40, 9)) @ wanted / unit
    kept = needed([[dof] for dof in range(40)], [Effects(done, wanted)])
    assert len(kept) == 9
    assert np.linalg.matrix_rank(done[kept]) == 9
