"""What the lists of constraints and body changes ask for, and what is wrong with their rows."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.constraints.requests import joined
from hangtime.bridge.constraints.rows import add_body_change
from hangtime.bridge.rows.choices import BodyKind, Span
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.operators.words.messages import sentence
from hangtime.solver.data import faults, requests
from hangtime.solver.data.requests import When
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.rows import IN_FLIGHT, added, asked, make_rig
from mathutils import Vector

pytestmark = pytest.mark.usefixtures("_enabled")

FLIGHT = When(phase="flight 1")


@pytest.fixture
def rig() -> bpy.types.Object:
    return make_rig()


# ---------------------------------------------------------------- each kind's record


@pytest.mark.parametrize(
    ("kind", "bones", "fields", "field", "record"),
    [
        (
            KINDS["LIFT"],
            ("foot",),
            {"name": "Hop"},
            "lifts",
            requests.Lift("Hop", "ground 1", ("foot",)),
        ),
        (
            KINDS["ANGLE"],
            ("shin",),
            {"name": "Knee", "lower": 0.25, "use_upper": False},
            "angles",
            requests.AngleLimit("Knee", "shin", 0.25, None, FLIGHT),
        ),
        (
            KINDS["TWIST"],
            ("thigh",),
            {"name": "Hip", "use_lower": False, "upper": 0.5},
            "twists",
            requests.TwistLimit("Hip", "thigh", None, 0.5, FLIGHT),
        ),
        (
            KINDS["CONE"],
            ("thigh",),
            {"name": "Leg", "half_angle": 0.5, "use_axis": True, "axis": (0.0, 0.0, -1.0)}
            | {"stretch": (1.0, 2.0)},
            "cones",
            requests.ConeLimit("Leg", "thigh", 0.5, (0.0, 0.0, -1.0), (1.0, 2.0), FLIGHT),
        ),
        (
            KINDS["CONE"],
            ("thigh",),
            {"name": "Leg", "half_angle": 0.5, "span": Span.ALWAYS.name},
            "cones",
            requests.ConeLimit("Leg", "thigh", 0.5),
        ),
        (
            KINDS["TORQUE"],
            ("foot", "shin"),
            {"name": "Weak", "torque": 60.0, "use_dof": True, "dof": 1, "torque_value": 5.0},
            "torques",
            requests.TorqueLimit(
                "Weak", ("foot", "shin"), bound=60.0, value=5.0, dof=1, when=FLIGHT
            ),
        ),
        (
            KINDS["TORQUE"],
            ("foot",),
            {"name": "Weak", "torque_by": "SHARE", "share": 0.5},
            "torques",
            requests.TorqueLimit("Weak", ("foot",), share=0.5, when=FLIGHT),
        ),
        (
            KINDS["POSE"],
            ("thigh",),
            {"name": "Tuck", "source": "REST", "use_pose_frame": True, "slack": 0.25},
            "poses",
            requests.PoseRequest(
                "Tuck",
                When(frames=(IN_FLIGHT, IN_FLIGHT)),
                ("thigh",),
                requests.Reference.REST,
                slack=0.25,
            ),
        ),
        (
            KINDS["POSE"],
            (),
            {"name": "Tuck", "span": "PHASE", "instant": "APEX", "hard": False, "weight": 2.0}
            | {"use_pose_frame": True, "pose_frame": 4.0, "slack": 0.25},
            "poses",
            requests.PoseRequest(
                "Tuck", When("flight 1", moment=requests.Moment.APEX), frame=4.0, weight=2.0
            ),
        ),
        (
            KINDS["ORIENTATION"],
            ("hips",),
            {"name": "Turn", "turn": 0.5, "tilt": 0.25, "slack": 0.125},
            "orientations",
            requests.OrientationRequest(
                "Turn", "hips", When(frames=(IN_FLIGHT, IN_FLIGHT)), 0.5, 0.25, 0.125
            ),
        ),
        (
            KINDS["FORCE"],
            (),
            {"name": "Soft", "peak": 2.5},
            "forces",
            requests.ForceRequest("Soft", peak=2.5, when=When("ground 1")),
        ),
        (
            KINDS["FORCE"],
            ("foot",),
            {"name": "Ice", "use_peak": False, "use_friction": True, "friction": 0.25}
            | {"shape": "PYRAMID", "use_match": True, "match": 8.0, "span": "ALWAYS"},
            "forces",
            requests.ForceRequest(
                "Ice", 0.25, requests.ConeShape.PYRAMID, match=8.0, touching=("foot",)
            ),
        ),
        (
            KINDS["TIMING"],
            (),
            {"name": "Slow", "factor": 1.5},
            "timings",
            requests.PhaseTiming("Slow", "flight 1", factor=1.5),
        ),
        (
            KINDS["TIMING"],
            (),
            {"name": "Slow", "timing_by": "SECONDS", "seconds": 0.75},
            "timings",
            requests.PhaseTiming("Slow", "flight 1", seconds=0.75),
        ),
        (
            KINDS["HOLD"],
            (),
            {"name": "Hang", "seconds": 1.25, "ends": True},
            "holds",
            requests.Hold("Hang", IN_FLIGHT, 1.25, True),
        ),
    ],
)
def test_a_row_becomes_its_record(
    rig: bpy.types.Object,
    kind: ConstraintKind,
    bones: tuple[str, ...],
    fields: dict[str, object],
    field: str,
    record: object,
) -> None:
    added(rig, kind, *bones, **fields)
    assert asked(rig) == requests.Requests(**{field: (record,)})


def test_a_new_point_is_where_its_bone_is_shown_in_metres(rig: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.5
    rig.scale = (2.0, 2.0, 2.0)
    rig.location = (1.0, 2.0, 3.0)
    bpy.context.view_layer.update()
    added(rig, KINDS["POINT"], "foot")
    (point,) = asked(rig).points
    matrix = rigs.world_of(rig, "foot", IN_FLIGHT)
    bone = rig.data.bones["foot"]
    half = 0.5 * bone.length
    middle = matrix @ Vector((0.0, half, 0.0))
    assert point.place == pytest.approx(tuple(0.5 * middle), abs=1e-5)
    assert point.offset == pytest.approx((0.0, half, 0.0), abs=1e-6)  # scale 2, half a metre a unit
    assert point.when == When(frames=(IN_FLIGHT, IN_FLIGHT))


def test_bounds_of_a_point_may_be_open(rig: bpy.types.Object) -> None:
    added(
        rig,
        KINDS["POINT"],
        "foot",
        use_place=False,
        use_offset=False,
        use_bounds=True,
        axes="SURFACE",
        normal=(1.0, 0.0, 0.0),
        at_least=(0.0, -0.5, 0.25),
        at_most=(0.0, 0.5, 0.5),
        bound_axes=(False, True, True),
        bound_above=(True, True, False),
        environment=True,
        grip=True,
    )
    (point,) = asked(rig).points
    assert point.bounds == ((None, None), (-0.5, 0.5), (0.25, None))
    assert (point.axes, point.normal) == (requests.PointAxes.SURFACE, (1.0, 0.0, 0.0))
    assert (point.place, point.offset, point.environment, point.grip) == (None, None, True, True)


def test_what_is_switched_off_is_left_out(rig: bpy.types.Object) -> None:
    added(rig, KINDS["CONE"], used=False)  # without a bone
    add_body_change(rig.hangtime, BodyKind.LOAD, ()).used = False
    assert asked(rig) == requests.Requests()


def test_the_body_its_loads_and_limbs(rig: bpy.types.Object) -> None:
    settings = rig.hangtime
    settings.use_new_mass, settings.new_mass, settings.gravity = True, 80.0, 1.62
    add_body_change(settings, BodyKind.LOAD, ["finger"]).mass = 12.0
    row = add_body_change(settings, BodyKind.LOAD, ["head"])
    row.by_share, row.share = True, 0.25
    limb = add_body_change(settings, BodyKind.LIMB, ["thigh", "shin"])
    assert asked(rig).body.limbs == ()  # it changes nothing yet
    limb.length = 1.5
    assert asked(rig).body == requests.BodyChange(
        mass=80.0,
        gravity=1.62,
        added=(
            requests.AddedMass("finger Weight", "finger", mass=12.0),
            requests.AddedMass("head Weight", "head", share=0.25),
        ),
        limbs=(requests.LimbChange("Limb", ("thigh", "shin"), 1.5, 1.0),),
    )


def test_a_load_hangs_off_its_bone_in_metres(rig: bpy.types.Object) -> None:
    bpy.context.scene.unit_settings.scale_length = 0.5
    row = add_body_change(rig.hangtime, BodyKind.LOAD, ["head"])
    row.use_offset, row.offset = True, (0.0, 0.5, 0.0)
    (load,) = asked(rig).body.added
    assert load.offset == pytest.approx((0.0, 0.25, 0.0))


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
    assert point.path.frames == (4.0, 5.0, 6.0, 7.0, 8.0, 9.0)
    target.hide_viewport = False
    for frame, place in zip(point.path.frames, point.path.places, strict=True):
        scene.frame_set(int(frame))
        assert place == pytest.approx(tuple(0.5 * target.matrix_world.translation), abs=1e-5)
    assert point.path.places[-1][0] > point.path.places[0][0] + 1.0


def test_a_target_in_a_phase_is_sampled_in_that_phase(rig: bpy.types.Object) -> None:
    added(rig, KINDS["POINT"], "foot", span="PHASE", target=target_at((1.0, 2.0, 3.0)))
    (point,) = asked(rig).points
    assert (point.path.frames[0], point.path.frames[-1]) == (5.0, 15.0)
    assert set(point.path.places) == {(1.0, 2.0, 3.0)}


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
    added(rig, KINDS["POINT"], "foot", name="Mine", normal=(0.0, 0.0, 0.0))


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
    solution = requests.SolverOptions(method=requests.Method.EXPLICIT)
    both = joined(asked(rig), requests.Requests(holds=(hold,), solution=solution))
    assert both.names == ("Mine", "Hang")
    assert (both.solution, both.body.gravity) == (solution, 1.62)
    with pytest.raises(faults.NamedTwice):
        joined(asked(rig), requests.Requests(holds=(requests.Hold("Mine", 8.0, 1.0),)))


def test_a_hold_is_a_phase_that_others_may_name(rig: bpy.types.Object) -> None:
    added(rig, KINDS["HOLD"], name="Hang")
    added(rig, KINDS["POSE"], name="Tuck", span="PHASE", phase="Hang")
    assert asked(rig).poses[0].when == When("Hang")
