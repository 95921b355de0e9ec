"""Targets that constraints follow, and what is wrong with the lists' rows."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.constraints.requests import joined
from hangtime.bridge.constraints.rows import add_body_change
from hangtime.bridge.rows.choices import BodyKind
from hangtime.operators.words.messages import sentence
from hangtime.solver.data import faults, requests
from hangtime.solver.data.requests import When
from hangtime.solver.data.solver_options import Method, SolverOptions
from hangtime.tests.blender.helpers.rows import added, asked, make_rig

pytestmark = pytest.mark.usefixtures("_enabled")

FLIGHT = When(phase="flight 1")


@pytest.fixture
def rig() -> bpy.types.Object:
    return make_rig()


# ---------------------------------------------------------------- targets


def target_at(place: tuple[float, float, float]) -> bpy.types.Object:
    target = bpy.data.objects.new("Ball", None)
    bpy.context.scene.collection.objects.link(target)
    target.location = place
    return target


def keyed(target: bpy.types.Object) -> None:
    target.keyframe_insert("location", frame=1)
    target.location.x += 10.0
    target.keyframe_insert("location", frame=11)


def carried(target: bpy.types.Object) -> None:
    """On a parent that moves, and hidden."""
    parent = bpy.data.objects.new("Cart", None)
    bpy.context.scene.collection.objects.link(parent)
    keyed(parent)
    target.parent = parent
    target.hide_viewport = True


@pytest.mark.parametrize("moving", [keyed, carried])
def test_a_point_follows_its_target_and_the_scene_stays(
    rig: bpy.types.Object, moving: Callable[[bpy.types.Object], None]
) -> None:
    scene = bpy.context.scene
    scene.unit_settings.scale_length = 0.5
    target = target_at((1.0, 2.0, 3.0))
    moving(target)
    hidden = target.hide_viewport
    added(rig, KINDS["POINT"], "foot", span="FRAMES", first_frame=4, last_frame=9)
    rig.hangtime.constraints[0].target = target
    scene.frame_set(7, subframe=0.25)
    target.name = "Renamed"  # which its pointer survives
    (point,) = asked(rig).points
    assert (scene.frame_current, scene.frame_subframe) == (7, 0.25)
    assert target.hide_viewport == hidden
    assert point.place is None
    frames = point.path.frames  # all in which it moves, for the result may be retimed
    assert frames[0] < 4.0
    assert frames == tuple(np.arange(frames[0], 12.0))
    target.hide_viewport = False
    for frame, place in zip(point.path.frames, point.path.places, strict=True):
        scene.frame_set(int(frame))
        assert place == pytest.approx(tuple(0.5 * target.matrix_world.translation), abs=1e-5)
    assert point.path.places[-1][0] > point.path.places[0][0] + 1.0


def test_a_target_at_rest_is_one_place(rig: bpy.types.Object) -> None:
    added(rig, KINDS["POINT"], "foot", span="PHASE", target=target_at((1.0, 2.0, 3.0)))
    (point,) = asked(rig).points
    assert point.path.places == ((1.0, 2.0, 3.0),)


def test_a_target_is_sampled_as_late_as_the_result_may_reach_its_row(rig: bpy.types.Object) -> None:
    target = target_at((0.0, 0.0, 0.0))
    target.keyframe_insert("location", frame=1)
    target.location.x = 1.0
    target.keyframe_insert("location", frame=1000)
    added(rig, KINDS["POINT"], "foot", span="FRAME", first_frame=4, target=target)
    added(rig, KINDS["HOLD"], name="Wait", first_frame=3, seconds=10.0)
    (point,) = asked(rig).points
    scene = bpy.context.scene.render
    assert point.path.frames[-1] >= 4.0 + 10.0 * scene.fps / scene.fps_base


# ---------------------------------------------------------------- faults


def no_bone(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], name="Mine")


def lost_bone(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "finger", name="Mine")
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.remove(rig.data.edit_bones["finger"])
    bpy.ops.object.mode_set(mode="OBJECT")


def unknown_phase(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Mine", phase="flight 7")


def no_phase(rig: bpy.types.Object) -> None:
    added(rig, KINDS["TIMING"], name="Mine", phase="")


def empty_range(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Mine", span="FRAMES", last_frame=2.0)


def same_names(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Mine")
    add_body_change(rig.hangtime, BodyKind.LOAD, ["head"]).name = "Mine"


def contacts_name(rig: bpy.types.Object) -> None:
    rig.hangtime.contacts[0].name = "Mine"
    added(rig, KINDS["CONE"], "thigh", name="Mine")


def crossed_bounds(rig: bpy.types.Object) -> None:
    added(rig, KINDS["POINT"], "foot", name="Mine", use_bounds=True, at_least=(0.5, 0, 0))


def crossed_angles(rig: bpy.types.Object) -> None:
    added(rig, KINDS["ANGLE"], "shin", name="Mine", lower=pi, upper=1.0)


def no_bounds(rig: bpy.types.Object) -> None:
    unbounded = (False, False, False)
    added(rig, KINDS["POINT"], "foot", name="Mine", use_bounds=True, bound_axes=unbounded)


def no_limits(rig: bpy.types.Object) -> None:
    added(rig, KINDS["ANGLE"], "shin", name="Mine", use_lower=False, use_upper=False)


def no_force(rig: bpy.types.Object) -> None:
    added(rig, KINDS["FORCE"], name="Mine", use_peak=False)


def no_normal(rig: bpy.types.Object) -> None:
    added(
        rig,
        KINDS["POINT"],
        "foot",
        name="Mine",
        environment=True,
        use_normal=True,
        normal=(0.0,) * 3,
    )


@pytest.mark.parametrize(
    ("spoil", "fault"),
    [
        (no_bone, faults.NoBoneChosen("Mine")),
        (lost_bone, faults.UnknownBone("Mine", "finger")),
        (
            unknown_phase,
            faults.UnknownPhaseIn("Mine", "flight 7", ("ground 1", "flight 1", "ground 2")),
        ),
        (no_phase, faults.NoPhaseChosen("Mine", ("ground 1", "flight 1", "ground 2"))),
        (empty_range, faults.EmptyRange("Mine", 3.0, 2.0)),
        (same_names, faults.NamedTwice("Mine")),
        (contacts_name, faults.NamedTwice("Mine")),
        (crossed_bounds, faults.CrossedBounds("Mine", 0.5, 0.0, "m")),
        (crossed_angles, faults.CrossedBounds("Mine", 180.0, np.degrees(1.0), "°")),
        (no_bounds, faults.AsksNothing("Mine")),
        (no_limits, faults.AsksNothing("Mine")),
        (no_force, faults.AsksNothing("Mine")),
        (no_normal, faults.NoDirection("Mine")),
    ],
)
def test_a_row_that_asks_for_nonsense_is_named(
    rig: bpy.types.Object, spoil: Callable[[bpy.types.Object], None], fault: faults.Fault
) -> None:
    spoil(rig)
    with pytest.raises(type(fault)) as caught:
        asked(rig)
    for name, value in vars(fault).items():
        close = pytest.approx(value, abs=1e-4) if isinstance(value, float) else value
        assert getattr(caught.value, name) == close
    assert "“Mine”" in sentence(caught.value)


def test_a_row_without_a_name_is_told_by_its_kind(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name=" ")
    with pytest.raises(faults.NameMissing) as caught:
        asked(rig)
    assert "Cone" in sentence(caught.value)


def test_lists_and_text_are_joined_and_may_not_share_a_name(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], "thigh", name="Mine")
    rig.hangtime.gravity = 1.62
    hold = requests.Hold("Hang", 8.0, 1.0)
    solution = SolverOptions(method=Method.EXPLICIT)
    both = joined(asked(rig), requests.Requests(holds=(hold,), solution=solution))
    assert both.names == ("Mine", "Hang")
    assert (both.solution, both.body.gravity) == (solution, 1.62)
    with pytest.raises(faults.NamedTwice):
        joined(asked(rig), requests.Requests(holds=(requests.Hold("Mine", 8.0, 1.0),)))


def test_a_hold_is_a_phase_that_others_may_name(rig: bpy.types.Object) -> None:
    added(rig, KINDS["HOLD"], name="Hang")
    added(rig, KINDS["POSE"], name="Tuck", span="PHASE", phase="Hang")
    assert asked(rig).poses[0].when == When("Hang")
