"""What the lists of constraints and body changes ask the solver for."""

from __future__ import annotations

import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.constraints.rows import add_body_change
from hangtime.bridge.rows.choices import BodyKind, Span
from hangtime.bridge.rows.kind import ConstraintKind
from hangtime.solver.data import requests
from hangtime.solver.data.requests import When
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.rows import IN_FLIGHT, added, asked, make_rig
from mathutils import Vector

pytestmark = pytest.mark.usefixtures("_enabled")

FLIGHT = When(phase="flight 1")


@pytest.fixture
def rig() -> bpy.types.Object:
    return make_rig()


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
            {
                "name": "Weak",
                "torque_by": "NEWTON_METRES",
                "torque": 60.0,
                "use_dof": True,
                "dof": 1,
                "torque_value": 5.0,
            },
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


def test_shapes_and_what_they_go_through(rig: bpy.types.Object) -> None:
    row = add_body_change(rig.hangtime, BodyKind.SHAPE, ["finger"])
    assert asked(rig).shapes == (requests.Shape("finger Shape", ("finger",)),)
    row.thickness, row.through, row.human = 0.5, "EACH_OTHER", False
    (shape,) = asked(rig).shapes
    through = requests.Through.EACH_OTHER
    assert shape == requests.Shape("finger Shape", ("finger",), 0.5, through, human=False)


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
