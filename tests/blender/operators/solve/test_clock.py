"""The scene's clock: frames that are stretched in time, and results of another frame rate."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, present
from hangtime.bridge.results.look_again import look_again
from hangtime.operators.solve import results as results_module
from hangtime.operators.solve.results import AcceptOperator

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


@pytest.mark.usefixtures("stretched")
@pytest.mark.slow
def test_a_scene_that_is_stretched_in_time_is_not_exported(tmp_path: Path) -> None:
    path = tmp_path / "jump.fbx"
    with pytest.raises(RuntimeError, match=STRETCHED):
        bpy.ops.hangtime.export(filepath=str(path))
    assert not path.exists()
    bpy.context.scene.render.frame_map_new = 100
    assert bpy.ops.hangtime.export(filepath=str(path)) == {"FINISHED"}


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What artists are asked before Accept goes on, as in a window."""
    told: list[str] = []
    window = SimpleNamespace(invoke_confirm=lambda *_, message, **__: told.append(message))

    def there(thing: object) -> object:
        return window if isinstance(thing, bpy.types.WindowManager) else present(thing)

    app = SimpleNamespace(app=SimpleNamespace(background=False))
    monkeypatch.setattr(results_module, "bpy", app)
    monkeypatch.setattr(results_module, "present", there)
    return told


def accepted_at_once(asked: list[str]) -> bool:
    """Whether Accept accepts without asking."""
    operator, before = SimpleNamespace(execute=lambda _: None), len(asked)
    AcceptOperator.invoke(operator, bpy.context, None)
    return len(asked) == before


def _other_rate(_: bpy.types.Object) -> None:
    bpy.context.scene.render.fps *= 2


def _other_unit(_: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length *= 0.01


def _other_scale(armature: bpy.types.Object) -> None:
    armature.scale *= 3.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_other_rate, "The scene plays 240 frames a second, and this was made for 120"),
        (_other_unit, "The armature is 0.01 times as large"),
        (_other_scale, "The armature is 3 times as large"),
    ],
)
def test_a_result_that_is_no_longer_physical_is_told_and_asked_about(
    adapted: bpy.types.Object,
    change: Callable[[bpy.types.Object], None],
    words: str,
    asked: list[str],
) -> None:
    result = current_action(adapted)
    look_again(adapted)
    assert (result.hangtime.stale, accepted_at_once(asked)) == ("", True)
    change(adapted)
    bpy.context.view_layer.update()
    assert look_again(adapted)
    assert words in result.hangtime.stale
    assert not accepted_at_once(asked)
    assert words in asked[-1]


def test_a_scene_in_another_unit_with_an_armature_as_large_is_the_same(
    adapted: bpy.types.Object,
) -> None:
    bpy.context.scene.unit_settings.scale_length *= 0.01
    adapted.scale *= 100.0
    bpy.context.view_layer.update()
    look_again(adapted)
    assert current_action(adapted).hangtime.stale == ""


@pytest.mark.slow
def test_export_tells_what_is_no_longer_physical(
    adapted: bpy.types.Object, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert bpy.ops.hangtime.accept() == {"FINISHED"}
    told = f"{current_action(adapted).name}: The scene plays 240 frames a second"
    for warned in (False, True):
        assert bpy.ops.hangtime.export(filepath=str(tmp_path / "jump.fbx")) == {"FINISHED"}
        assert (told in capfd.readouterr().out) == warned
        _other_rate(adapted)
