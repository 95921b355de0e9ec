"""Surfaces read from the scene: faces, movement, and what the artist may do to them."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.scene import mesh
from hangtime.bridge.scene.ground import ground_faces
from hangtime.bridge.scene.members import ground_members, is_gone
from hangtime.bridge.scene.read import changed_objects
from hangtime.solver.data.faults import NoFaces, ObjectGone, TooManyFaces
from hangtime.solver.data.scene import SceneRole
from hangtime.tests.blender.helpers.rows import reopen
from hangtime.tests.blender.helpers.solids import (
    FRAMES,
    add_row,
    in_world,
    make_armature,
    make_box,
    read,
    read_one,
    volume,
)

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def armature() -> bpy.types.Object:
    return make_armature()


@pytest.fixture
def box(armature: bpy.types.Object) -> bpy.types.Object:
    """A crate of 1 m among the ground."""
    made = make_box()
    add_row(armature, made)
    return made


def corners(thing: bpy.types.Object, frame: float = 1.0) -> np.ndarray:
    """Its mesh's vertices in the world, by Blender alone; Blender units."""
    bpy.context.scene.frame_set(int(frame))
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([tuple(seen.matrix_world @ v.co) for v in seen.data.vertices])


# ---------------------------------------------------------------- faces


def test_a_box_is_twelve_triangles_about_its_volume(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    box.scale = (2.0, 3.0, 0.5)
    found = read_one(armature)
    assert (found.name, found.role, len(found.triangles)) == ("Crate", SceneRole.GROUND, 12)
    assert volume(found) == pytest.approx(3.0, rel=1e-6)
    assert found.frames.tolist() == [FRAMES[0]]
    assert not found.moves


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_lengths_are_metres(armature: bpy.types.Object, box: bpy.types.Object, unit: float) -> None:
    bpy.context.scene.unit_settings.scale_length = unit
    box.location = (5.0, 0.0, 1.0)
    found = read_one(armature)
    np.testing.assert_allclose(found.positions[0], (5.0 * unit, 0.0, unit), rtol=1e-6)
    assert volume(found) == pytest.approx(unit**3, rel=1e-5)


@pytest.mark.parametrize("scale", [(-1.0, 1.0, 1.0), (-1.0, -1.0, -1.0), (-2.0, -1.0, 1.0)])
def test_a_mirrored_box_is_not_inside_out(
    armature: bpy.types.Object, box: bpy.types.Object, scale: tuple[float, float, float]
) -> None:
    box.scale, box.rotation_euler = scale, (0.3, 0.2, 0.1)
    found = read_one(armature)
    assert volume(found) == pytest.approx(abs(np.prod(scale)), rel=1e-5)
    assert np.linalg.det(found.rotations[0]) == pytest.approx(1.0)
    np.testing.assert_allclose(in_world(found), corners(box), atol=1e-6)


def test_a_sheared_parent_is_baked(armature: bpy.types.Object, box: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.scale, empty.rotation_euler = (1.0, 3.0, 1.0), (0.0, 0.0, 0.4)
    box.parent, box.rotation_euler = empty, (0.0, 0.0, 0.7)
    found = read_one(armature)
    np.testing.assert_allclose(in_world(found), corners(box), atol=1e-5)
    np.testing.assert_allclose(found.rotations[0] @ found.rotations[0].T, np.eye(3), atol=1e-9)


def test_modifiers_count(armature: bpy.types.Object, box: bpy.types.Object) -> None:
    row = box.modifiers.new("Row", "ARRAY")
    row.count, row.use_relative_offset, row.use_constant_offset = 3, False, True
    row.constant_offset_displace = (2.0, 0.0, 0.0)
    found = read_one(armature)
    assert volume(found) == pytest.approx(3.0, rel=1e-6)
    assert np.ptp(in_world(found), axis=0)[0] == pytest.approx(5.0)


@pytest.mark.parametrize("how", ["hide_viewport", "eye", "excluded"])
def test_what_is_hidden_is_solid_all_the_same(
    armature: bpy.types.Object, box: bpy.types.Object, how: str
) -> None:
    box.modifiers.new("Row", "ARRAY").count = 2
    box.keyframe_insert("location", frame=1)
    if how == "eye":
        box.hide_set(True)
    elif how == "excluded":
        hidden = bpy.data.collections.new("Hidden")
        bpy.context.scene.collection.children.link(hidden)
        hidden.objects.link(box)
        bpy.context.scene.collection.objects.unlink(box)
        bpy.context.view_layer.layer_collection.children["Hidden"].exclude = True
    else:
        box.hide_viewport = True
    assert volume(read_one(armature)) == pytest.approx(2.0, rel=1e-6)
    assert box.hide_viewport == (how == "hide_viewport")
    assert [c.name for c in box.users_collection] == (
        ["Hidden"] if how == "excluded" else ["Scene Collection"]
    )


def test_a_filled_curve_has_faces_too(armature: bpy.types.Object) -> None:
    bpy.ops.curve.primitive_bezier_circle_add(radius=1.0)
    disc = bpy.context.object
    disc.data.dimensions, disc.data.fill_mode = "2D", "BOTH"
    add_row(armature, disc)
    found = read_one(armature)
    a, b, c = (found.vertices[found.triangles[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    assert area == pytest.approx(np.pi, rel=0.02)


def test_what_has_no_faces_is_told_by_name(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    box.data.clear_geometry()
    with pytest.raises(NoFaces) as told:
        read(armature)
    assert told.value.thing == "Crate"


def test_too_many_faces_are_told_before_they_are_sent(
    armature: bpy.types.Object, box: bpy.types.Object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mesh, "MOST_TRIANGLES", 11)
    with pytest.raises(TooManyFaces) as told:
        read(armature)
    assert (told.value.thing, told.value.count) == (box.name, 12)
    assert bpy.context.scene.frame_current == 1


def test_a_collection_is_all_its_objects_but_the_performer_s(armature: bpy.types.Object) -> None:
    crate, skin, wall = make_box("Crate"), make_box("Skin"), make_box("Wall")
    skin.parent = armature
    lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    stage = bpy.data.collections.new("Stage")
    bpy.context.scene.collection.children.link(stage)
    for each in (crate, skin, wall, lamp):
        stage.objects.link(each)
    add_row(armature, crate, "OBSTACLE")
    row = armature.hangtime.surfaces.add()
    row.collection, row.role = stage, "GROUND"
    found = {each.name: each.role for each in read(armature).objects}
    assert found == {"Crate": SceneRole.OBSTACLE, "Wall": SceneRole.GROUND}


# ---------------------------------------------------------------- movement


def ride_empty(box: bpy.types.Object) -> None:
    empty = bpy.data.objects.new("Train", None)
    bpy.context.collection.objects.link(empty)
    box.parent, box.scale = empty, (2.0, 1.0, 1.0)
    for frame in (1, 10):
        empty.location, empty.rotation_euler = (0.3 * frame, 0.0, 1.0), (0.0, 0.0, 0.1 * frame)
        empty.keyframe_insert("location", frame=frame)
        empty.keyframe_insert("rotation_euler", frame=frame)


def own_keys(box: bpy.types.Object) -> None:
    for frame in (1, 10):
        box.location.z = 0.1 * frame
        box.keyframe_insert("location", frame=frame)


def constrained(box: bpy.types.Object) -> None:
    ride_empty(other := make_box("Other"))
    box.constraints.new("COPY_LOCATION").target = other


@pytest.mark.parametrize("way", [ride_empty, own_keys, constrained])
def test_what_moves_is_followed_frame_by_frame(
    armature: bpy.types.Object, box: bpy.types.Object, way: Callable[[bpy.types.Object], None]
) -> None:
    way(box)
    bpy.context.scene.frame_set(7)
    reading = read(armature)
    (found,) = reading.objects
    assert bpy.context.scene.frame_current == 7
    assert reading.reshaped == ()
    assert found.frames.tolist() == FRAMES.tolist()
    for instant in (0, 4, 9):
        np.testing.assert_allclose(
            in_world(found, instant), corners(box, FRAMES[instant]), atol=1e-5
        )


def test_keys_that_move_nothing_make_no_platform(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    for frame in (1, 10):
        box.keyframe_insert("location", frame=frame)
    assert not read_one(armature).moves


def test_of_a_shape_that_changes_the_first_one_counts(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    box.shape_key_add(name="Basis")
    taller = box.shape_key_add(name="Taller")
    for point in taller.data:
        point.co.z *= 2.0
    for frame, value in ((1, 0.0), (10, 1.0)):
        taller.value = value
        taller.keyframe_insert("value", frame=frame)
    reading = read(armature)
    assert reading.reshaped == ("Crate",)
    assert volume(reading.objects[0]) == pytest.approx(1.0, rel=1e-5)


def test_a_scale_that_changes_is_another_shape(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    for frame in (1, 10):
        box.scale.z = float(frame)
        box.keyframe_insert("scale", frame=frame)
    assert read(armature).reshaped == ("Crate",)


# ---------------------------------------------------------------- while the artist works


def test_a_surface_is_the_same_until_it_is_edited(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    before = read(armature)
    assert changed_objects(before, read(armature)) == ()
    box.location.x += 0.01
    assert changed_objects(before, read(armature)) == ("Crate",)
    box.location.x -= 0.01
    box.data.vertices[0].co.z += 0.1
    assert changed_objects(before, read(armature)) == ("Crate",)


@pytest.mark.parametrize("how", ["deleted", "removed"])
def test_a_surface_that_is_gone_is_told_by_its_name(
    armature: bpy.types.Object, box: bpy.types.Object, how: str
) -> None:
    (row,) = armature.hangtime.surfaces
    if how == "deleted":
        bpy.ops.object.select_all(action="DESELECT")
        box.select_set(True)
        bpy.ops.object.delete()
    else:
        bpy.data.objects.remove(box)
    assert is_gone(row, bpy.context.scene)
    with pytest.raises(ObjectGone) as told:
        read(armature)
    assert told.value.thing == "Crate"
    row.used = False
    assert read(armature).objects == ()


def test_a_surface_is_found_after_renaming_and_reopening(
    armature: bpy.types.Object, box: bpy.types.Object, tmp_path: Path
) -> None:
    box.name = "Bonnet"
    name = armature.name
    reopen(tmp_path / "kept.blend")
    again = bpy.data.objects[name]
    (row,) = again.hangtime.surfaces
    assert (row.called, row.role) == ("Bonnet", "GROUND")
    assert read_one(again).name == "Bonnet"


# ---------------------------------------------------------------- landing


def test_a_pin_lands_on_the_highest_face_that_can_be_stood_on(armature: bpy.types.Object) -> None:
    floor, crate, wall = make_box("Floor", size=20.0), make_box("Crate"), make_box("Wall")
    floor.location.z, crate.location, wall.location = -10.0, (2.0, 0.0, 0.5), (4.0, 0.0, 0.5)
    wall.rotation_euler.y = radians(10.0)
    add_row(armature, floor)
    add_row(armature, crate)
    add_row(armature, wall, "OBSTACLE")
    bpy.context.view_layer.update()
    faces = ground_faces(ground_members(armature.hangtime, bpy.context.scene), 1.0)
    heights = {x: faces.below(x, 0.1) for x in (0.0, 2.0, 4.0, 30.0)}
    assert heights[30.0] is None
    assert heights[0.0].object == heights[4.0].object == floor
    assert heights[0.0].place.z == pytest.approx(0.0, abs=1e-6)
    assert heights[2.0].object == crate
    assert heights[2.0].place.z == pytest.approx(1.0)
    side = faces.seen(np.array((0.0, 0.1, 0.5)), np.array((1.0, 0.0, 0.0)))
    assert side is None


def test_a_pin_lands_where_a_platform_is_then(
    armature: bpy.types.Object, box: bpy.types.Object
) -> None:
    own_keys(box)
    bpy.context.scene.frame_set(1)
    faces = ground_faces(ground_members(armature.hangtime, bpy.context.scene), 10.0)
    assert faces.below(0.0, 0.0).place.z == pytest.approx(1.5)
    assert bpy.context.scene.frame_current == 1
