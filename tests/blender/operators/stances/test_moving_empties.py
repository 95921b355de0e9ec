"""Empties that move in time: where they are as the stance begins is where their contacts go."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.properties.stances import stance_frames
from hangtime.bridge.scene.moving_empties import LeftEmpty, take_places
from hangtime.tests.blender.helpers.actions import curves_of
from hangtime.tests.blender.helpers.jump_scene import landing
from hangtime.tests.blender.helpers.solids import make_box

SPEED = 0.01  # m a frame
NEAR = 1e-4
FALLS = 60  # frames, before the stance begins

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture
def truck(analysed: bpy.types.Object) -> bpy.types.Object:
    """A box that moves; on it hang the empties of all contacts of the landing, from where these
    are recorded as the stance begins."""
    box, settings = make_box("Truck", (0.0, 0.0, -0.5)), analysed.hangtime
    begins = start(settings)
    for frame in (begins - 300.0, begins + 300.0):
        box.location.x = SPEED * (frame - begins)
        box.keyframe_insert("location", frame=frame)
    for curve in curves_of(box):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    bpy.context.view_layer.objects.active = analysed
    for row in landing(settings):
        settings.active_contact = settings.contacts.find(row.name)
        bpy.ops.hangtime.place_by_empty()
    bpy.context.scene.frame_set(int(begins), subframe=begins % 1.0)
    for row in landing(settings):
        row.empty.parent, row.empty.matrix_parent_inverse = box, box.matrix_world.inverted()
    bpy.context.view_layer.update()
    return box


def start(settings: bpy.types.PropertyGroup) -> float:
    frames = stance_frames(settings, "ground 2")
    assert frames is not None
    return frames[0]


def shifts(settings: bpy.types.PropertyGroup) -> np.ndarray:
    return np.array([np.subtract(row.place, row.found_at) for row in landing(settings)])


def taken(armature: bpy.types.Object) -> tuple[LeftEmpty, ...]:
    return complete(take_places(armature.hangtime, lambda: bpy.context.temp_override()))


def test_the_frame_that_is_shown_is_nothing_to_them(
    analysed: bpy.types.Object, truck: bpy.types.Object
) -> None:
    for frame in (int(start(analysed.hangtime)) - 60, 250):
        bpy.context.scene.frame_set(frame)
        truck.update_tag()
        bpy.context.view_layer.update()
        taken(analysed)
        np.testing.assert_allclose(shifts(analysed.hangtime), 0.0, atol=NEAR)


def test_they_go_where_the_truck_goes(analysed: bpy.types.Object, truck: bpy.types.Object) -> None:
    truck.delta_location.y = 0.2
    taken(analysed)
    wanted = np.tile((0.0, 0.2, 0.0), (len(landing(analysed.hangtime)), 1))
    np.testing.assert_allclose(shifts(analysed.hangtime), wanted, atol=NEAR)
    assert abs(analysed.hangtime.stances["ground 2"].turn) < NEAR


def test_one_takes_along_what_has_none(analysed: bpy.types.Object, truck: bpy.types.Object) -> None:
    rows = landing(analysed.hangtime)
    for row in rows[1:]:
        row.empty = None
    truck.delta_location.y = 0.2
    taken(analysed)
    np.testing.assert_allclose(shifts(analysed.hangtime)[:, 1], 0.2, atol=NEAR)
    analysed.hangtime.whole_stance = False
    truck.delta_location.y = 0.3
    taken(analysed)
    wanted = [0.3, *[0.2] * (len(rows) - 1)]
    np.testing.assert_allclose(shifts(analysed.hangtime)[:, 1], wanted, atol=NEAR)


@pytest.mark.usefixtures("truck")
def test_a_place_that_is_typed_at_another_frame_stays(analysed: bpy.types.Object) -> None:
    bpy.context.scene.frame_set(250)
    analysed.hangtime.stances["ground 2"].up = 0.1
    bpy.context.view_layer.update()
    taken(analysed)
    np.testing.assert_allclose(shifts(analysed.hangtime)[:, 2], 0.1, atol=NEAR)


def test_those_that_go_on_are_told_unless_the_contact_rides(
    analysed: bpy.types.Object, truck: bpy.types.Object
) -> None:
    settings = analysed.hangtime
    left = {each.contact: each for each in taken(analysed)}
    assert set(left) == {row.name for row in landing(settings)}
    for row in landing(settings):
        told = left[row.name]
        assert told.away == pytest.approx(SPEED * (row.end_frame - start(settings)), rel=1e-3)
        row.on = truck
    truck.delta_location.z = 0.1  # where it stands is the truck's affair
    assert taken(analysed) == ()
    assert all(row.on == truck for row in landing(settings))


@pytest.mark.slow
def test_adapt_names_them(
    analysed: bpy.types.Object, truck: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    analysed.hangtime.keep_times = True
    truck.delta_location.y = 0.1
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    told = capfd.readouterr().out
    assert "“Left toe 2”" in told
    assert "placed by empties that move on" in told
    np.testing.assert_allclose(shifts(analysed.hangtime)[:, 1], 0.1, atol=NEAR)


def test_a_body_that_was_never_played_takes_them_where_it_falls(analysed: bpy.types.Object) -> None:
    settings, scene = analysed.hangtime, bpy.context.scene
    begins = int(start(settings))
    scene.frame_set(begins - FALLS)
    box = make_box("Truck", (0.0, 0.0, 50.0))
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    cache = scene.rigidbody_world.point_cache
    cache.frame_start, cache.frame_end = begins - FALLS, begins + FALLS
    bpy.context.view_layer.objects.active = analysed
    for row in landing(settings):
        settings.active_contact = settings.contacts.find(row.name)
        bpy.ops.hangtime.place_by_empty()
        row.empty.parent, row.empty.matrix_parent_inverse = box, box.matrix_world.inverted()
    bpy.context.view_layer.update()
    taken(analysed)
    seconds = FALLS * scene.render.fps_base / scene.render.fps
    fallen = -0.5 * 9.81 * seconds**2
    assert shifts(settings)[:, 2] == pytest.approx(fallen, rel=0.15)
