"""The controls of a rig are tried once for a recording."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature.incremental import complete
from hangtime.operators.solve import adapt

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
