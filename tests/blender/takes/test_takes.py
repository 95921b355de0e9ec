"""The takes of an armature: their edits, what they are made from, and what became of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.accessors import current_action
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.actions import read_recorded, recorded_action, show
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.results.look_again import (
    EDIT_CHANGED,
    SURFACES_CHANGED,
    TAKE_CHANGED,
    look_again,
    polished_result,
)
from hangtime.bridge.results.made import adapted_spans, note_made
from hangtime.bridge.results.start import (
    start_from_recording,
    start_from_result,
    starts_from_result,
)
from hangtime.bridge.scene.surfaces_digest import ELSEWHERE
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.takes import show_take, takes_of
from hangtime.bridge.takes.write_result import write_adapted_incrementally
from hangtime.operators import operator_types
from hangtime.operators.solve import adapt as adapt_operators
from hangtime.operators.solve import watch
from hangtime.operators.solve.results import compared
from hangtime.operators.solve.session import session
from hangtime.operators.solve.takes import left_behind
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.rows import reopen
from hangtime.tests.blender.helpers.solids import add_row, make_box

OPTIONS = ResultOptions(blend_in=3.0, blend_out=3.0)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    rigs.reset()
    made = rigs.make_armature()
    rigs.animate(made, frames=range(1, 61))
    bpy.context.scene.hangtime.armature = made
    return made


def adapt(armature: bpy.types.Object, first: float, last: float, up: float) -> bpy.types.Action:
    """A result in which these frames are so much higher; with the contact that asks for it."""
    settings = armature.hangtime
    settings.contacts.clear()
    row = settings.contacts.add()
    row.name, row.at = "Left heel 1", (0.0, 0.0, up)
    part = read_recorded(armature, first, last)
    bones = [part.index(bone) for bone in rigs.MOVING]
    heads = part.heads[:, bones[0]] + [0.0, 0.0, up]
    track = PoseTrack(part.frames, rigs.MOVING, part.rotations[:, bones], heads)
    kept = adapted_spans(recorded_action(armature))
    motion = AdaptedMotion(track, TimeMap((first, last), (first, last)), None, OPTIONS, kept=kept)
    action, written = complete(write_adapted_incrementally(armature, motion))
    note_made(armature, action, written.span, written.later)
    return action


def heights(armature: bpy.types.Object, action: bpy.types.Action) -> np.ndarray:
    show(armature, action)
    return np.array([rigs.world_of(armature, "hips", f).translation.z for f in range(1, 61)])


def test_a_second_result_builds_on_the_first(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    was = heights(armature, recording)
    first = adapt(armature, 10, 20, 0.1)
    first.hangtime.accepted, first["hangtime_traces_key"] = True, "1"
    start_from_result(armature, first)
    assert starts_from_result(armature)
    assert recorded_action(armature) == first
    assert len(armature.hangtime.contacts) == 0
    second = adapt(armature, 24, 40, 0.2)
    assert first.hangtime.accepted
    assert not second.hangtime.accepted
    assert "hangtime_traces_key" not in second
    assert second.hangtime.recording == first
    assert recorded_action(armature) == first
    more = heights(armature, second) - was
    np.testing.assert_allclose(more[9:20], 0.1, atol=1e-5)
    np.testing.assert_allclose(more[23:40], 0.2, atol=1e-5)
    assert adapted_spans(second) == ((10.0, 20.0), (24.0, 40.0))
    again = adapt(armature, 24, 40, 0.3)  # from the first still
    np.testing.assert_allclose((heights(armature, again) - was)[23:40], 0.3, atol=1e-5)
    listed = [(take.action, take.source, take.depth) for take in takes_of(armature)]
    assert listed == [
        (recording, None, 0),
        (first, recording, 1),
        (second, first, 2),
        (again, first, 2),
    ]


def test_a_result_is_stale_after_a_surface_has_changed(armature: bpy.types.Object) -> None:
    lift, still = make_box("Lift"), make_box("Crate", (3.0, 0.0, 0.0))
    for frame, height in ((1, 0.0), (60, 0.3)):
        lift.location.z = height
        lift.keyframe_insert("location", frame=frame)
    for solid in (lift, still):
        add_row(armature, solid)
    first, second = (adapt(armature, 10, 20, up) for up in (0.1, 0.2))
    bpy.context.scene.frame_set(30)  # where the lift is elsewhere
    look_again(armature)
    assert (first.hangtime.stale, second.hangtime.stale) == ("", "")
    (*_, key) = curves_of(lift)[2].keyframe_points

    def change(owner: object, name: str, value: float) -> None:
        before = getattr(owner, name)
        for now, stale in ((value, SURFACES_CHANGED), (before, "")):
            setattr(owner, name, now)
            assert look_again(armature)
            assert (first.hangtime.stale, second.hangtime.stale) == (stale, stale)

    change(key.co, "y", 0.5)
    change(still.location, "x", 2.0)
    change(still.data.vertices[0].co, "z", -0.7)


def test_a_result_is_stale_after_its_armature_has_moved_among_surfaces(
    armature: bpy.types.Object,
) -> None:
    free = adapt(armature, 10, 20, 0.1)
    add_row(armature, make_box("Crate", (3.0, 0.0, 0.0)))
    among = adapt(armature, 10, 20, 0.2)
    for metres, stale in ((0.5, ELSEWHERE), (-0.5, "")):
        armature.location.x += metres
        bpy.context.view_layer.update()
        look_again(armature)
        assert (free.hangtime.stale, among.hangtime.stale) == ("", stale)


def test_where_a_take_that_keys_the_armature_puts_it_tells_nothing_of_another(
    armature: bpy.types.Object,
) -> None:
    add_row(armature, make_box("Crate", (3.0, 0.0, 0.0)))
    result, take = adapt(armature, 10, 20, 0.2), current_action(armature)
    walk = take.copy()
    show(armature, walk)
    for frame, along in ((1, 0.0), (20, 2.0)):
        armature.location.x = along
        armature.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_set(20)
    look_again(armature)
    assert result.hangtime.stale == ""


def test_the_list_of_takes_leaves_the_recordings_name_out(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    recording.name = "jump"
    first = adapt(armature, 10, 20, 0.1)
    start_from_result(armature, first)
    second = adapt(armature, 24, 40, 0.2)

    def listed() -> list[str]:
        return [take.action.hangtime.called for take in takes_of(armature)]

    assert listed() == ["jump", "adapted", "adapted 2"]
    second.hangtime.called = "adapted 2"  # as it is told already
    assert second.name == "jump adapted 2"
    first.hangtime.called = "soft landing"
    assert first.name == "soft landing"
    assert listed() == ["jump", "soft landing", "adapted 2"]


def test_results_that_were_named_or_polished_stay_in_the_file(
    armature: bpy.types.Object, tmp_path: Path
) -> None:
    take, name = current_action(armature), armature.name
    recording = take.name
    dropped, named, polished = (adapt(armature, 10, 20, up) for up in (0.1, 0.2, 0.3))
    dropped.name = "of no use"
    named.hangtime.called = "soft landing"
    point = curves_of(armature, polished)[0].keyframe_points[0]
    point.co.y += 0.1
    look_again(armature)
    show(armature, take)
    kept = polished.name
    reopen(tmp_path / "kept.blend")
    found = {take.action.name for take in takes_of(bpy.data.objects[name])}
    assert found == {recording, "soft landing", kept}


def test_a_result_is_compared_with_what_it_was_made_from(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    assert compared(armature) is None
    first = adapt(armature, 10, 20, 0.1)
    assert compared(armature) == (recording, first)
    show(armature, recording)
    assert compared(armature) == (recording, first)
    show(armature, first)
    start_from_result(armature, first)
    assert compared(armature) is None  # it would be compared with itself
    second = adapt(armature, 24, 40, 0.2)
    assert compared(armature) == (first, second)


def test_each_take_has_the_settings_it_was_made_with(armature: bpy.types.Object) -> None:
    recording, settings = current_action(armature), armature.hangtime
    first = adapt(armature, 10, 20, 0.1)
    start_from_result(armature, first)
    second = adapt(armature, 30, 40, 0.2)
    show_take(armature, first)
    assert settings.contacts[0].at[2] == pytest.approx(0.1)
    assert settings.adapted == first
    assert recorded_action(armature) == recording
    settings.contacts[0].at = (0.0, 0.0, 0.15)  # not solved yet
    show_take(armature, recording)  # belongs to the same edit
    assert settings.contacts[0].at[2] == pytest.approx(0.15)
    show_take(armature, second)
    assert settings.contacts[0].at[2] == pytest.approx(0.2)
    assert recorded_action(armature) == first
    start_from_recording(armature)
    assert settings.contacts[0].at[2] == pytest.approx(0.15)
    assert current_action(armature) == recording


def test_results_that_are_out_of_date_say_so(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    first = adapt(armature, 10, 20, 0.1)
    look_again(armature)
    assert (first.hangtime.stale, first.hangtime.polished) == ("", False)
    armature.hangtime.contacts[0].at = (0.0, 0.0, 0.3)
    look_again(armature)
    assert first.hangtime.stale == EDIT_CHANGED
    armature.hangtime.contacts[0].at = (0.0, 0.0, 0.1)
    look_again(armature)
    assert first.hangtime.stale == ""
    for asked in (True, False):
        armature.hangtime.keep_times = asked
        look_again(armature)
        assert first.hangtime.stale == (EDIT_CHANGED if asked else "")
    holder = fcurves.holder_in(recording, fcurves.slot_identifier(armature))
    holder.fcurves[0].keyframe_points[5].co.y += 0.1
    look_again(armature)
    assert first.hangtime.stale == TAKE_CHANGED


def test_what_changes_while_something_is_under_way_is_looked_at_when_that_is_over(
    armature: bpy.types.Object,
) -> None:
    first, at_work = adapt(armature, 10, 20, 0.1), SimpleNamespace(leave=lambda: None)
    armature.hangtime.contacts[0].at = (0.0, 0.0, 0.3)
    session().running.append(at_work)
    assert watch.look() == watch.DELAY
    assert first.hangtime.stale == ""
    session().running.remove(at_work)
    while watch.look() is not None:
        pass
    assert first.hangtime.stale == EDIT_CHANGED


def test_objects_count_by_what_they_are_and_not_by_their_names(armature: bpy.types.Object) -> None:
    crate, other = (bpy.data.objects.new(n, bpy.data.meshes.new(n)) for n in ("Crate", "Other"))
    surface = armature.hangtime.surfaces.add()
    surface.object = crate
    first = adapt(armature, 10, 20, 0.1)
    crate.name = "Old crate"
    other.name = "Crate"
    look_again(armature)
    assert first.hangtime.stale == ""
    surface.object = other
    look_again(armature)
    assert first.hangtime.stale == EDIT_CHANGED
    surface.object = crate
    look_again(armature)
    assert first.hangtime.stale == ""
    bpy.data.objects.remove(crate)
    look_again(armature)
    assert first.hangtime.stale == EDIT_CHANGED


def change_easing(curve: bpy.types.FCurve) -> None:
    curve.keyframe_points[4].easing = "EASE_IN"


def change_elasticity(curve: bpy.types.FCurve) -> None:
    curve.keyframe_points[4].amplitude = 3.0


def extrapolate(curve: bpy.types.FCurve) -> None:
    curve.extrapolation = "LINEAR"


def shake(curve: bpy.types.FCurve) -> None:
    curve.modifiers.new("NOISE")


def shake_more(curve: bpy.types.FCurve) -> None:
    curve.modifiers[0].strength = 2.0


@pytest.mark.parametrize(
    "change", [change_easing, change_elasticity, extrapolate, shake, shake_more]
)
def test_whatever_shapes_a_curve_of_the_take_makes_results_stale(
    armature: bpy.types.Object, change: Callable[[bpy.types.FCurve], None]
) -> None:
    holder = fcurves.holder_in(current_action(armature), fcurves.slot_identifier(armature))
    curve = holder.fcurves[0]
    curve.keyframe_points[4].interpolation = "ELASTIC"
    if change is shake_more:
        shake(curve)
    first = adapt(armature, 10, 20, 0.1)
    look_again(armature)
    assert first.hangtime.stale == ""
    change(curve)
    look_again(armature)
    assert first.hangtime.stale == TAKE_CHANGED


def test_results_are_numbered_and_the_newest_is_the_last(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    recording.name = "jump"
    for number in range(2, 12):
        adapt(armature, 10, 20, 0.01 * number)
    names = [take.action.name for take in takes_of(armature)]
    assert names == ["jump", "jump adapted", *(f"jump adapted {n}" for n in range(2, 11))]
    bpy.data.actions["jump adapted 3"].name = "zigzag"
    start_from_result(armature, bpy.data.actions["jump adapted"])
    start_from_recording(armature)  # with what was last made, and not what is last by its name
    assert armature.hangtime.adapted.name == "jump adapted 10"
    assert armature.hangtime.contacts[0].at[2] == pytest.approx(0.11)


def test_a_long_name_keeps_the_word_that_tells_results(armature: bpy.types.Object) -> None:
    current_action(armature).name = "ü" * 31
    results = [adapt(armature, 10, 20, 0.1) for _ in range(2)]
    assert [result.name.strip("ü") for result in results] == [" adapted", " adapted 2"]


def test_armatures_that_share_a_recording_list_their_own_results(
    armature: bpy.types.Object,
) -> None:
    recording = current_action(armature)
    twin = rigs.make_armature(name="Twin")
    for bone in twin.pose.bones:
        bone.rotation_mode = "QUATERNION"
    fcurves.assign(twin, recording, fcurves.slot_identifier(armature))
    first, second = adapt(armature, 10, 20, 0.1), adapt(twin, 10, 20, 0.2)
    assert [take.action for take in takes_of(armature)] == [recording, first]
    assert [take.action for take in takes_of(twin)] == [recording, second]
    show(twin, first)  # what is shown is listed, whosever it is
    assert [take.action for take in takes_of(twin)] == [recording, first, second]


def test_what_an_analysis_says_of_the_mesh_makes_no_result_stale(
    armature: bpy.types.Object,
) -> None:
    first = adapt(armature, 10, 20, 0.1)
    armature.hangtime.shapes_told = "12 of 20 bodies have the shape of Skin"
    look_again(armature)
    assert first.hangtime.stale == ""


def test_a_recipe_text_that_is_edited_makes_results_stale(armature: bpy.types.Object) -> None:
    armature.hangtime.requests = text = bpy.data.texts.new("Requests")
    first = adapt(armature, 10, 20, 0.1)
    look_again(armature)
    assert first.hangtime.stale == ""
    text.write("[solution]\nkeep_times = true\n")
    look_again(armature)
    assert first.hangtime.stale == EDIT_CHANGED


def test_keys_edited_by_hand_are_seen_before_they_are_left_behind(
    armature: bpy.types.Object,
) -> None:
    first = adapt(armature, 10, 20, 0.1)
    assert polished_result(armature) is None
    holder = fcurves.holder_in(first, fcurves.slot_identifier(armature))
    holder.fcurves[0].keyframe_points[5].co.y += 0.1
    assert polished_result(armature) == first
    look_again(armature)
    assert first.hangtime.polished
    armature.hangtime.loop.use = True
    assert left_behind(armature).endswith("A loop cannot take them along")


def test_a_take_that_is_not_there_is_named(armature: bpy.types.Object) -> None:
    assert armature is not None
    with pytest.raises(RuntimeError, match="The action “Nobody's” is not there any more"):
        bpy.ops.hangtime.show_take(action="Nobody's")
    with pytest.raises(RuntimeError, match="No action is named"):
        bpy.ops.hangtime.show_take(action="")


class Probe(adapt_operators.AdaptOperator.__bases__[0], bpy.types.Operator):
    """Adapt as a window calls it, which only tells how. Adapt's mixin and not Adapt itself, which
    would be gone with a class of its own."""

    bl_idname = "hangtime.probe"
    bl_label = "Probe"
    left: ClassVar[list[bool]] = []

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.left.append(self.leave_edits)
        return {"FINISHED"} if self.leave_edits else self.invoke(context, None)


def test_adapt_anyway_goes_on_to_adapt(
    armature: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, asked = adapt(armature, 10, 20, 0.1), {}
    fcurves.holder_in(first, fcurves.slot_identifier(armature)).fcurves[0].mute = True
    ours = SimpleNamespace(leave_edits=lambda _how, **told: asked.update(told))
    ops, app = SimpleNamespace(hangtime=ours), SimpleNamespace(background=False)
    monkeypatch.setattr(adapt_operators, "bpy", SimpleNamespace(app=app, ops=ops))
    monkeypatch.setattr(operator_types, "OperatorId", [Probe.bl_idname])  # it is one of ours here
    bpy.utils.register_class(Probe)
    try:
        assert bpy.ops.hangtime.probe() == {"CANCELLED"}
        assert f"Keys of {first.name} were edited by hand" in asked["text"]
        assert bpy.ops.hangtime.leave_edits(**asked) == {"FINISHED"}
        assert Probe.left == [False, True]
    finally:
        bpy.utils.unregister_class(Probe)


def test_what_is_discarded_is_what_is_shown(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    first, second = adapt(armature, 10, 20, 0.1), adapt(armature, 10, 20, 0.2)
    show_take(armature, recording)
    assert not bpy.ops.hangtime.discard.poll()
    assert bpy.ops.hangtime.show_take(action=first.name) == {"FINISHED"}
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(armature) == recording
    assert [take.action for take in takes_of(armature)] == [recording, second]
    assert armature.hangtime.contacts[0].at[2] == pytest.approx(0.1)  # what was asked for stays
    look_again(armature)
    assert second.hangtime.stale == ""
    assert bpy.ops.hangtime.show_take(action=second.name) == {"FINISHED"}
    assert armature.hangtime.contacts[0].at[2] == pytest.approx(0.2)


def test_the_action_of_something_else_is_no_take(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    cart = bpy.data.objects.new("Cart", None)
    cart.keyframe_insert("location", frame=1)
    with pytest.raises(RuntimeError, match="has no keys for bones of Rig; choose one of its takes"):
        bpy.ops.hangtime.show_take(action=cart.animation_data.action.name)
    assert current_action(armature) == recording


def test_what_is_shown_in_the_place_of_a_result_is_named(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    adapt(armature, 10, 20, 0.1)
    shown = {"No action": None, "The recording": recording, "Walk": bpy.data.actions.new("Walk")}
    for told, action in shown.items():
        armature.animation_data.action = action
        with pytest.raises(RuntimeError, match=f"{told} is shown; show the result that is to go"):
            bpy.ops.hangtime.discard()
        with pytest.raises(RuntimeError, match=f"{told} is shown; show the result that is to be"):
            bpy.ops.hangtime.accept()
    assert not any(take.action.hangtime.accepted for take in takes_of(armature))
    armature.animation_data.action = None
    with pytest.raises(RuntimeError, match="assign it the action that holds the recording"):
        bpy.ops.hangtime.show_recording()


def test_a_result_without_its_recording_is_discarded(armature: bpy.types.Object) -> None:
    recording = current_action(armature)
    adapt(armature, 10, 20, 0.1)
    bpy.data.actions.remove(recording)
    assert bpy.ops.hangtime.discard() == {"FINISHED"}
    assert current_action(armature) is None
    assert len(bpy.data.actions) == 0


def test_a_result_that_others_build_on_is_not_discarded(armature: bpy.types.Object) -> None:
    first = adapt(armature, 10, 20, 0.1)
    assert bpy.ops.hangtime.start_from(result=True) == {"FINISHED"}
    adapt(armature, 30, 40, 0.2)
    show_take(armature, first)
    assert not bpy.ops.hangtime.discard.poll()
