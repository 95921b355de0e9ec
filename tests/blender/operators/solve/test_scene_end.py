"""The scene's last frame, where results of two armatures are longer than their recordings."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.scene.played_end import play_longer, play_what_is_left
from hangtime.bridge.takes.takes import derive
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import curves_of

pytestmark = pytest.mark.usefixtures("_enabled")

END = 50
MADE = {"A": 60, "B": 70}  # the last frames of the results


@pytest.fixture
def _figures() -> None:
    """Two recordings of 50 frames, played to their end."""
    rigs.reset()
    bpy.context.scene.frame_end = END
    for name in MADE:
        rigs.animate(rigs.make_armature(name=name), frames=(1, END))


def make(name: str, last: int) -> bool:
    """A result of an armature, by the recording's name and its own last frame. Whether the scene is
    longer by it."""
    armature = bpy.data.objects[name]
    recorded = armature.animation_data.action
    result = recorded.copy()
    result.name, result.use_fake_user = f"{name} {last}", True
    derive(result, recorded, armature)
    for curve in curves_of(armature, result):
        curve.keyframe_points[-1].co.x = last
        curve.update()
    return play_longer(bpy.context.scene, armature, result)


def discard(name: str, last: int) -> None:
    bpy.data.actions.remove(bpy.data.actions[f"{name} {last}"])
    play_what_is_left(bpy.data.objects[name])


def same(_path: Path) -> None:
    """Nothing between."""


def loaded(path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(path / "two.blend"))
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(path / "two.blend"))


def undone(_path: Path) -> None:
    """A discard of both, undone."""
    bpy.ops.ed.undo_push(message="before")
    for name, last in MADE.items():
        discard(name, last)
    bpy.ops.ed.undo_push(message="discarded")
    assert bpy.context.scene.frame_end == END
    assert bpy.ops.ed.undo() == {"FINISHED"}


@pytest.mark.parametrize("meanwhile", [same, loaded, undone])
@pytest.mark.parametrize("longer_last", [True, False])
@pytest.mark.parametrize("first", MADE)
@pytest.mark.usefixtures("_figures")
def test_it_is_what_is_left_needs_and_at_last_what_it_was(
    first: str, longer_last: bool, meanwhile: Callable[[Path], None], tmp_path: Path
) -> None:
    for name in sorted(MADE, reverse=not longer_last):
        make(name, MADE[name])
    assert bpy.context.scene.frame_end == max(MADE.values())
    meanwhile(tmp_path)
    (second,) = set(MADE) - {first}
    discard(first, MADE[first])
    assert bpy.context.scene.frame_end == MADE[second]
    discard(second, MADE[second])
    assert bpy.context.scene.frame_end == END


@pytest.mark.usefixtures("_figures")
def test_it_stays_where_the_artist_has_put_it_since() -> None:
    for name, last in MADE.items():
        make(name, last)
    bpy.context.scene.frame_end = 65
    for name, last in MADE.items():
        discard(name, last)
        assert bpy.context.scene.frame_end == 65


@pytest.mark.usefixtures("_figures")
@pytest.mark.parametrize("end", [50, 55, 59])
def test_what_the_artist_set_back_is_not_lengthened_again(end: int) -> None:
    assert make("A", 60)
    bpy.context.scene.frame_end = end
    for last in (61, 62):
        assert not make("A", last)
        assert bpy.context.scene.frame_end == end
    for last in (60, 61, 62):
        discard("A", last)
        assert bpy.context.scene.frame_end == end


@pytest.mark.usefixtures("_figures")
def test_it_is_lengthened_again_once_nothing_is_left_of_what_was_set_back() -> None:
    make("A", 60)
    bpy.context.scene.frame_end = END
    assert not make("A", 61)
    discard("A", 60)
    assert not make("A", 62), "what is left was set back, too"
    for last in (61, 62):
        discard("A", last)
    assert make("A", 60)
    assert bpy.context.scene.frame_end == 60
    discard("A", 60)
    assert bpy.context.scene.frame_end == END


@pytest.mark.usefixtures("_figures")
@pytest.mark.parametrize("other", ["armature", "clip"])
def test_what_was_set_back_for_one_is_lengthened_for_another(other: str) -> None:
    make("A", 60)
    bpy.context.scene.frame_end = 58
    armature = bpy.data.objects["A"] if other == "clip" else rigs.make_armature(name="C")
    if other == "clip":
        armature.animation_data_clear()
    rigs.animate(armature, frames=(1, 58))
    assert make(armature.name, 80)
    assert bpy.context.scene.frame_end == 80


@pytest.mark.usefixtures("_figures")
def test_a_scene_that_is_made_shorter_for_another_clip_is_lengthened_again() -> None:
    make("A", 60)
    bpy.context.scene.frame_end = 40
    rigs.animate(rigs.make_armature(name="C"), frames=(1, 40))
    assert make("C", 45)
    assert bpy.context.scene.frame_end == 45


@pytest.mark.usefixtures("_figures")
@pytest.mark.parametrize("end", [50, 55])
def test_an_end_that_the_artist_put_between_two_results_is_the_one_to_go_back_to(end: int) -> None:
    make("A", 60)
    bpy.context.scene.frame_end = end
    make("B", 70)
    discard("B", 70)
    assert bpy.context.scene.frame_end == end
    discard("A", 60)
    assert bpy.context.scene.frame_end == end


@pytest.mark.usefixtures("_figures")
def test_a_result_of_what_the_scene_did_not_play_to_its_end_never_lengthens_it() -> None:
    rigs.animate(rigs.make_armature(name="C"), frames=(1, 58))
    make("C", 110)
    make("A", 60)
    make("B", 60)
    discard("B", 60)
    assert bpy.context.scene.frame_end == 60
    discard("A", 60)
    assert bpy.context.scene.frame_end == END


@pytest.mark.usefixtures("_figures")
def test_scenes_that_share_a_character_and_end_alike_go_along() -> None:
    bpy.ops.scene.new(type="LINK_COPY")
    alike = bpy.context.scene
    bpy.ops.scene.new(type="LINK_COPY")
    other = bpy.context.scene
    other.frame_end = 40
    bpy.ops.scene.new(type="LINK_COPY")
    bpy.context.scene.frame_end = END
    make("A", 60)
    assert [each.frame_end for each in (bpy.context.scene, alike, other)] == [60, 60, 40]
    discard("A", 60)
    assert [each.frame_end for each in (bpy.context.scene, alike, other)] == [END, END, 40]


@pytest.mark.usefixtures("_figures")
def test_a_scene_that_goes_along_keeps_the_end_that_it_had() -> None:
    bpy.ops.scene.new(type="LINK_COPY")
    other = bpy.context.scene
    other.frame_end = 60  # the artist's
    bpy.ops.scene.new(type="LINK_COPY")
    bpy.context.scene.frame_end = END
    make("A", 60)
    make("A", 70)
    assert [each.frame_end for each in (bpy.context.scene, other)] == [70, 70]
    for last in (60, 70):
        discard("A", last)
    assert [each.frame_end for each in (bpy.context.scene, other)] == [END, 60]
