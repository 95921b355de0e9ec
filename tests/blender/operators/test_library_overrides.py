"""Armatures that are linked from another file, and library overrides of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, snapshot
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.constraints.requests import requests_of
from hangtime.bridge.constraints.rows import free_name
from hangtime.bridge.properties.stances import active_contact
from hangtime.bridge.results.look_again import look_again
from hangtime.bridge.results.made import note_made
from hangtime.bridge.rows.phases import listed
from hangtime.bridge.takes.takes import derive, show_take

pytestmark = pytest.mark.usefixtures("_enabled")


def linked(armature: bpy.types.Object, path: Path) -> bpy.types.Object:
    """An armature linked from a library file into an empty one, active."""
    name, render = armature.name, bpy.context.scene.render
    rate = render.fps, render.fps_base
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.scene.render.fps, bpy.context.scene.render.fps_base = rate
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        wanted.objects = [name]
    (found,) = wanted.objects
    bpy.context.collection.objects.link(found)
    bpy.context.view_layer.objects.active = found
    return found


def overridden(armature: bpy.types.Object, path: Path) -> bpy.types.Object:
    """The library override of one, active."""
    override = linked(armature, path).override_create(remap_local_usages=True)
    bpy.context.view_layer.objects.active = override
    return override


def test_a_linked_armature_whose_results_would_not_be_saved_is_refused(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    linked(analysed, tmp_path / "library.blend")
    for each in (bpy.ops.hangtime.analyze, bpy.ops.hangtime.adapt, bpy.ops.hangtime.examine):
        with pytest.raises(RuntimeError, match="make a library override"):
            each()


def test_an_override_of_an_analysed_armature_is_analysed_again(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    count = len(analysed.hangtime.contacts)
    override = overridden(analysed, tmp_path / "library.blend")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert len(override.hangtime.contacts) == count
    assert override.hangtime.contacts["Left heel 2"].used


def saved_again(path: Path) -> bpy.types.Object:
    """The override, active, of a file that is saved and opened again."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.view_layer.objects.active


def contacts_of(armature: bpy.types.Object) -> list[tuple[str, float]]:
    return sorted((row.name, row.found_start) for row in listed(armature.hangtime))


def test_an_override_lets_go_of_contacts_that_only_its_library_found(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    found = contacts_of(analysed)
    stance = analysed.hangtime.stances.add()
    stance.name, stance.shifted, stance.turned = "ground 3", (0.1, 0.0, 0.0), 0.2
    extra = analysed.hangtime.contacts.add()
    extra.name, extra.point, extra.phase, extra.found_start = "Hand 1", "Hand", "ground 3", 900.0
    override = overridden(analysed, tmp_path / "library.blend")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert contacts_of(override) == found
    again = saved_again(tmp_path / "shot.blend")
    assert contacts_of(again) == found
    stance = again.hangtime.stances["ground 3"]
    assert (*stance.shifted, stance.turned) == (0.0, 0.0, 0.0, 0.0)
    assert len(again.hangtime.parts) == len({part.name for part in again.hangtime.parts})


def test_contacts_that_an_override_let_go_are_neither_chosen_nor_have_a_name(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    extra = analysed.hangtime.contacts.add()
    extra.name, extra.point, extra.phase, extra.found_start = "Hand 1", "Hand", "ground 3", 900.0
    analysed.hangtime.active_contact = len(analysed.hangtime.contacts) - 1
    override = overridden(analysed, tmp_path / "library.blend")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert active_contact(override.hangtime).name in dict(contacts_of(override))
    override.hangtime.active_contact = override.hangtime.contacts.find("Hand 1")
    assert not bpy.ops.hangtime.remove_contact.poll()
    row = override.hangtime.constraints.add()
    row.name, row.kind = free_name(override.hangtime, "Hand 1"), "LIFT"
    row.phase = "ground 2"
    row.bones.add().name = override.data.bones[-1].name
    assert row.name == "Hand 1" in requests_of(override.hangtime, override).names


@pytest.mark.slow
def test_what_is_analysed_in_the_library_later_leaves_an_overrides_own_analysis(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    library = tmp_path / "library.blend"
    analysed.property_unset("hangtime")
    override = overridden(analysed, library)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    own = dict(contacts_of(override))
    stances = [stance.name for stance in override.hangtime.stances]
    override.hangtime.stances["ground 2"].up = 0.05
    override.hangtime.constraints.add().name = "Mine"
    shot = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))

    bpy.ops.wm.open_mainfile(filepath=str(library))
    theirs = bpy.context.view_layer.objects.active
    for name in (*own, "Hand 1"):
        theirs.hangtime.contacts.add().name = name
    for name in (*stances, "ground 3"):
        theirs.hangtime.stances.add().name = name
    theirs.hangtime.stances["ground 3"].turned = 0.2
    theirs.hangtime.constraints.add().name = "Theirs"
    theirs.hangtime.analysed_contacts = "another analysis"
    bpy.ops.wm.save_mainfile()

    bpy.ops.wm.open_mainfile(filepath=str(shot))
    again = bpy.context.view_layer.objects.active
    assert contacts_of(again) == sorted(own.items())
    assert again.hangtime.stances["ground 2"].up == pytest.approx(0.05)
    assert again.hangtime.stances["ground 3"].turned == 0.0
    assert [row.name for row in again.hangtime.constraints] == ["Theirs", "Mine"]
    lists = ("hangtime.contacts", "hangtime.stances", "hangtime.constraints")
    kept = [each for each in again.override_library.properties if each.rna_path in lists]
    assert [each.rna_path for each in kept if each.operations] == [lists[-1]]  # for a resync
    again.hangtime.active_constraint = 1
    assert bpy.ops.hangtime.remove_constraint() == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert contacts_of(again) == sorted(own.items())
    assert again.hangtime.stances["ground 2"].up == pytest.approx(0.05)


def test_a_constraint_that_its_library_got_later_is_off_in_an_edit_that_lacks_it(
    jump: bpy.types.Object, tmp_path: Path
) -> None:
    library, shot = tmp_path / "library.blend", tmp_path / "shot.blend"
    jump.hangtime.constraints.add().name = "Old"
    override = overridden(jump, library)
    take = current_action(override)
    result = take.copy()
    result.use_fake_user = True
    derive(result, take, override)
    override.hangtime.adapted = result
    note_made(override, result, None, 0)
    name = result.name
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))
    bpy.ops.wm.open_mainfile(filepath=str(library))
    bpy.context.view_layer.objects.active.hangtime.constraints.add().name = "Theirs"
    bpy.ops.wm.save_mainfile()

    bpy.ops.wm.open_mainfile(filepath=str(shot))
    again, result = bpy.context.view_layer.objects.active, bpy.data.actions[name]
    look_again(again)
    assert result.hangtime.stale
    again.hangtime.adapted = None  # as where another take's edit is at work
    show_take(again, result)
    assert not again.hangtime.constraints["Theirs"].used
    look_again(again)
    assert not result.hangtime.stale


def test_a_linked_take_is_shown_though_another_one_has_its_name(
    jump: bpy.types.Object, tmp_path: Path
) -> None:
    override = overridden(jump, tmp_path / "library.blend")
    take = current_action(override)
    assert bpy.data.actions.new(take.name).name == take.name
    for name in (take.name, take.name_full):
        assert bpy.ops.hangtime.show_take(action=name) == {"FINISHED"}
        assert current_action(override) == take


def test_a_linked_take_keeps_its_name(jump: bpy.types.Object, tmp_path: Path) -> None:
    take = current_action(overridden(jump, tmp_path / "library.blend"))
    before = take.name
    take.hangtime.called = "Another"
    assert take.name == before


@pytest.mark.slow
@pytest.mark.parametrize("written_as", ["ACTION", "STRIP", "COMBINE"])
def test_an_overrides_linked_recording_is_adapted_and_its_result_saved(
    analysed: bpy.types.Object, tmp_path: Path, written_as: str
) -> None:
    library = tmp_path / "library.blend"
    armature = overridden(analysed, library)
    take, before = armature.animation_data.action, library.read_bytes()
    keys = keys_digest(take)
    assert take.library is not None
    armature.hangtime.result.written_as = written_as
    armature.hangtime.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert keys_digest(take) == keys
    frames = np.arange(140.0, 330.0, 10.0)
    result, shown = current_action(armature).name, sample(armature, frames).matrices
    mine = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=mine)
    bpy.ops.wm.open_mainfile(filepath=mine)
    again = bpy.context.view_layer.objects.active
    assert current_action(again).name == result
    np.testing.assert_array_equal(sample(again, frames).matrices, shown)
    assert bpy.ops.hangtime.compare() == {"FINISHED"}
    assert current_action(again).library is not None
    assert np.abs(sample(again, frames).matrices - shown).max() > 0.01
    assert library.read_bytes() == before


@pytest.mark.parametrize("with_settings", [True, False], ids=["set up", "a rig alone"])
def test_all_settings_of_an_override_are_there_when_its_file_is_opened_again(
    jump: bpy.types.Object, tmp_path: Path, *, with_settings: bool
) -> None:
    jump.property_unset("hangtime")
    if with_settings:  # but without the groups within them
        jump.hangtime.mass = 60.0
    assert bool(snapshot(jump)) == with_settings
    override = overridden(jump, tmp_path / "library.blend")
    ours = override.hangtime
    ours.use_range, ours.height, ours.loop.root = True, 1.6, "IN_PLACE"
    ours.result.after, ours.result.blend_in = "RETURN", 7
    ours.constraints.add().name = "Elbow"
    for _ in range(2):  # an opened file is saved as well as a new one
        mine = str(tmp_path / "shot.blend")
        bpy.ops.wm.save_as_mainfile(filepath=mine)
        saved = bpy.context.view_layer.objects.active.override_library
        paths = {each.rna_path for each in saved.properties}
        assert not paths & {"hangtime", "hangtime.result", "hangtime.result_keys", "hangtime.loop"}
        bpy.ops.wm.open_mainfile(filepath=mine)
        kept = bpy.context.view_layer.objects.active.hangtime
        assert kept.mass == (60.0 if with_settings else 70.0)
        assert (kept.use_range, kept.height) == (True, pytest.approx(1.6))
        assert (kept.result.after, kept.result.blend_in) == ("RETURN", 7)
        assert (kept.loop.root, kept.result_keys.on) == ("IN_PLACE", "EVERY_FRAME")
        assert [row.name for row in kept.constraints] == ["Elbow"]
