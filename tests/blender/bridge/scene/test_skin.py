"""The skin as points with their bones: whatever transforms, modifiers and visibility it has."""

from __future__ import annotations

from math import radians

import bpy
import numpy as np
import pytest
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.scene.skin import POINTS, SkinReading, Unusable, read_skin
from hangtime.solver.body.character import build_character
from hangtime.solver.data.recording import Recording
from hangtime.solver.solid.flesh import flesh_of
from hangtime.tests.blender.helpers.skins import make_skin
from mathutils import Matrix

pytestmark = pytest.mark.usefixtures("_enabled")

GIRTHS = {"LeftLeg": 0.05, "LeftForeArm": 0.035, "RightUpLeg": 0.07}
NEAR = 0.03  # of its radius, of 24 corners around


@pytest.fixture
def figure(jump: bpy.types.Object) -> bpy.types.Object:
    """The recorded jump, somewhere in its midst."""
    bpy.context.scene.frame_set(150)
    return jump


def read(armature: bpy.types.Object) -> tuple[SkinReading, Recording]:
    recording = read_recording(armature, first=73, last=120)
    return complete(read_skin(armature, recording.frames)), recording


def girths(armature: bpy.types.Object) -> dict[str, float]:
    """Radii found, m, by bones' names."""
    reading, recording = read(armature)
    character = build_character(recording)
    found = flesh_of(reading.skin, recording, character)
    return {character.bodies[i].bone: flesh.radius for i, flesh in found.items()}


def test_tubes_about_bones_are_found_whatever_the_pose(figure: bpy.types.Object) -> None:
    before = bpy.context.scene.frame_current, figure.data.pose_position
    make_skin(figure, GIRTHS)
    assert girths(figure) == pytest.approx(GIRTHS, rel=NEAR)
    assert (bpy.context.scene.frame_current, figure.data.pose_position) == before


@pytest.mark.parametrize(
    "world",
    [
        Matrix.Diagonal((0.01, 0.01, 0.01, 1.0)),
        Matrix.Diagonal((-2.0, 0.5, 1.0, 1.0)),
        Matrix.Translation((3.0, -2.0, 1.0)) @ Matrix.Rotation(radians(70.0), 4, "X"),
    ],
    ids=["centimetres", "mirrored and uneven", "elsewhere"],
)
def test_the_meshs_own_transform_does_not_matter(figure: bpy.types.Object, world: Matrix) -> None:
    make_skin(figure, GIRTHS, world=world)
    assert girths(figure) == pytest.approx(GIRTHS, rel=NEAR)


def test_a_parented_mesh_counts_and_a_hidden_one(figure: bpy.types.Object) -> None:
    skin = make_skin(figure, GIRTHS)
    skin.modifiers.clear()
    skin.parent, skin.parent_type = figure, "ARMATURE"
    skin.matrix_parent_inverse = figure.matrix_world.inverted()
    skin.hide_set(True)
    assert girths(figure) == pytest.approx(GIRTHS, rel=NEAR)
    assert skin.hide_get()
    skin.hide_viewport = True
    assert girths(figure) == pytest.approx(GIRTHS, rel=NEAR)
    assert skin.hide_viewport


def test_modifiers_count(figure: bpy.types.Object) -> None:
    skin = make_skin(figure, {"LeftLeg": 0.05, "LeftArm": 0.04})
    thicker = skin.modifiers.new("Thicker", "DISPLACE")
    thicker.mid_level, thicker.strength = 0.0, -0.01  # the tubes' faces look inwards
    assert girths(figure) == pytest.approx({"LeftLeg": 0.06, "LeftArm": 0.05}, rel=NEAR)


def test_several_meshes_count_by_their_faces(figure: bpy.types.Object) -> None:
    make_skin(figure, {"LeftLeg": 0.05}, name="Trousers")
    make_skin(figure, {"LeftForeArm": 0.035}, name="Shirt")
    reading, _ = read(figure)
    assert reading.skin is not None
    assert set(reading.skin.meshes) == {"Trousers", "Shirt"}
    assert len(reading.skin.points) == pytest.approx(POINTS, abs=2)
    assert girths(figure) == pytest.approx({"LeftLeg": 0.05, "LeftForeArm": 0.035}, rel=NEAR)


def test_a_vertex_belongs_to_the_bone_that_moves_it_most(figure: bpy.types.Object) -> None:
    skin = make_skin(figure, {"LeftLeg": 0.05})
    every = list(range(len(skin.data.vertices)))
    skin.vertex_groups.new(name="LeftFoot").add(every, 0.4, "REPLACE")
    skin.vertex_groups.new(name="Selection").add(every, 1.0, "REPLACE")
    assert set(girths(figure)) == {"LeftLeg"}


def test_a_prop_on_a_bone_is_no_skin(figure: bpy.types.Object) -> None:
    sword = make_skin(figure, {"LeftHand": 0.05})
    sword.modifiers.clear()
    sword.parent, sword.parent_type, sword.parent_bone = figure, "BONE", "LeftHand"
    assert read(figure)[0] == SkinReading()


def test_what_tells_nothing_is_told(figure: bpy.types.Object) -> None:
    make_skin(figure, {"LeftLeg": 0.05}, name="Wrong", groups={"LeftLeg": "Unterschenkel"})
    make_skin(figure, {"LeftLeg": 0.05}, name="Bare").vertex_groups.clear()
    cloud = make_skin(figure, {"LeftLeg": 0.05}, name="Cloud")
    cloud.data.clear_geometry()
    cloud.vertex_groups.new(name="LeftLeg")
    assert read(figure)[0] == SkinReading(
        None,
        {"Wrong": Unusable.NO_BONE, "Bare": Unusable.NO_BONE, "Cloud": Unusable.NO_FACES},
    )


def test_points_are_spread_over_faces_not_over_vertices(figure: bpy.types.Object) -> None:
    skin = make_skin(figure, {"LeftLeg": 0.05, "RightUpLeg": 0.05})
    reading, _ = read(figure)
    assert reading.skin is not None
    owners = [reading.skin.bones[i] for i in reading.skin.owners]
    lengths = {bone: figure.data.bones[bone].length for bone in ("LeftLeg", "RightUpLeg")}
    share = owners.count("LeftLeg") / len(owners)
    assert share == pytest.approx(lengths["LeftLeg"] / sum(lengths.values()), abs=0.01)
    assert np.isfinite(reading.skin.points).all()
    assert skin.name in bpy.data.objects
