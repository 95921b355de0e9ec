"""Which bone of a body another bone keeps its place on, asked of hundreds of bones."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.poses import Poses
from hangtime.bridge.companions import followed
from hangtime.bridge.companions.followed import BodyAxes
from hangtime.solver.arrays import FloatArray
from hangtime.solver.numerics.rotations import axis_rotation

COUNT = 40  # frames
BODIES = ("hips", "chest", "hand", "hidden")


def moving(seed: int) -> FloatArray:
    """(T, 4, 4) of a bone that turns and goes its own way."""
    rng = np.random.default_rng(seed)
    share = np.linspace(0.0, 1.0, COUNT)
    found = np.tile(np.eye(4), (COUNT, 1, 1))
    turns = [axis_rotation(k, angle * share) for k, angle in enumerate(rng.uniform(0.5, 2.0, 3))]
    found[:, :3, :3] = turns[0] @ turns[1] @ turns[2]
    found[:, :3, 3] = share[:, None] * rng.uniform(0.5, 1.0, 3)
    return found


def body() -> BodyAxes:
    """A body of which one bone has a scale of 0 for a moment."""
    matrices = np.stack([moving(k) for k in range(len(BODIES))], axis=1)
    matrices[3, 3, :3, :3] = 0.0
    world = np.tile(np.eye(4), (COUNT, 1, 1))
    return BodyAxes.of(Poses(BODIES, (-1, 0, 1, 2), world, matrices), BODIES)


def beside(bone: int) -> FloatArray:
    """(T, 4, 4) of what keeps its place, and turn, beside a bone."""
    rest = np.eye(4)
    rest[:3, 3] = 0.3, 0.1, -0.2
    return moving(bone) @ rest


def test_a_bone_follows_the_one_on_which_it_keeps_its_place() -> None:
    axes = body()

    assert axes.names == BODIES[:3]
    assert [axes.followed(beside(k), ()) for k in range(3)] == list(BODIES[:3])
    assert axes.followed(beside(1), ("chest",)) is None  # it hangs on it


def test_what_a_scale_of_zero_hides_follows_nothing() -> None:
    own = beside(1)
    own[5, :3, :3] = 0.0

    assert body().followed(own, ()) is None
    assert body().followed(beside(3), ()) is None


def test_turns_are_compared_only_with_bodies_on_which_a_place_is_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A face has hundreds of bones with keys that follow nothing else: to compare the turns of each
    with all bodies took seconds."""
    asked, compare = [], followed.proper

    def counted(matrices: FloatArray) -> FloatArray:
        asked.append(len(matrices))
        return compare(matrices)

    monkeypatch.setattr(followed, "proper", counted)
    axes = body()

    assert all(axes.followed(moving(10 + k), ()) is None for k in range(50))
    assert asked == []
    assert axes.followed(beside(2), ()) == "hand"
    assert asked == [COUNT]
