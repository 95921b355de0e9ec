"""A recipe with every kind of request and every key, and what it asks for."""

import math

from hangtime.solver.data.requests import (
    AddedMass,
    AngleLimit,
    BodyChange,
    ConeLimit,
    ConeShape,
    ForceRequest,
    Hold,
    Lift,
    LimbChange,
    Moment,
    OrientationRequest,
    Path,
    PhaseTiming,
    PointAxes,
    PointRequest,
    PoseRequest,
    Reference,
    Requests,
    Shape,
    Through,
    TorqueLimit,
    TwistLimit,
    When,
)
from hangtime.solver.data.solver_options import (
    Dynamics,
    HumanRanges,
    Method,
    ObjectiveKind,
    Reduction,
    ReductionKind,
    ShapeSource,
    SolverOptions,
)

FULL = """\
[[pin]]
name = "Landing"
phase = "ground 2"

[[point]]                            # reach
name = "Reach"
bone = "Hand.L"
phase = "flight 1"
moment = "apex"
offset = [0, 0.1, 0]
place = [1, 2, 3]
environment = true
grip = true

[[point]]                            # toe
bone = "Toe.L"
frames = [100, 120]
forward = 0.5
at_least = { up = 0.3 }
at_most = { left = 0.2, up = 0.9 }

[[point]]                            # ball
bone = "Hand.R"
path = [
  { frame = 100, place = [0, 0, 1] },
  { frame = 110, place = [0, 0, 2] },
]
normal = [0, -1, 0]
at_most = { out = 0.01 }

[[lift]]
phase = "ground 1"
points = ["Left heel"]

[[angle]]                            # knee
bone = "Shin.L"
at_least = 10
at_most = 90

[[angle]]                            # stiff
bone = "Shin.R"
fixed = 45

[[cone]]
bone = "Thigh.L"
half_angle = 40
axis = [0, 0, -1]
stretch = [1, 1.5]

[[twist]]
bone = "Thigh.R"
at_most = 30

[[torque]]
name = "Limp"
bones = [
  "Foot.L",
  "Shin.L",
]
bound = 0
value = 20
dof = 1

[[pose]]
bones = ["Thigh.L"]
frame = 150
reference = "rest"
pose_frame = 140
slack = 2

[[orientation]]
bone = "Hips"
turn = 180
tilt = -10
slack = 1

[[force]]
bones = ["Foot.R"]
friction = 0.8
shape = "pyramid"
peak = 3
match = 10

[body]
mass = 80
gravity = 1.62

[[load]]
bone = "Hand.R"
share = 0.2
offset = [0, 0, -0.1]

[[limb]]
bones = ["Shin.R"]
length = 0.8
mass = 0.9

[[shape]]
bones = ["Hair", "Cape"]
thickness = 0.5
through = "each other"
human = false

[[timing]]
phase = "flight 1"
factor = 1.5

[[hold]]
name = "Hanging"
frame = 145
seconds = 1
ends = true

[solution]
method = "explicit"
dynamics = "standard"
longest_span = 0.1
torque_span = 0.2
keep_times = true
solid = false
shapes = "bones"
human = "hard"
wider = 90

[solution.objectives]
"torque smoothness" = 2
closeness = 0.5

[solution.reduction]
kind = "matrix"
matrix = [
  [{ bone = "Thigh.L", weights = [1, 0, 0] }, { bone = "Thigh.R", weights = [1] }],
]
"""
REQUESTS = Requests(
    points=(
        PointRequest(
            "Reach",
            "Hand.L",
            When("flight 1", moment=Moment.APEX),
            offset=(0.0, 0.1, 0.0),
            place=(1.0, 2.0, 3.0),
            environment=True,
            grip=True,
        ),
        PointRequest(
            "Point 2",
            "Toe.L",
            When(frames=(100.0, 120.0)),
            relative=(0.5, 0.0, 0.0),
            axes=PointAxes.TRAVEL,
            bounds=((None, None), (None, 0.2), (0.3, 0.9)),
        ),
        PointRequest(
            "Point 3",
            "Hand.R",
            When(),
            path=Path((100.0, 110.0), ((0.0, 0.0, 1.0), (0.0, 0.0, 2.0))),
            axes=PointAxes.SURFACE,
            normal=(0.0, -1.0, 0.0),
            bounds=((None, None), (None, None), (None, 0.01)),
        ),
    ),
    lifts=(Lift("Lift 1", "ground 1", ("Left heel",)),),
    angles=(
        AngleLimit("Angle 1", "Shin.L", math.radians(10.0), math.radians(90.0)),
        AngleLimit("Angle 2", "Shin.R", math.radians(45.0), math.radians(45.0)),
    ),
    cones=(ConeLimit("Cone 1", "Thigh.L", math.radians(40.0), (0.0, 0.0, -1.0), (1.0, 1.5)),),
    twists=(TwistLimit("Twist 1", "Thigh.R", None, math.radians(30.0)),),
    torques=(TorqueLimit("Limp", ("Foot.L", "Shin.L"), bound=0.0, value=20.0, dof=1),),
    poses=(
        PoseRequest(
            "Pose 1",
            When(frames=(150.0, 150.0)),
            ("Thigh.L",),
            Reference.REST,
            frame=140.0,
            slack=math.radians(2.0),
        ),
    ),
    orientations=(
        OrientationRequest(
            "Orientation 1", "Hips", When(), math.pi, math.radians(-10.0), math.radians(1.0)
        ),
    ),
    forces=(ForceRequest("Force 1", 0.8, ConeShape.PYRAMID, 3.0, 10.0, ("Foot.R",)),),
    body=BodyChange(
        80.0,
        1.62,
        (AddedMass("Load 1", "Hand.R", share=0.2, offset=(0.0, 0.0, -0.1)),),
        (LimbChange("Limb 1", ("Shin.R",), 0.8, 0.9),),
    ),
    timings=(PhaseTiming("Timing 1", "flight 1", factor=1.5),),
    holds=(Hold("Hanging", 145.0, 1.0, ends=True),),
    solution=SolverOptions(
        Method.EXPLICIT,
        Dynamics.STANDARD,
        ((ObjectiveKind.TORQUE_SMOOTHNESS, 2.0), (ObjectiveKind.CLOSENESS, 0.5)),
        Reduction(
            ReductionKind.MATRIX, matrix=((("Thigh.L", (1.0, 0.0, 0.0)), ("Thigh.R", (1.0,))),)
        ),
        0.1,
        0.2,
        keep_times=True,
        solid=False,
        shapes=ShapeSource.BONES,
        human=HumanRanges.HARD,
        wider=math.pi / 2.0,
    ),
    shapes=(Shape("Shape 1", ("Hair", "Cape"), 0.5, Through.EACH_OTHER, human=False),),
)


def line_of(text: str, part: str) -> int:
    """The line on which a part stands that occurs once."""
    assert text.count(part) == 1
    return text[: text.index(part)].count("\n") + 1
