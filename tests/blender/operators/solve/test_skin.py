"""A skinned figure: its shapes are the mesh's, in the overlay, in the solve and in words."""

from __future__ import annotations

import bpy
import pytest
from hangtime.bridge.armature.traces_store import kept
from hangtime.bridge.constraints.rows import add_body_change
from hangtime.bridge.rows.choices import BodyKind
from hangtime.solver.solid.shapes import SOLID_SHARE
from hangtime.tests.blender.helpers.skins import make_skin

pytestmark = pytest.mark.usefixtures("_enabled")

THIN = 0.6  # of the shank's shape from its bone


def shank(armature: bpy.types.ID) -> float:
    """Radius, m, of the left shank's shape as the overlay has it."""
    stored = kept(armature)
    assert stored is not None
    return float(stored.traces.solid_radii[stored.traces.solids.index("left shank")])


def analyse() -> None:
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


@pytest.mark.slow
def test_shapes_are_the_meshs_unless_the_bones_are_chosen(jump: bpy.types.Object) -> None:
    analyse()
    from_bones = shank(jump)
    assert jump.hangtime.shapes_told == ""
    girth = THIN * from_bones / SOLID_SHARE
    make_skin(jump, {"LeftLeg": girth, "RightLeg": girth}, name="Stockings")
    analyse()
    assert shank(jump) == pytest.approx(SOLID_SHARE * girth, rel=0.03)
    told, rest = jump.hangtime.shapes_told.splitlines()
    assert told.startswith("2 of ")
    assert told.endswith(" bodies have the shape of Stockings")
    assert rest == "From the bones: all but left shank, right shank"
    jump.hangtime.shapes = "BONES"
    analyse()
    assert shank(jump) == from_bones


@pytest.mark.slow
def test_a_result_has_the_meshs_shapes_times_the_thickness(jump: bpy.types.Object) -> None:
    make_skin(jump, {"LeftLeg": 0.04}, name="Stocking")
    analyse()
    add_body_change(jump.hangtime, BodyKind.SHAPE, ["LeftLeg"]).thickness = 1.5
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert shank(jump.animation_data.action) == pytest.approx(1.5 * SOLID_SHARE * 0.04, rel=0.03)


def test_a_mesh_that_tells_nothing_is_told_and_changes_nothing(jump: bpy.types.Object) -> None:
    analyse()
    from_bones = shank(jump)
    make_skin(jump, {"LeftLeg": 0.03}, name="Doll", groups={"LeftLeg": "Unterschenkel"})
    analyse()
    assert shank(jump) == from_bones
    assert jump.hangtime.shapes_told.startswith(
        "Doll tells no shapes: no vertex group is called as a bone; bind it by Parent > "
    )


def test_a_mesh_on_which_no_body_is_found_is_told(jump: bpy.types.Object) -> None:
    """Its groups are bones, but a brooch is around none of them."""
    make_skin(jump, {"LeftLeg": 0.0005}, name="Brooch")
    bpy.data.objects["Brooch"].location.x = 0.3
    analyse()
    assert jump.hangtime.shapes_told.startswith("0 of ")
    assert "From the bones: all, since" in jump.hangtime.shapes_told
