"""What is asked of an armature between two parts costs little, whatever else is in the file."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge import action_slots
from hangtime.bridge.armature.poses import evaluated
from hangtime.bridge.repairs.analysed_state import PLACE
from hangtime.bridge.scene import surfaces_digest
from hangtime.operators.solve.meanwhile.standing import Kept, Standing
from hangtime.solver.data.faults import ArmatureGone
from hangtime.tests.blender.operators.solve.meanwhile.changes import move


def test_scenes_are_asked_of_the_armature_alone(
    armature: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Blender looks through all objects for each that is asked: with 2000 a second, twice a
    part."""
    for count in range(20):
        beside = bpy.data.objects.new(f"A prop {count}", None)
        bpy.context.scene.collection.objects.link(beside)
    asked, scenes_of = [], bpy.types.Object.users_scene.fget

    def noted(thing: bpy.types.Object) -> tuple[bpy.types.Scene, ...]:
        asked.append(thing)
        return scenes_of(thing)

    monkeypatch.setattr(bpy.types.Object, "users_scene", property(noted))

    assert Kept.of(armature).found() == armature
    assert asked == [armature]


def test_an_armature_that_is_in_no_scene_is_gone(armature: bpy.types.Object) -> None:
    kept = Kept.of(armature)
    armature.use_fake_user = True
    bpy.context.scene.collection.objects.unlink(armature)

    with pytest.raises(ArmatureGone):
        kept.found()


def _played_besides(armature: bpy.types.Object, *, muted: bool) -> None:
    """The artist has more strips of the same action."""
    for start in (1000, 2000):
        track = armature.animation_data.nla_tracks.new()
        track.strips.new("Another", start, armature.animation_data.action)
        track.mute = muted


@pytest.mark.parametrize("muted", [True, False])
def test_of_one_that_stands_no_curve_is_listed(
    armature: bpy.types.Object, monkeypatch: pytest.MonkeyPatch, muted: bool
) -> None:
    """All curves of all strips were, three times a part: 0.3 s of 30 strips of a full rig."""
    _played_besides(armature, muted=muted)
    listed = []
    for module in (surfaces_digest, action_slots):
        monkeypatch.setattr(module, "all_curves", lambda action: listed.append(action) or [])

    before = Standing.of(armature)
    with evaluated([armature]):
        pass

    assert before.changed(armature) == ()
    assert not listed


def test_who_is_moved_by_keys_is_in_its_place_at_each_frame(armature: bpy.types.Object) -> None:
    for frame, x in ((1, 0.0), (10, 5.0)):
        armature.location.x = x
        armature.keyframe_insert("location", index=0, frame=frame)
    _played_besides(armature, muted=True)
    bpy.context.scene.frame_set(1)
    before = Standing.of(armature)

    bpy.context.scene.frame_set(10)

    assert before.changed(armature) == ()


def test_who_is_put_elsewhere_is_told(armature: bpy.types.Object) -> None:
    _played_besides(armature, muted=True)
    before = Standing.of(armature)

    move(armature)

    assert before.changed(armature) == (PLACE,)
