"""The scene's clock: frames that are stretched in time, and results of another frame rate."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.operators.drag.follow_mixin import FollowedDrag
from hangtime.operators.drag.mouse import Press

STRETCHED = r"keys of frame 100 at its frame 150 .*Time Stretching.*make Old and New the same"

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def stretched(adapted: bpy.types.Object) -> bpy.types.Object:
    """Shown half as fast again as it was made; with a result that is accepted."""
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    bpy.context.scene.render.frame_map_new = 150
    return adapted


@pytest.mark.parametrize("name", ["analyze", "examine", "fit", "adapt", "update"])
def test_a_scene_that_is_stretched_in_time_is_refused(
    stretched: bpy.types.Object, name: str
) -> None:
    """What its frames show has other keys, which would be taken for a motion of other speeds."""
    shown, actions = current_action(stretched), set(bpy.data.actions)
    with pytest.raises(RuntimeError, match=STRETCHED):
        getattr(bpy.ops.hangtime, name)()
    assert (current_action(stretched), set(bpy.data.actions)) == (shown, actions)
    bpy.context.scene.render.frame_map_old = 150
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def test_a_scene_that_is_stretched_in_time_is_not_exported(
    stretched: bpy.types.Object, tmp_path: Path
) -> None:
    path = tmp_path / "jump.fbx"
    with pytest.raises(RuntimeError, match=STRETCHED):
        bpy.ops.hangtime.export(filepath=str(path))
    assert not path.exists()
    bpy.context.scene.render.frame_map_new = 100
    assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}


def test_nothing_is_dragged_in_a_scene_that_is_stretched_in_time(
    stretched: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Press, "of", lambda *_, **__: None)
    told: list[str] = []
    drag = SimpleNamespace(release_confirm=False, refuse=lambda why: told.append(why))
    FollowedDrag.invoke(drag, bpy.context, None)
    assert len(told) == 1
    assert "Time Stretching" in told[0]
