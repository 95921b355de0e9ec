"""What is asked of an armature between two parts costs little, whatever else is in the file."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.operators.solve.meanwhile.standing import Kept
from hangtime.solver.data.faults import ArmatureGone


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
