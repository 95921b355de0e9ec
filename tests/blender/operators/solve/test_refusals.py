"""What cannot be analysed or adapted is said, and changes nothing."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge import worker_client, worker_requests
from hangtime.bridge.armature.pose_basis import basis_under
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.rows.phases import phases_of
from hangtime.operators.solve import common
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.jump_scene import (
    FIRST,
    LAST,
    SceneState,
    ask_by_text,
    drift,
    landing,
)
from mathutils import Matrix

pytestmark = pytest.mark.usefixtures("_enabled")


def no_armature(_armature: bpy.types.Object) -> None:
    bpy.context.view_layer.objects.active = None


def in_another_scene(armature: bpy.types.Object) -> None:
    scene = bpy.context.scene
    scene.hangtime.armature = armature
    bpy.data.scenes.new("Other").collection.objects.link(armature)
    for collection in [each for each in armature.users_collection if each in scene_tree(scene)]:
        collection.objects.unlink(armature)


def scene_tree(scene: bpy.types.Scene) -> list[bpy.types.Collection]:
    return [scene.collection, *scene.collection.children_recursive]


def another_object(_armature: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Cube", None)
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty


def no_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = None


def empty_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = bpy.data.actions.new("Nothing")


def posed_by_another(armature: bpy.types.Object) -> None:
    source = rigs.make_armature()
    source.name, armature.animation_data.action = "Source", None
    bpy.context.view_layer.objects.active = armature
    for bone in armature.pose.bones:
        bone.constraints.new("COPY_ROTATION").target = source


def edit_mode(_armature: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="EDIT")


def too_short(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame = FIRST + 10


def backwards(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame = FIRST - 11


def single_pose(armature: bpy.types.Object) -> None:
    armature.hangtime.use_range = False
    for curve in curves_of(armature):
        while len(curve.keyframe_points) > 1:
            curve.keyframe_points.remove(curve.keyframe_points[-1], fast=True)


def bad_scale(armature: bpy.types.Object) -> None:
    armature.scale = (1.0, 1.0, -1.0)


def infinite_key(armature: bpy.types.Object) -> None:
    snapshot_curve(armature).keyframe_points[90].co.y = float("nan")


def driven_shin(armature: bpy.types.Object) -> None:
    shin = armature.pose.bones["LeftLeg"]
    shin.driver_add("rotation_quaternion", 1).driver.expression = "0.1 * frame"


def held_foot(armature: bpy.types.Object) -> None:
    hold = armature.pose.bones["LeftFoot"].constraints.new("COPY_ROTATION")
    hold.target, hold.subtarget, hold.influence = armature, "RightFoot", 0.3


def stopped_shin(armature: bpy.types.Object) -> None:
    limit = armature.pose.bones["LeftLeg"].constraints.new("LIMIT_ROTATION")
    limit.owner_space, limit.use_limit_x, limit.max_x = "LOCAL", True, 0.5


def blended_over_a_strip(armature: bpy.types.Object) -> None:
    data = armature.animation_data
    breath = data.nla_tracks.new().strips.new("Breath", 1, data.action.copy())
    assert breath.frame_end > FIRST
    data.action_influence = 0.8


def muted_strip(armature: bpy.types.Object) -> None:
    data = armature.animation_data
    track = data.nla_tracks.new()
    track.strips.new("Take", 1, data.action)
    track.mute, data.action = True, None


def unused_strip(armature: bpy.types.Object) -> None:
    muted_strip(armature)
    data = armature.animation_data
    data.nla_tracks[0].mute = data.use_nla = False


def snapshot_curve(armature: bpy.types.Object) -> bpy.types.FCurve:
    return next(c for c in curves_of(armature) if "LeftUpLeg" in c.data_path)


def assert_refused(operator: Callable[[], set[str]], armature: bpy.types.Object, says: str) -> None:
    """The operator says so in a sentence, and leaves the scene as it is."""
    before = SceneState.of(armature)
    with pytest.raises(RuntimeError) as caught:
        operator()
    assert says in str(caught.value)
    assert "Traceback" not in str(caught.value)
    assert SceneState.of(armature) == before


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (no_armature, "No armature is chosen"),
        (in_another_scene, "“forward_jump_116cm” is not in scene “Scene”; link it there"),
        (another_object, "“Cube” is or holds no armature"),
        (no_action, "has no keyframes"),
        (empty_action, "has no keyframes"),
        (posed_by_another, "has no keyframes: constraints pose it after Source; bake it (Pose >"),
        (muted_strip, "cannot be read: Take is muted. Leave one strip unmuted"),
        (unused_strip, "(Take) plays; switch it on (Nonlinear Animation editor, the tick"),
        (edit_mode, "Leave edit mode first"),
        (too_short, "The chosen frames, 110 to 120, are only 0.08 s of the recording"),
        (backwards, "end at 99, before they begin at 110; swap them"),
        (single_pose, "The recording has only one frame (1), which is a pose and no motion"),
        (bad_scale, "must be the same, and above zero"),
        (infinite_key, "LeftUpLeg” has a value at frame"),
        (driven_shin, "Drivers pose the bones LeftLeg whatever keys they have"),
        (held_foot, "pose the bones LeftFoot otherwise than their keys say (frame 110)"),
        (stopped_shin, "pose the bones LeftLeg otherwise than their keys say (frame"),
        (blended_over_a_strip, "is blended with the NLA strips below it (Breath)"),
    ],
)
def test_what_cannot_be_analysed_is_said_and_changes_nothing(
    jump: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], says: str
) -> None:
    spoil(jump)
    assert_refused(bpy.ops.hangtime.analyze, jump, says)


def test_a_long_precondition_tells_scripts_what_is_wrong_and_what_to_do(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    """Blender passes on 200 bytes of it."""
    muted_strip(jump)
    jump.animation_data.nla_tracks[0].strips[0].name = long = "Ä take with a long name " * 2
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.hangtime.analyze()
    told = str(caught.value).strip().partition(".poll() ")[2]
    begins = "The NLA strips that “forward_jump_116cm” performs cannot be read:"
    ends = (
        "Leave one strip unmuted that plays its action once (any start, any scale), or assign the "
        "action."
    )
    assert told.startswith(begins)
    assert told.endswith(f" … {ends}") or told.endswith(f" {ends}")
    assert len(told.encode()) <= 200
    assert f"{begins} {long} is muted. {ends}" in capfd.readouterr().err


@pytest.mark.parametrize("size", [199, 200, 201])
@pytest.mark.usefixtures("jump")
def test_a_precondition_is_whole_as_long_as_blender_passes_it_on(
    monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    why = "Wrong; " + ("do this and that " * 20)[: size - 8] + "!"
    assert len(why.encode()) == size
    monkeypatch.setattr(common, "hindrance", lambda _: why)
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.hangtime.analyze()
    assert (why in str(caught.value)) == (size <= 200)
    assert str(caught.value).strip().endswith("!")


def test_a_driver_in_error_and_a_limit_that_is_not_reached_leave_keys_as_they_are(
    jump: bpy.types.Object,
) -> None:
    jump.pose.bones["Spine"].driver_add("rotation_quaternion", 0).driver.expression = "nonsense +"
    limit = jump.pose.bones["LeftLeg"].constraints.new("LIMIT_ROTATION")
    limit.owner_space, limit.use_limit_y, limit.min_y, limit.max_y = "LOCAL", True, -3.0, 3.0
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


@pytest.mark.slow
def test_a_limit_that_only_the_result_reaches_is_told(analysed: bpy.types.Object) -> None:
    frames = np.arange(FIRST - 10.0, LAST + 11.0)
    with_limit, poses = analysed.pose.bones["LeftUpLeg"], sample(analysed, frames)
    thigh, above = (
        poses.matrices[:, poses.bones.index(bone.name)] for bone in (with_limit, with_limit.parent)
    )
    bent = [Matrix(each).to_euler().x for each in basis_under(with_limit.bone, above, thigh)]
    limit = with_limit.constraints.new("LIMIT_ROTATION")
    limit.owner_space, limit.use_limit_x = "LOCAL", True
    limit.min_x, limit.max_x = min(bent) - 1e-3, max(bent) + 1e-3
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    analysed.hangtime.stances["ground 2"].up = 0.2
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    told = "Constraints keep LeftUpLeg from the result (frame "
    made = analysed.hangtime.adapted.hangtime
    for text in (analysed.hangtime.status, made.report, made.warning):
        assert text.startswith("The keys do not show what was solved: Left")
        assert told in text


@pytest.mark.slow
def test_a_bone_that_stretches_holds_its_length_in_the_result(jump: bpy.types.Object) -> None:
    shin = jump.pose.bones["LeftLeg"]
    for frame, length in ((225, 1.0), (240, 1.1), (262, 1.0)):
        shin.scale.y = length
        shin.keyframe_insert("scale", frame=frame)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    jump.hangtime.stances["ground 2"].up = 0.05
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert jump.hangtime.status.startswith("Solved")
    assert "Held still, for they moved joints within the body: LeftLeg" in jump.hangtime.status
    heels = [row for row in landing(jump.hangtime) if row.bone == "LeftFoot"]
    assert heels
    assert max(drift(jump, row) for row in heels) < 2e-3


def test_a_clip_without_a_flight_is_analysed(jump: bpy.types.Object) -> None:
    jump.hangtime.last_frame = 150
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert [phase.name for phase in phases_of(jump.hangtime)] == ["ground 1"]


def contradiction(armature: bpy.types.Object) -> None:
    armature.hangtime.whole_stance = False
    row = landing(armature.hangtime)[0]
    row.place = np.add(row.place, (0.0, 0.0, 0.2))


def moved_armature(armature: bpy.types.Object) -> None:
    armature.location.x += 1.0


def other_range(armature: bpy.types.Object) -> None:
    armature.hangtime.last_frame += 5


def no_contacts(armature: bpy.types.Object) -> None:
    armature.hangtime.contacts.clear()


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (muted_strip, "cannot be read: Take is muted. Leave one strip unmuted"),
        (edit_mode, "Leave edit mode first"),
        (no_contacts, "Press Analyze first"),
        (contradiction, "contradict each other by"),
        (moved_armature, "press Analyze again"),
        (other_range, "press Analyze again"),
    ],
)
def test_what_cannot_be_adapted_is_said_and_changes_nothing(
    analysed: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], says: str
) -> None:
    spoil(analysed)
    assert_refused(bpy.ops.hangtime.adapt, analysed, says)


def test_a_worker_killed_in_the_middle_is_told(analysed: bpy.types.Object) -> None:
    before = SceneState.of(analysed)

    def kill() -> None:
        while not worker_client.shared().busy:
            time.sleep(0.01)
        os.kill(worker_client.shared().pid, 9)

    killer = threading.Thread(target=kill)
    killer.start()
    with pytest.raises(RuntimeError, match="solver stopped without an answer"):
        bpy.ops.hangtime.adapt()
    killer.join()
    assert SceneState.of(analysed) == before


@pytest.mark.slow
def test_a_result_for_keys_that_changed_meanwhile_is_thrown_away(
    analysed: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    def edited_while_waiting(job: worker_requests.PendingRequest) -> object:
        answer = wait(job)
        snapshot_curve(analysed).keyframe_points[120].co.y += 0.1
        return answer

    wait = worker_requests.PendingRequest.wait
    monkeypatch.setattr(worker_requests.PendingRequest, "wait", edited_while_waiting)
    before = SceneState.of(analysed)
    with pytest.raises(RuntimeError, match="The result was thrown away"):
        bpy.ops.hangtime.adapt()
    assert SceneState.of(analysed) == before


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[[torque]]\nname = "Weak"\nbones = ["Tail"]\nbound = 5\n', "Weak.*Tail"),
        ('[[cone]]\nbone = "LeftArm"\n', "line 1"),
        ('[[pose]]\nname = "Tuck"\nphase = "flight 7"\n', "Tuck.*flight 7"),
        ('# A landing\n[[pin]]\nphase = "ground 2"\n', 'Requests, line 2: "pin" .*Contacts'),
        ("[loop]\n[recording]\nscale = 2\n", 'Requests, line 2: "recording"'),
    ],
)
def test_a_wrong_request_is_said_and_changes_nothing(
    analysed: bpy.types.Object, text: str, words: str
) -> None:
    ask_by_text(analysed, text)
    before = SceneState.of(analysed)
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.hangtime.adapt()
    assert SceneState.of(analysed) == before


def loop_ticked(armature: bpy.types.Object) -> None:
    armature.hangtime.loop.use = True


def smaller_units(_armature: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.5


@pytest.mark.parametrize(
    ("change", "named"), [(loop_ticked, "Loop"), (smaller_units, "unit scale")]
)
def test_what_else_an_analysis_depends_on_is_named(
    analysed: bpy.types.Object, change: Callable[[bpy.types.Object], None], named: str
) -> None:
    change(analysed)
    assert_refused(bpy.ops.hangtime.adapt, analysed, named)
