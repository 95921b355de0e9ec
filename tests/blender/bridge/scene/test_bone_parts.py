"""Another character as an obstacle: its mesh moves as the bones do that carry it."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.scene.read import changed_objects
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.scene.checks import check_scene
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.skins import make_skin
from hangtime.tests.blender.helpers.solids import FRAMES, add_row, in_world, make_armature, read
from mathutils import Matrix, Vector

pytestmark = pytest.mark.usefixtures("_enabled")
THIN = 0.004  # m, by which hulls about tubes of 24 sides may lack them


@pytest.fixture
def performer() -> bpy.types.Object:
    return make_armature()


@pytest.fixture
def partner(performer: bpy.types.Object) -> bpy.types.Object:
    """The mesh of another figure that moves, two metres away, as an obstacle."""
    other = rigs.make_armature(name="Partner")
    girths = {bone.name: 0.06 for bone in other.data.bones if bone.length > 0.1}
    skin = make_skin(other, girths, name="Body", longer=0.1)
    skin.parent = other
    other.location.x = 2.0
    rigs.animate(other, frames=range(1, 12))
    bpy.context.view_layer.update()
    add_row(performer, skin, "OBSTACLE")
    return skin


def seen(skin: bpy.types.Object, frame: float) -> np.ndarray:
    """(V, 3) its vertices in the world at a frame, by Blender alone."""
    bpy.context.scene.frame_set(int(frame))
    posed = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = posed.to_mesh()
    places = np.array([tuple(posed.matrix_world @ v.co) for v in mesh.vertices])
    posed.to_mesh_clear()
    return places


def owned(skin: bpy.types.Object, bone: str) -> list[int]:
    group = skin.vertex_groups[bone].index
    return [v.index for v in skin.data.vertices if any(g.group == group for g in v.groups)]


@pytest.mark.parametrize("unit", [1.0, 0.01])
def test_each_bone_s_part_goes_with_it(
    performer: bpy.types.Object, partner: bpy.types.Object, unit: float
) -> None:
    bpy.context.scene.unit_settings.scale_length = unit
    partner.parent.scale *= 1.0 / unit
    bpy.context.view_layer.update()
    reading = read(performer)
    check_scene(MotionProblem(scene=reading.objects))  # closed, and not inside out
    assert reading.reshaped == ()
    assert {part.whole for part in reading.objects} == {"Body"}
    for part in reading.objects:
        carried = owned(partner, part.name.removeprefix("Body, "))
        for instant in (0, 4, 9):
            mesh = unit * seen(partner, FRAMES[instant])[carried]
            hull = in_world(part, instant)
            for way in (*np.eye(3), *-np.eye(3)):  # the extents of both
                assert (hull @ way).max() == pytest.approx((mesh @ way).max(), abs=THIN)


def test_small_parts_go_with_what_they_hang_on(
    performer: bpy.types.Object, partner: bpy.types.Object
) -> None:
    before = {part.name for part in read(performer).objects}
    tip = max(
        (b for b in partner.parent.data.bones if f"Body, {b.name}" in before),
        key=lambda bone: len(bone.parent_recursive),
    )
    middle = np.mean([tuple(partner.data.vertices[i].co) for i in owned(partner, tip.name)], axis=0)
    for i in owned(partner, tip.name):
        vertex = partner.data.vertices[i]
        vertex.co = Vector(middle) + 0.1 * (vertex.co - Vector(middle))
    assert before - {part.name for part in read(performer).objects} == {f"Body, {tip.name}"}


def test_what_holds_still_keeps_its_own_shape(
    performer: bpy.types.Object, partner: bpy.types.Object
) -> None:
    partner.parent.animation_data_clear()
    (only,) = read(performer).objects
    assert (only.name, only.part_of) == ("Body", "")
    assert len(only.vertices) == len(partner.data.vertices)


@pytest.mark.parametrize("why", ["ground", "a hurdle", "its own", "a vertex is no bone's"])
def test_else_the_first_shape_counts_and_is_told(
    performer: bpy.types.Object, partner: bpy.types.Object, why: str
) -> None:
    (row,) = performer.hangtime.surfaces
    if why == "its own":
        rigs.animate(performer, frames=range(1, 12))
        row.object = make_skin(performer, {performer.data.bones[0].name: 0.1}, name="Body 2")
    elif why == "a vertex is no bone's":
        partner.vertex_groups[0].remove([0])
        for group in partner.vertex_groups:
            group.remove([0])
    else:
        row.role = "GROUND" if why == "ground" else "CLEAR"
    reading = read(performer)
    assert [thing.name for thing in reading.objects] == [row.object.name]
    assert reading.reshaped == (row.object.name,)


def test_it_is_told_by_its_own_name_when_it_changes(
    performer: bpy.types.Object, partner: bpy.types.Object
) -> None:
    before = read(performer)
    assert changed_objects(before, read(performer)) == ()
    partner.parent.matrix_world = Matrix.Translation((0.0, 0.1, 0.0)) @ partner.parent.matrix_world
    assert changed_objects(before, read(performer)) == ("Body",)


def test_the_armature_selects_what_it_bends(
    performer: bpy.types.Object, partner: bpy.types.Object
) -> None:
    performer.hangtime.surfaces.clear()
    bpy.context.view_layer.objects.active = performer
    bpy.ops.object.select_all(action="DESELECT")
    for each in (performer, partner.parent):
        each.select_set(True)
    assert bpy.ops.hangtime.add_surfaces(role="OBSTACLE") == {"FINISHED"}
    assert [row.object for row in performer.hangtime.surfaces] == [partner]
