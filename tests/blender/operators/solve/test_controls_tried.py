"""What poses bones beside keys is tried once: controls for a recording, constraints for a solve."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.controls.missed.held import LOOKS
from hangtime.bridge.controls.posing import Posing
from hangtime.operators.solve import adapt
from hangtime.solver.data.faults import HeldBones

pytestmark = pytest.mark.usefixtures("_enabled")


def test_controls_are_tried_again_only_for_another_recording(
    analysed: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = []

    def posable(*told: object) -> Iterator[None]:
        tried.append(told)
        yield
        return True

    monkeypatch.setattr(adapt, "beside_keys", lambda _: True)
    monkeypatch.setattr(adapt, "require_posable", posable)

    def ask() -> None:
        recording = complete(adapt.read_wanted(analysed))
        complete(adapt.require_writable(analysed, recording, (80.0, 320.0)))

    ask()
    ask()
    assert len(tried) == 1
    all_curves(current_action(analysed))[0].keyframe_points[100].co.y += 0.1
    ask()
    assert len(tried) == 2


def test_what_constraints_hold_is_sought_once_and_in_parts(
    jump: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For neck and head, and for all the rest, at few frames, with the artist's window going on."""
    limit = jump.pose.bones["LeftUpLeg"].constraints.new("LIMIT_ROTATION")
    limit.owner_space, limit.use_limit_x, limit.max_x = "LOCAL", True, -0.5
    looks = jump.pose.bones["Head"].constraints.new("LIMIT_ROTATION")
    looks.owner_space, looks.use_limit_y, looks.min_y, looks.max_y = "LOCAL", True, 0.3, 0.3
    recording, gone_to, go_to = complete(adapt.read_wanted(jump)), [], Posing.go_to

    def counted(self: Posing, frame: float) -> None:
        gone_to.append(frame)
        go_to(self, frame)

    monkeypatch.setattr(Posing, "go_to", counted)
    parts = adapt.require_writable(jump, recording, (80.0, 320.0))
    next(parts)
    assert 0 < len(gone_to) < LOOKS
    with pytest.raises(HeldBones) as refused:
        complete(parts)
    assert refused.value.bones == ("LeftUpLeg",)
    assert gone_to == sorted(set(gone_to))
    assert len(gone_to) == LOOKS
