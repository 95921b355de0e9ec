"""Rigid bodies that were never played: they are where they fall, not where they begin."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import point
from hangtime.bridge.constraints.target_paths import Durations, paths_of
from hangtime.bridge.rows.times import Clip
from hangtime.bridge.scene.ground import ground_faces
from hangtime.bridge.scene.members import ground_members, members
from hangtime.bridge.scene.read import SceneReading, read_scene
from hangtime.tests.blender.helpers.solids import add_row, make_armature, make_box, read

BEGINS, SHOWN = 1001, 1047  # scene frames
FRAMES = np.arange(1040.0, 1061.0)
HIGH, RESTS = 2.0, 0.5  # m, of the crate's middle

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    return make_armature()


@pytest.fixture
def crate(armature: bpy.types.Object) -> bpy.types.Object:
    """Falls on a floor as soon as the scene is played, which it was not."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = BEGINS, BEGINS + 120
    scene.frame_set(BEGINS)
    bpy.ops.mesh.primitive_plane_add(size=20.0)
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    made = make_box(at=(0.0, 0.0, HIGH))
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    cache = scene.rigidbody_world.point_cache
    cache.frame_start, cache.frame_end = BEGINS, BEGINS + 120
    scene.frame_set(SHOWN)
    assert made.matrix_world.translation.z == pytest.approx(HIGH)
    add_row(armature, made)
    return made


def height(found: SceneReading, instant: int) -> float:
    (crate,) = found.objects
    return float(crate.positions[min(instant, len(crate.positions) - 1), 2])


def assert_rests(found: SceneReading) -> None:
    assert [height(found, i) for i in (0, -1)] == pytest.approx([RESTS, RESTS], abs=0.05)


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("sliced", [False, True])
def test_a_body_that_was_never_played_is_where_it_fell(
    armature: bpy.types.Object, crate: bpy.types.Object, *, sliced: bool, apart: bool
) -> None:
    if apart:  # in a collection of its own, out of which it is linked to be looked at
        other = bpy.data.collections.new("Props")
        bpy.context.scene.collection.children.link(other)
        other.objects.link(crate)
        bpy.context.scene.collection.objects.unlink(crate)
    found = in_parts(armature) if sliced else read(armature, FRAMES)
    assert_rests(found)
    assert bpy.context.scene.frame_current == SHOWN


def in_parts(armature: bpy.types.Object) -> SceneReading:
    """As in a window, which shows the first frame between the parts."""
    slices = read_scene(members(armature.hangtime, bpy.context.scene), FRAMES)
    count = 0
    while True:
        try:
            next(slices)
        except StopIteration as end:
            assert count > 2
            return end.value
        count += 1
        bpy.context.scene.frame_set(BEGINS if count % 2 else SHOWN)
        bpy.context.scene.frame_set(SHOWN)


def test_frames_in_which_it_falls_are_read_as_they_are_played(
    armature: bpy.types.Object, crate: bpy.types.Object
) -> None:
    frames = np.arange(BEGINS, BEGINS + 11.0)
    found = read(armature, frames)
    played = []
    for frame in frames:
        bpy.context.scene.frame_set(int(frame))
        seen = crate.evaluated_get(bpy.context.evaluated_depsgraph_get())
        played.append(seen.matrix_world.translation.z)
    np.testing.assert_allclose(found.objects[0].positions[:, 2], played, atol=1e-5)
    assert played[-1] < HIGH - 0.3


@pytest.mark.usefixtures("crate")
def test_a_pin_lands_on_a_body_where_it_fell(armature: bpy.types.Object) -> None:
    faces = ground_faces(ground_members(armature.hangtime, bpy.context.scene), 1050.0)
    assert faces.below(0.0, 0.0).place.z == pytest.approx(2.0 * RESTS, abs=0.05)


def test_a_point_s_target_that_hangs_on_a_body_goes_with_it(
    crate: bpy.types.Object,
) -> None:
    target = bpy.data.objects.new("Target", None)
    bpy.context.scene.collection.objects.link(target)
    target.parent = crate
    row = SimpleNamespace(name="hand", kind=point.KIND.name, target=target, span="ALWAYS")
    clip = Clip((1040.0, 1050.5), (), {})
    path = paths_of([row], clip, 1.0, Durations(24.0), {})["hand"]
    assert [place[2] for place in (path.places[0], path.places[-1])] == pytest.approx(
        [RESTS, RESTS], abs=0.05
    )
