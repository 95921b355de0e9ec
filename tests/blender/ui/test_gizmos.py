"""Handles in the viewport: where they sit, and what dragging them asks for, without a window."""

from __future__ import annotations

from math import degrees, radians
from types import SimpleNamespace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

import hangtime
from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.operators.drag.limit_operator import bounds
from hangtime.operators.drag.rays import Circle, scaled, unit
from hangtime.tests.blender.helpers.overlays import (
    WHERE,
    adapted,
    bone_in_world,
    constrain,
    in_world,
    seen,
    shown,
)
from hangtime.ui.gizmos.limit_handles import chosen_places
from hangtime.ui.gizmos.pin_handles import handles as pin_handles
from hangtime.ui.gizmos.places import Knob, LimitHandlePlaces
from hangtime.ui.gizmos.shown import paint, put
from hangtime.ui.overlay.context.figure_cache import FigureCache
from hangtime.ui.overlay.context.layer import Part
from hangtime.ui.overlay.geometry import palette
from hangtime.ui.overlay.geometry.shapes import Look
from mathutils import Matrix, Vector

SIGHT = unit((0.3, -0.8, 0.4))
NEAR = 1e-4
STANCE = ((0.0, 0.0, 0.0), (0.4, 0.0, 0.0), (0.4, 0.2, 0.0))

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture(params=WHERE)
def armature(request: pytest.FixtureRequest) -> bpy.types.Object:
    return adapted(WHERE[request.param])


def limit_places(armature: bpy.types.Object) -> LimitHandlePlaces:
    return chosen_places(seen(armature), FigureCache(), SIGHT)


def knob(armature: bpy.types.Object, end: str) -> Knob:
    return next(each for each in limit_places(armature).knobs if each.end == end)


def outline(armature: bpy.types.Object) -> np.ndarray:
    """(N, 2, 3) bold lines of the limits that are drawn, world."""
    return in_world(shown(armature)[Part.LIMITS], Look.BOLD).reshape(-1, 2, 3)


GROUPS = {"HANGTIME_GGT_pins", "HANGTIME_GGT_limits"}


def off(lines: np.ndarray, at: np.ndarray) -> float:
    """How far a place is from the nearest of lines."""
    begin, way = lines[:, 0], lines[:, 1] - lines[:, 0]
    along = ((at - begin) * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), 1e-12)
    nearest = begin + np.clip(along, 0.0, 1.0)[:, None] * way
    return float(np.linalg.norm(nearest - at, axis=1).min())


# ---------------------------------------------------------------- registration


def test_groups_come_and_go_with_the_extension() -> None:
    def known() -> set[str]:
        kind = bpy.types.GizmoGroup
        return {name for name in GROUPS if kind.bl_rna_get_subclass_py(name) is not None}

    for _ in range(2):
        assert known() == GROUPS
        hangtime.unregister()
        assert known() == set()
        hangtime.register()


def test_a_handle_is_hidden_until_it_is_put_somewhere() -> None:
    """Blender draws a new one at the world's origin, in files without any armature too."""
    gizmo = SimpleNamespace(hide=False)
    paint(gizmo, palette.PIN)
    assert gizmo.hide
    put(gizmo, Vector((1.0, 2.0, 3.0)))
    assert not gizmo.hide


# ---------------------------------------------------------------- limits


@pytest.mark.parametrize("kind", [KINDS["ANGLE"], KINDS["TWIST"]])
def test_the_ends_of_a_limit_are_held_where_they_are_drawn(
    armature: bpy.types.Object, kind: ConstraintKind
) -> None:
    constrain(armature, kind, "shin", lower=-0.3, upper=0.9)
    places = limit_places(armature)
    assert [each.end for each in places.knobs] == ["lower", "upper"]
    assert places.tip is None
    for each in places.knobs:
        assert off(outline(armature), each.at) < NEAR * each.circle.radius


def test_a_limit_that_is_open_has_no_handle_there(armature: bpy.types.Object) -> None:
    constrain(armature, KINDS["ANGLE"], "shin", use_lower=False)
    assert [each.end for each in limit_places(armature).knobs] == ["upper"]


@pytest.mark.parametrize("stretch", [(1.0, 1.0), (2.0, 0.4)])
def test_a_cone_is_held_at_its_rim_and_at_its_axis(
    armature: bpy.types.Object, stretch: tuple[float, float]
) -> None:
    constrain(armature, KINDS["CONE"], "shin", half_angle=0.7, stretch=stretch)
    places = limit_places(armature)
    (rim,) = places.knobs
    chord = 0.05 * rim.circle.radius  # the rim is drawn in straight pieces
    assert off(outline(armature), rim.at) < chord
    head, _ = bone_in_world(armature, "shin")
    np.testing.assert_allclose(places.tip.centre, head, atol=NEAR)
    # at right angles to the view, where it is easiest to hold
    assert abs(rim.circle.ahead @ SIGHT) < 1e-9


def test_where_the_mouse_pulls_a_cone_its_rim_follows(armature: bpy.types.Object) -> None:
    row = constrain(armature, KINDS["CONE"], "shin", half_angle=0.5, stretch=(1.7, 0.6))
    rim = knob(armature, "half_angle")
    pulled = rim.circle.angle(rim.at - rim.circle.centre) + 0.2
    row.half_angle = scaled(pulled, rim.narrow)
    now = knob(armature, "half_angle")
    assert now.circle.angle(now.at - now.circle.centre) == pytest.approx(pulled, abs=NEAR)


def test_where_the_mouse_pulls_an_axis_the_cone_points(armature: bpy.types.Object) -> None:
    row = constrain(armature, KINDS["CONE"], "shin", half_angle=0.5)
    tip = limit_places(armature).tip
    pulled = unit(
        tip.at - tip.centre + np.array((0.3, 0.2, 0.1)) * np.linalg.norm(tip.at - tip.centre)
    )
    assert bpy.ops.hangtime.aim_cone(constraint=0, axis=tip.turn @ pulled) == {"FINISHED"}
    assert row.use_axis
    now = limit_places(armature).tip
    np.testing.assert_allclose(unit(now.at - now.centre), pulled, atol=NEAR)


def test_only_the_chosen_limit_is_held(armature: bpy.types.Object) -> None:
    constrain(armature, KINDS["ANGLE"], "shin", lower=0.0, upper=1.0)
    constrain(armature, KINDS["TORQUE"], "shin")
    constrain(armature, KINDS["CONE"], "no such bone")
    held = []
    for index in range(4):  # the last is no row at all
        armature.hangtime.active_constraint = index
        held.append(len(limit_places(armature).knobs))
    assert held == [2, 0, 0, 0]


@pytest.mark.parametrize(
    ("end", "asked", "given"),
    [
        ("upper", 50.0, 50.0),
        ("upper", -10.0, 20.0),
        ("lower", 90.0, 60.0),
        ("lower", -400.0, -180.0),
        ("half_angle", 0.0, 1.0),
        ("half_angle", 300.0, 179.0),
    ],
)
def test_an_end_goes_as_far_as_it_may(end: str, asked: float, given: float) -> None:
    armature = adapted(Matrix())
    row = constrain(armature, KINDS["ANGLE"], "shin", lower=radians(20), upper=radians(60))
    assert bpy.ops.hangtime.drag_limit(end=end, angle=radians(asked)) == {"FINISHED"}
    assert degrees(getattr(row, end)) == pytest.approx(given, abs=1e-4)


def test_an_open_end_does_not_bound_the_other() -> None:
    row = constrain(adapted(Matrix()), KINDS["ANGLE"], "shin", use_upper=False, upper=0.1)
    assert bounds(row, "lower") == (radians(-180), radians(180))


def test_a_constraint_that_is_not_there_is_said() -> None:
    constrain(adapted(Matrix()), KINDS["ANGLE"], "shin")
    for operator in (bpy.ops.hangtime.drag_limit, bpy.ops.hangtime.aim_cone):
        with pytest.raises(RuntimeError, match="no such joint limit or cone"):
            operator(constraint=7)


def test_what_the_last_solve_said_of_a_limit_is_forgotten() -> None:
    row = constrain(adapted(Matrix()), KINDS["ANGLE"], "shin")
    row.status = "Met"
    bpy.ops.hangtime.drag_limit(end="upper", angle=0.3)
    assert row.status == ""


# ---------------------------------------------------------------- pins


@pytest.fixture
def standing() -> bpy.types.Object:
    """With a stance of three contacts, one of which is chosen, and another stance of one."""
    armature = adapted(Matrix())
    settings = armature.hangtime
    settings.contacts.clear()
    for index, at in enumerate(((5.0, 5.0, 0.0), *STANCE)):
        row = settings.contacts.add()
        row.name, row.phase = f"Heel {index}", f"ground {1 + (index > 0)}"
        row.point, row.at, row.found_at = row.name, at, at
    for name in ("ground 1", "ground 2"):
        stance = settings.stances.add()
        stance.name, stance.forward_axis = name, (0.0, -1.0, 0.0)
    settings.active_contact = 2
    return armature


def places_of(armature: bpy.types.Object) -> list[Vector]:
    return [Vector(row.at) for row in armature.hangtime.contacts]


def test_contacts_that_count_and_placed_points_are_held(standing: bpy.types.Object) -> None:
    settings = standing.hangtime
    settings.contacts[3].used = False
    constrain(standing, KINDS["POINT"], "foot")
    constrain(standing, KINDS["POINT"], "foot", use_place=True, place=(1.0, 2.0, 3.0))
    constrain(standing, KINDS["POINT"], "foot", use_place=True, target=standing)
    found = pin_handles(seen(standing))
    assert [(h.contact, h.constraint, h.near) for h in found] == [
        (0, -1, False),
        (1, -1, True),
        (2, -1, True),
        (-1, 1, True),
    ]
    assert found[2].at == Vector(settings.contacts[2].at)
    assert found[-1].at == Vector((1.0, 2.0, 3.0))


def test_a_contact_is_dragged_with_its_stance_or_alone(standing: bpy.types.Object) -> None:
    was, shift = places_of(standing), Vector((0.1, 0.2, 0.3))
    for alone, said, moving in (
        (False, {}, {1, 2, 3}),
        (True, {}, {2}),
        (True, {"whole": True}, {1, 2, 3}),
        (False, {"whole": False}, {2}),
    ):
        standing.hangtime.whole_stance = not alone
        bpy.ops.hangtime.drag_pin(contact=2, shift=shift, **said)
        now = places_of(standing)
        assert {i for i in range(4) if (now[i] - was[i]).length > 0.1} == moving
        bpy.ops.hangtime.drag_pin(contact=2, shift=-shift, **said)


def test_a_point_that_is_dragged_gets_a_place_of_its_own(standing: bpy.types.Object) -> None:
    row = constrain(standing, KINDS["POINT"], "foot", place=(1.0, 0.0, 0.0))
    assert bpy.ops.hangtime.drag_pin(constraint=0, shift=(0.0, 0.5, 0.0)) == {"FINISHED"}
    assert row.use_place
    assert Vector(row.place) == Vector((1.0, 0.5, 0.0))


def test_a_pin_that_is_not_there_is_said(standing: bpy.types.Object) -> None:
    for wrong in ({"contact": 9}, {"constraint": 0}):
        with pytest.raises(RuntimeError, match="no such contact or point"):
            bpy.ops.hangtime.drag_pin(**wrong)
    assert len(standing.hangtime.contacts) == 4


def test_a_stance_turns_about_its_middle(standing: bpy.types.Object) -> None:
    middle = sum(map(Vector, STANCE), Vector()) / 3
    assert bpy.ops.hangtime.turn_stance(by=radians(90.0)) == {"FINISHED"}
    for at, now in zip(STANCE, places_of(standing)[1:], strict=True):
        arm = Vector(at) - middle
        np.testing.assert_allclose(now - middle, (-arm.y, arm.x, 0.0), atol=1e-6)
    assert standing.hangtime.stances[1].turn == pytest.approx(radians(90.0))


def test_moving_a_stance_turns_it_by_nothing(standing: bpy.types.Object) -> None:
    bpy.ops.hangtime.drag_pin(contact=2, shift=(0.123, -0.456, 0.7))
    assert standing.hangtime.stances[1].turn == 0.0


def test_a_stance_cannot_turn_without_a_chosen_contact(standing: bpy.types.Object) -> None:
    standing.hangtime.active_contact = -1
    with pytest.raises(RuntimeError, match="Choose a contact of the stance first"):
        bpy.ops.hangtime.turn_stance(by=1.0)


def test_circles_of_handles_are_round(armature: bpy.types.Object) -> None:
    """What a drag is told of: unit vectors at right angles, and the handle on them."""
    constrain(armature, KINDS["TWIST"], "shin", lower=-0.3, upper=0.9)
    for each in limit_places(armature).knobs:
        circle: Circle = each.circle
        axes = np.stack([circle.zero, circle.ahead])
        np.testing.assert_allclose(axes @ axes.T, np.eye(2), atol=1e-5)
        assert np.linalg.norm(each.at - circle.centre) == pytest.approx(circle.radius, rel=NEAR)
        angle = circle.angle(each.at - circle.centre)
        assert angle == pytest.approx({"lower": -0.3, "upper": 0.9}[each.end], abs=NEAR)
