"""A result as a new slot of its take's own action."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action, shown_range, source_of
from hangtime.bridge.action_slots import alone, home_of
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import recorded_action, show, showing_action
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.keys_digest import keys_digest
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.exports.export import export_takes
from hangtime.bridge.files.reimport import reimport
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.look_again import look_again
from hangtime.bridge.results.made import note_made
from hangtime.bridge.results.start import start_from_result
from hangtime.bridge.rows.choices import WrittenAs
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.takes import derive, takes_of
from hangtime.bridge.takes.write_result import (
    lay_in_slot,
    require_slot,
    write_adapted_incrementally,
)
from hangtime.solver.data.faults import NoNewSlot
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(1.0, 25.0, 0.5)
OPTIONS = ResultOptions(blend_in=4.0, blend_out=4.0, written_as=WrittenAs.SLOT)
LATER = 6  # frames by which the result is longer

pytestmark = pytest.mark.usefixtures("_enabled")
with_slots = pytest.mark.skipif(
    bpy.app.version < (4, 5), reason="actions have no slots before Blender 4.4"
)


def lifted(armature: bpy.types.Object, by: float, *, later: int = 0) -> bpy.types.Action:
    """Write the middle of the take anew, so much higher, and longer by some frames, into a slot."""
    with showing_action(armature, recorded_action(armature)):
        part = read_recording(armature).window(10, 14)
    bones = [part.index(bone) for bone in rigs.MOVING]
    last = 14 + later
    rows = np.interp(np.arange(10.0, last + 1.0), [10, last], [0, 4]).round().astype(int)
    track = PoseTrack(
        np.arange(10.0, last + 1.0),
        rigs.MOVING,
        part.rotations[rows][:, bones],
        part.heads[rows, bones[0]] + [0.0, 0.0, by],
    )
    motion = AdaptedMotion(track, TimeMap((10.0, 14.0), (10.0, float(last))), None, OPTIONS)
    action, written = complete(write_adapted_incrementally(armature, motion))
    with_a_key_each = sample(armature, FRAMES).matrices
    lay_in_slot(armature, source_of(action), action)
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, with_a_key_each)
    note_made(armature, action, written.span, written.later)
    return action


def slots(action: bpy.types.Action) -> list[str]:
    return [slot.name_display for slot in action.slots]


@with_slots
def test_the_result_is_a_slot_and_the_take_beside_it_is_as_it_was(
    armature: bpy.types.Object,
) -> None:
    take, before = current_action(armature), sample(armature, FRAMES).matrices
    keys, span, names = keys_digest(take), shown_range(armature, take), slots(take)
    result = lifted(armature, 0.1, later=LATER)
    assert current_action(armature) == result
    assert armature.animation_data.action == take
    assert slots(take) == [*names, result.name]
    assert recorded_action(armature) == take
    assert np.abs(sample(armature, FRAMES).matrices - before).max() > 0.05
    assert (keys_digest(take), shown_range(armature, take)) == (keys, span)
    assert shown_range(armature, result)[1] == span[1] + LATER
    show(armature, take)
    assert sample(armature, FRAMES).matrices.tobytes() == before.tobytes()  # to the bit
    assert current_action(armature) == take
    show(armature, result)
    assert armature.animation_data.action_slot.name_display == result.name


def duplicate(armature: bpy.types.Object, *, linked: bool = False) -> bpy.types.Object:
    """A copy of a character: with its own action (Shift-D), or linked to the same (Alt-D)."""
    bpy.ops.object.select_all(action="DESELECT")
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.duplicate(linked=linked)
    return bpy.context.view_layer.objects.active


@with_slots
def test_a_copied_character_has_a_slot_and_a_result_of_its_own(armature: bpy.types.Object) -> None:
    result, shown = lifted(armature, 0.1), sample(armature, FRAMES).matrices
    copy = duplicate(armature)
    action = copy.animation_data.action
    assert action != armature.animation_data.action
    own = copy.hangtime.adapted
    assert own not in (None, result)
    assert [take.action for take in takes_of(copy)] == [action, own]
    assert recorded_action(copy) == action
    np.testing.assert_array_equal(sample(copy, FRAMES).matrices, shown)
    show(copy, action)
    assert copy.animation_data.action_slot.name_display != result.name
    assert current_action(armature) == result
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, shown)


@with_slots
def test_a_copied_result_gives_back_what_its_own_recording_has_no_keys_for(
    armature: bpy.types.Object,
) -> None:
    take, path = current_action(armature), 'pose.bones["finger"].scale'
    lifted(armature, 0.1)
    copy = duplicate(armature)
    action, own = copy.animation_data.action, current_action(copy)
    of_original = fcurves.holder_in(take, fcurves.slot_identifier(armature))
    for curves in (of_original, fcurves.holder_in(own, None)):
        fcurves.ensured(curves, path, 1, "").keyframe_points.insert(10.0, 1.5)
    bpy.context.scene.frame_set(10)
    assert copy.pose.bones["finger"].scale.y == pytest.approx(1.5)
    show(copy, action)
    assert copy.pose.bones["finger"].scale.y == pytest.approx(1.0)


@with_slots
def test_a_copied_character_has_its_slots_results_whatever_came_after_them(
    armature: bpy.types.Object,
) -> None:
    take = current_action(armature)
    keys = keys_digest(take)
    lifted(armature, 0.1)
    later = alone(take)
    derive(later, take, armature)
    armature.hangtime.adapted = later
    show(armature, take)
    copy = duplicate(armature)
    action = copy.animation_data.action
    first, second = takes_of(copy)
    assert (first.action, home_of(second.action)[0]) == (action, action)
    assert keys_digest(action) == keys


@with_slots
def test_a_copied_character_has_no_results_of_one_with_the_same_recording(
    armature: bpy.types.Object,
) -> None:
    theirs = lifted(armature, 0.1)
    other = duplicate(armature, linked=True)
    show(other, recorded_action(other))
    names = slots(current_action(other))
    own = lifted(other, 0.2)
    copy = duplicate(other)
    action = copy.animation_data.action
    assert [take.action for take in takes_of(copy)] == [action, copy.hangtime.adapted]
    assert slots(action) == [*names, own.name]  # an artist's copy would lose keys else
    assert theirs.name in names


@with_slots
def test_the_take_read_while_its_result_is_shown_is_the_take(armature: bpy.types.Object) -> None:
    before = sample(armature, FRAMES).matrices
    result = lifted(armature, 0.1)
    shown = sample(armature, FRAMES).matrices
    with showing_action(armature, recorded_action(armature)):
        assert sample(armature, FRAMES).matrices.tobytes() == before.tobytes()
    assert current_action(armature) == result
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, shown)


@with_slots
def test_results_in_slots_are_takes_that_tell_polish_and_what_is_stale(
    armature: bpy.types.Object,
) -> None:
    take = current_action(armature)
    first, second = lifted(armature, 0.1), lifted(armature, 0.2)
    look_again(armature)
    assert [(t.action, t.stale, t.polished) for t in takes_of(armature)[1:]] == [
        (first, "", False),
        (second, "", False),
    ]
    fcurves.scale_keys(fcurves.curves_of(armature)[0], 1.0, 1.5)  # of the second's slot
    look_again(armature)
    assert [t.polished for t in takes_of(armature)] == [False, False, True]
    show(armature, take)
    fcurves.scale_keys(fcurves.curves_of(armature)[0], 1.0, 1.5)
    look_again(armature)
    assert [bool(t.stale) for t in takes_of(armature)] == [False, True, True]


@with_slots
def test_a_result_is_built_upon_and_gone_when_it_is_discarded(armature: bpy.types.Object) -> None:
    take, names = current_action(armature), slots(current_action(armature))
    bpy.context.scene.hangtime.armature = armature
    first = lifted(armature, 0.1)
    low = sample(armature, FRAMES).matrices
    start_from_result(armature, first)
    second = lifted(armature, 0.1)
    assert slots(take) == [*names, first.name, second.name]
    assert source_of(second) == first
    at = np.flatnonzero(FRAMES == 12.0)[0]
    rise = (sample(armature, FRAMES).matrices - low)[at, 0, :3, 3]
    np.testing.assert_allclose(rise, (0.0, 0.0, 0.1), atol=1e-6)
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert (slots(take), current_action(armature)) == ([*names, first.name], first)
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert (slots(take), current_action(armature)) == (names, take)


@with_slots
def test_a_result_whose_slot_was_deleted_is_gone_and_the_take_is_chosen_again(
    armature: bpy.types.Object,
) -> None:
    take, before = current_action(armature), sample(armature, FRAMES).matrices
    bpy.context.scene.hangtime.armature = armature
    lifted(armature, 0.1)
    take.slots.remove(armature.animation_data.action_slot)
    assert [each.action for each in takes_of(armature)] == [take]
    with pytest.raises(RuntimeError, match="uses no slot of its action"):
        bpy.ops.hangtime.analyze()
    with pytest.raises(RuntimeError, match="Nothing has been adapted yet"):
        bpy.ops.hangtime.compare()
    assert bpy.ops.hangtime.show_take(action=take.name) == {"FINISHED"}
    np.testing.assert_array_equal(sample(armature, FRAMES).matrices, before)


@with_slots
def test_a_result_is_gone_with_the_action_that_held_its_slot(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.armature = armature
    lifted(armature, 0.1)
    bpy.data.actions.remove(armature.animation_data.action)
    for each in (bpy.ops.hangtime.compare, bpy.ops.hangtime.discard):
        with pytest.raises(RuntimeError, match="Nothing has been adapted yet"):
            each()


@with_slots
def test_slots_are_results_after_the_file_was_saved_and_opened(
    armature: bpy.types.Object, tmp_path: Path
) -> None:
    name, shown = lifted(armature, 0.1).name, sample(armature, FRAMES).matrices
    path = str(tmp_path / "slots.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    (again,) = bpy.data.objects
    result = current_action(again)
    assert result.name == name
    assert home_of(result)[0] == source_of(result) == again.animation_data.action
    np.testing.assert_array_equal(sample(again, FRAMES).matrices, shown)


@with_slots
def test_a_file_for_engines_holds_the_slot_by_the_results_name(
    armature: bpy.types.Object, tmp_path: Path
) -> None:
    take, whole = current_action(armature), FRAMES[::2]
    result = lifted(armature, 0.1)
    shown = read_recording(armature)
    show(armature, take)
    path = tmp_path / "slot.fbx"
    export_takes(armature, [result], path)
    again = reimport(path, whole)
    columns = [again.index(bone.name) for bone in shown.bones]
    np.testing.assert_allclose(again.heads[:, columns], shown.heads, atol=5e-5)
    assert current_action(armature) == take
    assert path.read_bytes().count(b"\x00\x01AnimStack") == 1
    assert result.name.encode() in path.read_bytes()


@pytest.mark.skipif(bpy.app.version >= (4, 4), reason="actions have slots since Blender 4.4")
def test_before_there_were_slots_it_says_so(armature: bpy.types.Object) -> None:
    with pytest.raises(NoNewSlot):
        require_slot(armature)
