"""What the sidebar offers where a recording falls, or is tall, as nobody is; what it is about."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.properties.stances import active_stance
from hangtime.bridge.repairs.renamed_bones import dead_bones, renamed_bones, require_keyed
from hangtime.bridge.rows.phases import roles, roles_in
from hangtime.operators.solve.common import chosen_armature, said
from hangtime.operators.words.failure_text import failure_of
from hangtime.solver.data.faults import DeadKeys, NoSolution, RenamedBones, UnseenSupport
from hangtime.solver.data.row_kinds import RowKind, Violation
from hangtime.solver.data.status import Status
from hangtime.tests.blender.helpers import rigs

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_a_wrong_frame_rate_is_told_and_mended(jump: bpy.types.Object) -> None:
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1.0
    with pytest.raises(RuntimeError, match="at 120 frames a second, but the scene has 24"):
        bpy.ops.hangtime.analyze()
    assert bpy.ops.hangtime.set_frame_rate(rate=120) == {"FINISHED"}
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert active_stance(jump.hangtime).name == "ground 2"  # the landing is chosen


@pytest.mark.usefixtures("jump")
@pytest.mark.slow
def test_a_wrong_rate_of_ntsc_s_is_mended_by_another() -> None:
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1.001
    with pytest.raises(RuntimeError, match=r"rate to 119\.88\."):
        bpy.ops.hangtime.analyze()
    assert bpy.ops.hangtime.set_frame_rate(rate=120.0 / 1.001) == {"FINISHED"}
    assert (scene.render.fps, scene.render.fps_base) == (120, pytest.approx(1.001, rel=1e-6))
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


@pytest.mark.parametrize(
    ("base", "scale"),
    [
        (1.0, 2.0),
        pytest.param(1.001, 2.0, marks=pytest.mark.slow),
        pytest.param(1.0, 1.998, marks=pytest.mark.slow),
    ],
)
def test_a_strip_that_plays_the_jump_too_slowly_is_named_with_the_scale_that_fits(
    jump: bpy.types.Object, base: float, scale: float
) -> None:
    bpy.context.scene.render.fps_base = base
    data, settings = jump.animation_data, jump.hangtime
    strip = data.nla_tracks.new().strips.new("Jump", 1, data.action)
    data.action, strip.scale = None, scale
    start = strip.frame_start
    settings.first_frame = round(start + scale * (settings.first_frame - start))
    settings.last_frame = round(start + scale * (settings.last_frame - start))
    told = rf"“Jump” plays its action at Scale {scale:g}; set the strip's Scale to 1 \("
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.hangtime.analyze()
    strip.scale, settings.use_range = 1.0, False
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def test_stances_are_called_by_their_roles(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    assert roles(settings) == {"ground 1": "Take-Off", "ground 2": "Landing"}
    settings.active_stance = 0
    assert settings.contacts[settings.active_contact].phase == "ground 1"
    assert settings.active_stance == 0


def test_a_stance_that_a_result_joins_is_neither_take_off_nor_landing(
    analysed: bpy.types.Object,
) -> None:
    """What follows a landing was told to be carried along with the take-off."""
    settings = analysed.hangtime
    frames = SimpleNamespace(recorded_frame=(settings.first_frame, settings.last_frame))

    def called(*names: str) -> dict[str, str]:
        phases = [SimpleNamespace(phase=name) for name in names]
        report: Any = SimpleNamespace(phases=phases, times=frames)
        return roles_in(settings, report)

    assert called("ground 1")["ground 1"] == "Stance"
    assert called("ground 1", "flight 1", "ground 2") == roles(settings)


def test_a_keyed_scale_is_scaled_with_its_object(jump: bpy.types.Object) -> None:
    jump.scale = (0.01, 0.01, 0.01)
    jump.keyframe_insert("scale", frame=1)
    jump.keyframe_insert("scale", frame=300)
    with pytest.raises(RuntimeError, match=r"m tall.* at 100 times the scale"):  # by how it falls
        bpy.ops.hangtime.analyze()
    assert bpy.ops.hangtime.scale_to_human(factor=100.0) == {"FINISHED"}
    bpy.context.scene.frame_set(200)
    assert tuple(jump.scale) == pytest.approx((1.0, 1.0, 1.0))
    holder = fcurves.holder_in(jump.animation_data.action, fcurves.slot_identifier(jump))
    assert holder.fcurves.find("scale", index=2).evaluate(150) == pytest.approx(1.0)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def rename_beside(armature: bpy.types.Object, names: dict[str, str]) -> None:
    """While another action is shown, whose curves Blender renames alone."""
    data, recording = armature.animation_data, armature.animation_data.action
    data.action = recording.copy()
    for old, new in names.items():
        armature.data.bones[old].name = new
    data.action = recording


def keyed_bone(armature: bpy.types.Object, name: str) -> bpy.types.FCurve:
    """A key of a bone, whether or not there is one of that name."""
    path = f'pose.bones["{name}"].location'
    curve = fcurves.holder(armature).fcurves.new(path, index=0)
    curve.keyframe_points.insert(1.0, 0.0)
    return curve


def contacts_of(armature: bpy.types.Object) -> list[tuple[str, float, float]]:
    return [(row.name, row.start_frame, row.end_frame) for row in armature.hangtime.contacts]


def test_keys_of_renamed_bones_are_missed_and_renamed(analysed: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    before = contacts_of(analysed)
    prefixed = {b.name: f"rig_{b.name}" for b in analysed.data.bones if "Foot" not in b.name}
    rename_beside(analysed, {"LeftFoot": "ankle.L", "RightFoot": "ankle.R"} | prefixed)
    for refused in (bpy.ops.hangtime.examine, bpy.ops.hangtime.analyze):
        with pytest.raises(RuntimeError, match=r"no keys for ankle\.L, .* press Rename Keys"):
            refused()
    assert contacts_of(analysed) == before
    assert bpy.ops.hangtime.rename_keys() == {"FINISHED"}
    assert not dead_bones(analysed)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert contacts_of(analysed) == before


def test_bones_that_may_be_any_of_several_are_to_be_named_back(analysed: bpy.types.Object) -> None:
    for side in ("Left", "Right"):
        analysed.data.bones[f"{side}Foot"].name = f"{side} paddle"
    rename_beside(analysed, {"Left paddle": "ankle.L", "Right paddle": "ankle.R"})
    analysed.hangtime.parts.clear()
    with pytest.raises(RuntimeError, match=r"no keys for ankle\.L, ankle\.R, .*the names that the"):
        bpy.ops.hangtime.analyze()
    with pytest.raises(RuntimeError, match="not known which bones were renamed"):
        bpy.ops.hangtime.rename_keys()


def test_old_names_tell_which_parts_were_renamed(analysed: bpy.types.Object) -> None:
    rename_beside(analysed, {"LeftFoot": "ankle.L", "RightFoot": "ankle.R"})
    analysed.hangtime.parts.clear()
    assert renamed_bones(analysed) == {"LeftFoot": "ankle.L", "RightFoot": "ankle.R"}
    assert bpy.ops.hangtime.rename_keys() == {"FINISHED"}
    assert not dead_bones(analysed)


@pytest.mark.parametrize(
    ("old", "new", "alike"),
    [
        ("Tail", "rig_Tail", True),
        ("mixamorig:Tail", "Tail", True),
        ("Detail", "Tail", False),
        ("Sword", "d", False),
        ("Prop.L", "L", False),
    ],
)
def test_bones_with_another_prefix_are_the_same(
    analysed: bpy.types.Object, old: str, new: str, alike: bool
) -> None:
    analysed.data.bones["LThumb"].name = old
    rename_beside(analysed, {old: new})
    assert renamed_bones(analysed) == ({old: new} if alike else {})


def test_keys_of_a_deleted_bone_are_not_given_to_a_part_that_has_none(
    analysed: bpy.types.Object,
) -> None:
    curves = fcurves.holder(analysed).fcurves
    for curve in [c for c in curves if fcurves.bone_of(c.data_path) == "Head"]:
        curves.remove(curve)
    keyed_bone(analysed, "Tail")
    assert renamed_bones(analysed) == {}
    with pytest.raises(RuntimeError, match=r"no keys for Head, .*if they are a deleted bone's"):
        bpy.ops.hangtime.analyze()
    bpy.ops.object.mode_set(mode="EDIT")
    bones = analysed.data.edit_bones
    control, head = bones.new("turn"), bones["Head"]
    control.head, control.tail, control.parent = head.head, head.tail, head.parent
    head.use_connect, head.parent = False, control
    bpy.ops.object.mode_set(mode="OBJECT")
    keyed_bone(analysed, "turn")  # a control about the head's joint, as a neck is not
    assert isinstance(require_keyed(analysed), DeadKeys)


def test_keys_of_no_bone_are_told_where_the_body_lacks_none(analysed: bpy.types.Object) -> None:
    assert require_keyed(analysed) is None
    curve = keyed_bone(analysed, "Tail")
    curve.mute = True
    assert require_keyed(analysed) is None
    curve.mute = False
    unknown = analysed.hangtime.parts.add()
    unknown.name, unknown.bone = "left thumb", "LThumb"  # a script's, or another version's
    assert "has keys for Tail, which the armature does not have" in said(require_keyed(analysed))
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


def test_renamed_bones_that_the_body_does_not_follow_are_told(analysed: bpy.types.Object) -> None:
    prop = {"LThumb": "rig_LThumb"}
    rename_beside(analysed, prop)
    assert renamed_bones(analysed) == prop
    assert "has keys for LThumb, which the armature does not have" in said(require_keyed(analysed))
    followed = analysed.pose.bones["RightArm"].constraints.new("COPY_ROTATION")
    followed.target, followed.subtarget = analysed, "rig_LThumb"
    with pytest.raises(RenamedBones):
        require_keyed(analysed)


def test_a_renamed_head_does_not_move_with_its_neck(analysed: bpy.types.Object) -> None:
    analysed.hangtime.parts.clear()
    rename_beside(analysed, {"Head": "skull", "LThumb": "digit"})
    with pytest.raises(RenamedBones) as fault:
        require_keyed(analysed)
    assert fault.value.unkeyed == ("skull",)


def test_keys_of_two_armatures_that_share_an_action_are_not_renamed(
    analysed: bpy.types.Object,
) -> None:
    """Those of a bone that one of them has and the other calls otherwise."""
    other = analysed.copy()
    other.data = analysed.data.copy()
    other.animation_data.action = analysed.animation_data.action
    bpy.context.scene.collection.objects.link(other)
    analysed.data.bones["LeftFoot"].name = "ankle.L"  # which renames the curves of both
    bpy.context.view_layer.objects.active = other
    other.select_set(True)
    with pytest.raises(RuntimeError, match=r"no keys for LeftFoot, .*armature that shares it"):
        bpy.ops.hangtime.analyze()
    with pytest.raises(RuntimeError, match=f"“{analysed.name}” shares the action"):
        bpy.ops.hangtime.rename_keys()
    analysed.select_set(False)
    bpy.ops.object.make_single_user(type="SELECTED_OBJECTS", animation=True)
    assert bpy.ops.hangtime.rename_keys() == {"FINISHED"}
    assert not dead_bones(other)
    assert not dead_bones(analysed)


def test_keys_of_a_linked_action_are_not_renamed(
    analysed: bpy.types.Object, tmp_path: Path
) -> None:
    path, data = str(tmp_path / "take.blend"), analysed.animation_data
    bpy.data.libraries.write(path, {data.action})
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.actions = [data.action.name]
    analysed.data.bones["LeftFoot"].name = "ankle.L"  # the linked action is not shown yet
    fcurves.assign(analysed, wanted.actions[0], fcurves.slot_identifier(analysed))
    with pytest.raises(RuntimeError, match="is linked: rename its keys in its own file"):
        bpy.ops.hangtime.rename_keys()
    assert dead_bones(analysed) == ("LeftFoot",)


def test_the_sidebar_is_about_the_active_armature_unless_pinned() -> None:
    rigs.reset()
    first, second = rigs.make_armature(), rigs.make_armature()
    layer, own = bpy.context.view_layer, bpy.context.scene.hangtime
    layer.objects.active = first
    own.pinned = True
    layer.objects.active = second
    assert chosen_armature(bpy.context) == first
    own.pinned = False
    assert chosen_armature(bpy.context) == second
    empty = bpy.data.objects.new("Aim", None)
    bpy.context.collection.objects.link(empty)
    layer.objects.active = empty
    assert chosen_armature(bpy.context) == first  # worked on last


def test_a_script_pins_first_and_then_says_which_armature() -> None:
    """As the manual's page on scripting has it."""
    rigs.reset()
    first, second = rigs.make_armature(), rigs.make_armature()
    own = bpy.context.scene.hangtime
    bpy.context.view_layer.objects.active = second
    own.pinned = True
    own.armature = first
    assert chosen_armature(bpy.context) == first


def test_a_failure_is_a_short_line_with_what_is_furthest_off_first() -> None:
    worst = (
        Violation("Right Hand", RowKind.POINT, 420.0),
        Violation("Knee", RowKind.BEND, 3.0),
    )
    failure = failure_of(NoSolution(Status.STALLED, worst, 0.8), 1, "hangtime.adapt")
    assert failure.short == "No motion: “Right Hand” stays 42.0 cm from its place"
    assert [row.name for row in failure.rows] == ["Right Hand", "Knee"]
    assert failure.text.endswith("The best found goes 80 % of the way.")
    heavy = Violation("ground 2", RowKind.BALANCE, 0.115)
    both = failure_of(NoSolution(Status.STALLED, (heavy, *worst), 0.0), 1, "hangtime.adapt")
    assert [row.name for row in both.rows] == ["Right Hand", "Knee", "ground 2"]
    assert both.short == failure.short
    assert both.rows[-1].text.startswith("In ground 2, 0.115 body weights")
    told = failure_of(UnseenSupport(1.0, 9.0), 1, "hangtime.analyze")
    assert len(told.short) <= 100
    assert not told.rows


def test_a_row_of_a_failure_leads_to_its_list(analysed: bpy.types.Object) -> None:
    settings = analysed.hangtime
    assert bpy.ops.hangtime.choose_named(name="Left heel 1") == {"FINISHED"}
    assert settings.contacts[settings.active_contact].name == "Left heel 1"
    assert bpy.ops.hangtime.choose_named(name="ground 2") == {"FINISHED"}
    assert active_stance(settings).name == "ground 2"
    with pytest.raises(RuntimeError, match="No contact and no constraint is called “Nobody”"):
        bpy.ops.hangtime.choose_named(name="Nobody")


def test_what_a_failure_names_is_unticked_and_ticked_again(analysed: bpy.types.Object) -> None:
    row = analysed.hangtime.contacts["Left heel 1"]
    assert bpy.ops.hangtime.tick_named(name="Left heel 1: Left heel 1") == {"FINISHED"}
    assert not row.used
    assert bpy.ops.hangtime.tick_named(name="Left heel 1") == {"FINISHED"}
    assert row.used
    with pytest.raises(RuntimeError, match="No contact and no constraint is called “Nobody”"):
        bpy.ops.hangtime.tick_named(name="Nobody")


def test_a_row_stays_ticked_where_what_goes_on_refuses(jump: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.add_constraint(kind="ANGLE") == {"FINISHED"}
    row = jump.hangtime.constraints[-1]
    with pytest.raises(RuntimeError, match=r"^Error: Press Analyze first"):
        bpy.ops.hangtime.tick_named(name=row.name, then="hangtime.adapt")
    assert row.used


@pytest.mark.usefixtures("analysed")
def test_what_is_no_operator_of_ours_does_not_go_on() -> None:
    with pytest.raises(RuntimeError, match="Error: Hangtime has no operator “Landing”"):
        bpy.ops.hangtime.leave_edits(then="Landing")
    with pytest.raises(RuntimeError, match=r"Error: Hangtime has no operator “wm\.quit_blender”"):
        bpy.ops.hangtime.tick_named(name="Left heel 1", then="wm.quit_blender")


@pytest.mark.parametrize("rate", [float("nan"), 0.0, -5.0, 1e6])
def test_a_frame_rate_that_no_scene_has_is_refused(jump: bpy.types.Object, rate: float) -> None:
    assert jump is not None
    render = bpy.context.scene.render
    before = render.fps, render.fps_base
    with pytest.raises(RuntimeError, match=r"A scene cannot have .* give 1 to 1000"):
        bpy.ops.hangtime.set_frame_rate(rate=rate)
    assert (render.fps, render.fps_base) == before


@pytest.mark.parametrize("factor", [float("nan"), 0.0, -1.0, 1e30])
def test_a_size_that_nothing_has_is_refused(jump: bpy.types.Object, factor: float) -> None:
    before = jump.scale.copy()
    with pytest.raises(RuntimeError, match="times as large; give a factor from 1e-06 to 1,000,000"):
        bpy.ops.hangtime.scale_to_human(factor=factor)
    assert jump.scale == before


def test_settings_that_are_no_numbers_are_named(jump: bpy.types.Object) -> None:
    settings = jump.hangtime
    settings.mass = float("nan")
    with pytest.raises(RuntimeError, match=r"“Mass \(kg\)” is no number"):
        bpy.ops.hangtime.analyze()
    settings.mass, settings.height = 70.0, float("nan")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}  # a height that is not used
    settings.use_height = True
    with pytest.raises(RuntimeError, match=r"“Height \(m\)” is no number"):
        bpy.ops.hangtime.analyze()


def test_an_edge_that_is_to_go_to_no_frame_is_refused(analysed: bpy.types.Object) -> None:
    before = analysed.hangtime.contacts["Right toe 1"].end_frame
    with pytest.raises(RuntimeError, match="where the end is to go is no number"):
        bpy.ops.hangtime.drag_contact_edge(contact="Right toe 1", edge="END", frame=float("nan"))
    assert analysed.hangtime.contacts["Right toe 1"].end_frame == before
