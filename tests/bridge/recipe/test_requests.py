"""Requests in a recipe: every kind is read, written and read again; mistakes name their line."""

import math
from dataclasses import fields

import pytest
from hangtime.bridge.recipe import requests
from hangtime.bridge.recipe.problem import locate, parse_recipe, write_recipe
from hangtime.solver.data.faults import (
    BadDimensions,
    BadRecipe,
    DependentRows,
    Fault,
    UnknownBone,
    UnknownPhaseIn,
    UnknownReductionBone,
    WrongWeights,
)
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import (
    AddedMass,
    AngleLimit,
    BodyChange,
    Clear,
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
    SolverOptions,
)
from hypothesis import given
from hypothesis import strategies as st

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
        human=HumanRanges.HARD,
        wider=math.pi / 2.0,
    ),
    shapes=(Shape("Shape 1", ("Hair", "Cape"), 0.5, Through.EACH_OTHER, human=False),),
)


def line_of(text: str, part: str) -> int:
    """The line on which a part stands that occurs once."""
    assert text.count(part) == 1
    return text[: text.index(part)].count("\n") + 1


def refused(text: str) -> BadRecipe:
    with pytest.raises(BadRecipe) as caught:
        parse_recipe(text)
    return caught.value


def test_every_key_is_read() -> None:
    assert parse_recipe(FULL).problem.requests == REQUESTS


def test_the_recipe_in_the_documentation_is_understood() -> None:
    """Each of its keys is known: what stands together there excludes each other in part."""
    known = {key for kind in requests.NAMED for key in kind.keys}
    said = (line.split(" = ")[0] for line in requests.__doc__.splitlines() if " = " in line)
    keys = {key.strip().strip('"') for key in said}
    solving = {
        "method",
        "dynamics",
        "longest_span",
        "keep_times",
        "solid",
        "human",
        "wider",
        "gravity",
        "kind",
        "dimensions",
        "matrix",
    }
    assert keys - known - solving == {"torque smoothness", "closeness"}
    alternatives = {"frame", "fixed", "at_most", "forward", "left", "up", "bones", "seconds"}
    assert known - keys <= alternatives


# ---------------------------------------------------------------- there and back

NAMES = st.text(min_size=1, max_size=8).filter(str.strip)
NUMBERS = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-3, 1e3)
NOT_NEGATIVE = st.floats(0.0, 1e3)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
DIRECTIONS = VECTORS.filter(any)
ANGLES = st.integers(-360, 360).map(math.radians)
SLACKS = st.integers(0, 20).map(math.radians)
WORDS = st.lists(NAMES, max_size=3).map(tuple)
BONES = st.lists(NAMES, min_size=1, max_size=3).map(tuple)


def bounds_of(numbers: st.SearchStrategy[float]) -> st.SearchStrategy[tuple]:
    """Lower and upper, of which at least one is there."""
    both = st.tuples(numbers, numbers).map(sorted).map(tuple)
    return both | st.tuples(numbers, st.none()) | st.tuples(st.none(), numbers)


def limits(record: type) -> st.SearchStrategy:
    return st.builds(
        lambda name, bone, bounds, when: record(name, bone, *bounds, when),
        NAMES,
        NAMES,
        bounds_of(ANGLES),
        WHENS,
    )


FRAMES = st.tuples(NUMBERS, NUMBERS).map(sorted).map(tuple) | NUMBERS.map(lambda f: (f, f))
MOMENTS = st.none() | st.sampled_from(Moment)
WHENS = (
    st.just(When())
    | st.builds(When, phase=NAMES, frames=st.none() | FRAMES, moment=MOMENTS)
    | st.builds(When, frames=FRAMES, moment=MOMENTS)
)
PATHS = st.dictionaries(NUMBERS, VECTORS, min_size=1, max_size=3).map(
    lambda places: Path(tuple(sorted(places)), tuple(places[f] for f in sorted(places)))
)
FREE = st.just((None, None))
POINT_BOUNDS = st.tuples(*[FREE | bounds_of(NUMBERS)] * 3).filter(lambda b: any(map(any, b)))
PLACES = st.just({}) | st.builds(dict, place=VECTORS) | st.builds(dict, path=PATHS)
GRIPS = st.sampled_from([{}, {"environment": True}, {"environment": True, "grip": True}])
SURFACES = st.builds(dict, axes=st.just(PointAxes.SURFACE), normal=DIRECTIONS)
POINTS = st.builds(
    lambda place, grip, axes, **rest: PointRequest(**rest, **place, **grip, **axes),
    place=PLACES,
    grip=GRIPS,
    axes=SURFACES | st.builds(dict, axes=st.sampled_from(PointAxes)),
    name=NAMES,
    bone=NAMES,
    when=WHENS,
    offset=st.none() | VECTORS,
    relative=VECTORS,
    bounds=st.none() | POINT_BOUNDS,
)
TORQUES = st.builds(
    lambda bound, **rest: TorqueLimit(**rest, **bound),
    bound=st.builds(dict, bound=NOT_NEGATIVE) | st.builds(dict, share=NOT_NEGATIVE),
    name=NAMES,
    bones=BONES,
    value=NUMBERS,
    dof=st.none() | st.integers(0, 2),
    when=WHENS,
)
POSES = st.builds(
    lambda miss, **rest: PoseRequest(**rest, **miss),
    miss=st.builds(dict, weight=POSITIVE) | st.builds(dict, slack=SLACKS),
    name=NAMES,
    when=WHENS,
    bones=WORDS,
    reference=st.sampled_from(Reference),
    frame=st.none() | NUMBERS,
)
FORCES = st.builds(
    ForceRequest,
    name=NAMES,
    friction=st.none() | NOT_NEGATIVE,
    shape=st.sampled_from(ConeShape),
    peak=st.none() | POSITIVE,
    match=NOT_NEGATIVE,
    touching=WORDS,
    when=WHENS,
)
LOADS = st.builds(
    lambda mass, **rest: AddedMass(**rest, **mass),
    mass=st.builds(dict, mass=POSITIVE) | st.builds(dict, share=POSITIVE),
    name=NAMES,
    bone=NAMES,
    offset=st.none() | VECTORS,
)
TIMINGS = st.builds(PhaseTiming, name=NAMES, phase=NAMES, factor=POSITIVE) | st.builds(
    PhaseTiming, name=NAMES, phase=NAMES, seconds=POSITIVE
)
ROWS = st.lists(
    st.lists(
        st.tuples(NAMES, st.lists(NUMBERS, min_size=1, max_size=3).map(tuple)),
        min_size=1,
        max_size=2,
    ).map(tuple),
    min_size=1,
    max_size=2,
).map(tuple)
STATISTICAL = st.sampled_from(
    [k for k in ReductionKind if k not in (ReductionKind.MATRIX, ReductionKind.MIRROR_LEGS)]
)
REDUCTIONS = (
    st.builds(Reduction, STATISTICAL, dimensions=st.integers(1, 40))
    | st.builds(Reduction, STATISTICAL, explained=st.floats(0.01, 1.0))
    | st.just(Reduction(ReductionKind.MIRROR_LEGS))
    | st.builds(Reduction, st.just(ReductionKind.MATRIX), matrix=ROWS)
)
SOLUTIONS = st.builds(
    SolverOptions,
    method=st.sampled_from(Method),
    dynamics=st.sampled_from(Dynamics),
    objectives=st.dictionaries(st.sampled_from(ObjectiveKind), NOT_NEGATIVE, min_size=1).map(
        lambda weights: tuple(weights.items())
    ),
    reduction=st.none() | REDUCTIONS,
    longest_span=st.none() | POSITIVE,
    torque_span=st.none() | POSITIVE,
    keep_times=st.booleans(),
    solid=st.booleans(),
    human=st.sampled_from(HumanRanges),
    wider=SLACKS,
)
CONES = st.builds(
    ConeLimit,
    name=NAMES,
    bone=NAMES,
    half_angle=st.integers(1, 179).map(math.radians),
    axis=st.none() | DIRECTIONS,
    stretch=st.tuples(POSITIVE, POSITIVE),
    when=WHENS,
)
ORIENTATIONS = st.builds(
    OrientationRequest, name=NAMES, bone=NAMES, when=WHENS, turn=ANGLES, tilt=ANGLES, slack=SLACKS
)
KINDS = {
    "points": POINTS,
    "lifts": st.builds(Lift, NAMES, NAMES, WORDS),
    "angles": limits(AngleLimit),
    "cones": CONES,
    "twists": limits(TwistLimit),
    "torques": TORQUES,
    "poses": POSES,
    "orientations": ORIENTATIONS,
    "forces": FORCES,
    "timings": TIMINGS,
    "holds": st.builds(Hold, NAMES, NUMBERS, POSITIVE, st.booleans()),
    "clears": st.builds(Clear, NAMES, NAMES, POSITIVE, WORDS),
    "shapes": st.builds(Shape, NAMES, BONES, POSITIVE, st.sampled_from(Through), st.booleans()),
}
LIMBS = st.builds(LimbChange, NAMES, BONES, POSITIVE, POSITIVE)


def some(records: st.SearchStrategy) -> st.SearchStrategy[tuple]:
    return st.lists(records, max_size=2).map(tuple)


def named_apart(problem: MotionProblem) -> bool:
    requests = problem.requests
    records = [r for field in KINDS for r in getattr(requests, field)]
    records += [*problem.pins, *requests.body.added, *requests.body.limbs]
    return len({record.name for record in records}) == len(records)


PROBLEMS = st.builds(
    MotionProblem,
    pins=some(st.builds(Pin, NAMES, NAMES)),
    requests=st.builds(
        Requests,
        **{field: some(records) for field, records in KINDS.items()},
        body=st.builds(BodyChange, st.none() | POSITIVE, POSITIVE, some(LOADS), some(LIMBS)),
        solution=SOLUTIONS,
    ),
).filter(named_apart)


def test_every_kind_of_request_is_tried() -> None:
    assert {*KINDS, "body", "solution"} == {field.name for field in fields(Requests)}


@given(PROBLEMS)
def test_what_is_written_is_read_as_the_same(problem: MotionProblem) -> None:
    assert parse_recipe(write_recipe(problem)).problem == problem


def test_the_full_recipe_comes_back() -> None:
    problem = MotionProblem(requests=REQUESTS)
    assert parse_recipe(write_recipe(problem)).problem == problem


def test_long_values_are_written_over_lines() -> None:
    text = write_recipe(MotionProblem(requests=REQUESTS))
    path = (
        "path = [\n  { frame = 100, place = [0, 0, 1] },\n  { frame = 110, place = [0, 0, 2] },\n]"
    )
    assert path in text
    assert '[solution.objectives]\n"torque smoothness" = 2\ncloseness = 0.5\n' in text
    assert text.count('\n  [{ bone = "Thigh.L"') == 1


def test_what_was_not_asked_is_not_written() -> None:
    request = AngleLimit("Knee", "Shin.L", None, math.radians(90.0))
    text = write_recipe(MotionProblem(requests=Requests(angles=(request,))))
    assert text.endswith('\n[[angle]]\nname = "Knee"\nbone = "Shin.L"\nat_most = 90\n')
    assert "[solution]" not in text
    assert "[body]" not in text


@pytest.mark.parametrize(
    ("keys", "axes", "relative"),
    [
        ("", PointAxes.WORLD, (0.0, 0.0, 0.0)),
        ("left = 2", PointAxes.TRAVEL, (0.0, 2.0, 0.0)),
        ("relative = [1, 2, 3]\nat_least = { forward = 0 }", PointAxes.TRAVEL, (1.0, 2.0, 3.0)),
        ('axes = "travel"\nrelative = [1, 2, 3]', PointAxes.TRAVEL, (1.0, 2.0, 3.0)),
        ("at_most = { z = 1 }", PointAxes.WORLD, (0.0, 0.0, 0.0)),
        ("at_most = { along = 1 }", PointAxes.SURFACE, (0.0, 0.0, 0.0)),
        ("normal = [1, 0, 0]", PointAxes.SURFACE, (0.0, 0.0, 0.0)),
    ],
)
def test_axes_follow_from_the_names_of_axes(keys: str, axes: PointAxes, relative: tuple) -> None:
    (point,) = parse_recipe(f'[[point]]\nbone = "Hand"\n{keys}').problem.requests.points
    assert (point.axes, point.relative) == (axes, relative)


# ---------------------------------------------------------------- mistakes

WRONG = [  # what stands in FULL, and what it is replaced by, whose last line is refused
    ('moment = "apex"', 'moment = "top"'),
    ('moment = "apex"', 'moment = "apex"\nframe = 3'),
    ("frames = [100, 120]", "frames = [120, 100]"),
    ("frames = [100, 120]", "frames = [100, 120]\nframe = 3"),
    ("frames = [100, 120]", 'moment = "start"'),
    ("frames = [100, 120]", "framse = [100, 120]"),
    ("place = [1, 2, 3]", "place = [1, 2]"),
    ("place = [1, 2, 3]", "place = [1, 2, 3]\npath = [{ frame = 1, place = [0, 0, 0] }]"),
    ("environment = true\n", "environment = 1\n"),
    ("environment = true\ngrip = true", "grip = true"),
    ("forward = 0.5", 'forward = 0.5\naxes = "wrold"'),
    ("forward = 0.5", 'axes = "world"\nforward = 0.5'),
    ("forward = 0.5", "forward = 0.5\nrelative = [1, 2, 3]"),
    ("forward = 0.5", "forward = 0.5\nnormal = [1, 2, 3]"),
    ("at_least = { up = 0.3 }", "at_least = { x = 0.3 }"),
    ("at_least = { up = 0.3 }", "at_least = { upp = 0.3 }"),
    ("at_least = { up = 0.3 }", "at_least = 0.3"),
    ("at_least = { up = 0.3 }", "at_least = {}"),
    ("at_most = { left = 0.2, up = 0.9 }", "at_most = { left = 0.2, up = 0.2 }"),
    ("at_most = { left = 0.2, up = 0.9 }", 'at_most = { left = "0.2" }'),
    ("normal = [0, -1, 0]", "normal = [0, 0, 0]"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 90, place = [0, 0, 2] }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 110 }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ place = [0, 0, 2] }"),
    ("{ frame = 110, place = [0, 0, 2] }", "{ frame = 110, plaec = [0, 0, 2] }"),
    ('points = ["Left heel"]', 'points = ["Left heel"]\nbones = ["Foot.L"]'),
    ('points = ["Left heel"]', "points = []"),
    ("at_most = 90", "at_most = 5"),
    ("at_most = 90", "at_most = 90\nfixed = 45"),
    ("fixed = 45", "fixed = 45\nat_least = 3"),
    ("fixed = 45", 'fixed = "straight"'),
    ("half_angle = 40", "half_angle = 0"),
    ("half_angle = 40", "half_angle = 180"),
    ("axis = [0, 0, -1]", "axis = [0, 0, 0]"),
    ("stretch = [1, 1.5]", "stretch = [1, 0]"),
    ("stretch = [1, 1.5]", "stretch = 1.5"),
    ("bound = 0", "bound = -1"),
    ("bound = 0", "share = -0.1"),
    ("bound = 0", "bound = 0\nshare = 0"),
    ("dof = 1", "dof = 3"),
    ("dof = 1", "dof = 0.5"),
    ('  "Shin.L",', "  7,"),
    ('reference = "rest"', 'reference = "resting"'),
    ("slack = 2", "slack = -2"),
    ("slack = 2", "slack = 2\nweight = 1"),
    ("slack = 2", "weight = 0"),
    ("turn = 180", 'turn = "left"'),
    ("friction = 0.8", "friction = -0.8"),
    ('shape = "pyramid"', 'shape = "square"'),
    ("peak = 3", "peak = 0"),
    ("match = 10", "match = -1"),
    ("mass = 80", "mass = 0"),
    ("gravity = 1.62", "gravity = 0"),
    ("gravity = 1.62", "gravitation = 1.62"),
    ("share = 0.2", "share = 0"),
    ("share = 0.2", "share = 0.2\nmass = 3"),
    ("length = 0.8", "length = 0"),
    ("factor = 1.5", "factor = 0"),
    ("factor = 1.5", "seconds = -1"),
    ("factor = 1.5", "factor = 1.5\nseconds = 1"),
    ("seconds = 1\n", "seconds = 0\n"),
    ("ends = true", 'ends = "yes"'),
    ('method = "explicit"', 'method = "quick"'),
    ('dynamics = "standard"', 'dynamics = "full"'),
    ("longest_span = 0.1", "longest_span = 0"),
    ("torque_span = 0.2", "torque_span = -1"),
    ("closeness = 0.5", "closenes = 0.5"),
    ("closeness = 0.5", "closeness = -0.5"),
    ('kind = "matrix"', 'kind = "svd"'),
    ('kind = "matrix"', 'kind = "matrix"\ndimensions = 3'),
    ('kind = "matrix"', 'kind = "matrix"\ndimensions = 3.5'),
    ('kind = "matrix"', 'kind = "matrix"\nexplained = 1.1'),
    ('kind = "matrix"', 'kind = "matrix"\nexplained = 0.9'),
]


@pytest.mark.parametrize(("old", "new"), WRONG)
def test_what_is_wrong_is_named_with_its_line(old: str, new: str) -> None:
    assert FULL.count(old) == 1
    start = FULL.index(old)
    text = FULL.replace(old, new)
    line = text[:start].count("\n") + 1 + new.rstrip("\n").count("\n")
    assert refused(text).line == line


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('[[point]]\nframe = 3\n[[point]]\nbone = "a"', 1),
        ('[[lift]]\npoints = ["a"]', 1),
        ('\n[[angle]]\nbone = "a"', 2),
        ("\n[[angle]]\nfixed = 3", 2),
        ('[[twist]]\nbone = "a"', 1),
        ('[[cone]]\nbone = "a"', 1),
        ("[[cone]]\nhalf_angle = 3", 1),
        ('[[torque]]\nbones = ["a"]', 1),
        ("[[torque]]\nbound = 3", 1),
        ("[[orientation]]\nturn = 3", 1),
        ('[[force]]\npoints = ["a"]', 1),
        ('[[load]]\nbone = "a"', 1),
        ("[[load]]\nmass = 3", 1),
        ("[[limb]]\nlength = 3", 1),
        ("[[shape]]\nthickness = 3", 1),
        ('[[shape]]\nbones = ["a"]\nthrough = "walls"', 3),
        ('[solution]\nhuman = "soft enough"', 2),
        ("[solution]\nhuman = 3", 2),
        ("[solution]\nwider = -3", 2),
        ('[[timing]]\nphase = "a"', 1),
        ("[[timing]]\nfactor = 3", 1),
        ("[[hold]]\nseconds = 3", 1),
        ("[[hold]]\nframe = 3", 1),
        ("\n[solution.reduction]\ndimensions = 3", 2),
        ('\n[solution.reduction]\nkind = "pca"\nmatrix = [[{ bone = "a", weights = [1] }]]', 4),
        ('\n[solution.reduction]\nkind = "matrix"', 3),
        ('\n[solution.reduction]\nkind = "mirror legs"\ndimensions = 3', 4),
        ('\n[solution.reduction]\nkind = "pca"\ndimensions = 3\nexplained = 0.9', 5),
        ("\n[solution]\nobjectives = {}", 3),
    ],
)
def test_what_is_missing_or_too_much_is_named_with_its_table(text: str, line: int) -> None:
    assert refused(text).line == line


@pytest.mark.parametrize(
    "matrix",
    [
        "[]",
        "3",
        "[[]]",
        "[3]",
        "[[3]]",
        '[[{ bone = "a" }]]',
        "[[{ weights = [1] }]]",
        '[[{ bone = "a", weights = [] }]]',
        '[[{ bone = "a", weights = 1 }]]',
        '[[{ bone = "a", weights = [nan] }]]',
        '[[{ bone = "a", wieghts = [1] }]]',
    ],
)
def test_a_matrix_of_another_form_is_refused(matrix: str) -> None:
    assert refused(f'[solution.reduction]\nkind = "matrix"\nmatrix = {matrix}').line == 3


@pytest.mark.parametrize("path", ["[]", "3", "[3]", "{ frame = 3, place = [0, 0, 0] }"])
def test_a_path_of_another_form_is_refused(path: str) -> None:
    assert refused(f'[[point]]\nbone = "a"\npath = {path}').line == 3


def test_a_request_outside_an_array_is_refused() -> None:
    assert "[[angle]]" in refused('mass = 3\n[angle]\nbone = "a"').problem


def test_a_carried_mass_has_another_name() -> None:
    fault = refused('height = 1.7\n[[mass]]\nbone = "Hand.R"\nshare = 0.2')
    assert "[[load]]" in fault.problem
    assert fault.line == 2


def test_an_unknown_kind_is_named_with_its_first_line() -> None:
    assert refused("mass = 3\n[[cones]]\nhalf_angle = 3\n[[cones]]").line == 2


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        ('[[poin]]\nbone = "a"', '"point"'),
        ("[[cone]]\nhalf_angel = 3", '"half_angle"'),
        ('[[angle]]\nbone = "a"\nlimit = 3', "at_least, at_most, fixed"),
        ('[solution]\nmethod = "quick"', "implicit, implicit with torques, explicit"),
        ("[solution.objectives]\nsmoothness = 1", '"angle smoothness"'),
        ('[[point]]\nbone = "a"\nat_least = { outt = 1 }', '"out"'),
        ('[[point]]\nbone = "a"\nat_least = { up = 1, x = 1 }', "forward, left, up"),
    ],
)
def test_a_mistake_gets_a_hint(wrong: str, hint: str) -> None:
    assert hint in refused(wrong).problem


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("pin", "point"),
        ("hold", "angle"),
        ("load", "pin"),
        ("limb", "limb"),
    ],
)
def test_two_records_of_one_name_are_refused(first: str, second: str) -> None:
    rest = {
        "pin": 'phase = "ground 1"',
        "point": 'bone = "a"',
        "hold": "frame = 1\nseconds = 1",
        "angle": 'bone = "a"\nfixed = 1',
        "load": 'bone = "a"\nmass = 1',
        "limb": 'bones = ["a"]',
    }
    text = "\n".join(f"[[{kind}]]\n{rest[kind]}\nname = 'Twice'" for kind in (first, second))
    assert refused(text).line == len(text.splitlines())


def test_a_default_name_is_a_name_too() -> None:
    text = '[[cone]]\nname = "Angle 1"\nbone = "a"\nhalf_angle = 3\n[[angle]]\nbone="a"\nfixed = 3'
    assert refused(text).line == 5


# ---------------------------------------------------------------- faults raised later


@pytest.mark.parametrize(
    ("fault", "part"),
    [
        (UnknownBone("Reach", "Hand.L"), 'bone = "Hand.L"'),
        (UnknownBone("Limp", "Shin.L"), '  "Shin.L",'),
        (UnknownBone("Point 2", "Hand.L"), "# toe"),
        (UnknownBone("Angle 2", ""), "# stiff"),
        (UnknownBone("Hanging", ""), "[[hold]]"),
        (UnknownBone("Load 1", ""), "[[load]]"),
        (UnknownBone("Landing", ""), "[[pin]]"),
        (UnknownPhaseIn("Lift 1", "ground 1", ()), 'phase = "ground 1"'),
        (UnknownReductionBone(1, "Thigh.L", ()), '  [{ bone = "Thigh.L"'),
        (WrongWeights(1, "Thigh.R", 1, 3), '  [{ bone = "Thigh.L"'),
        (DependentRows(2, 1), "matrix = ["),
        (BadDimensions(60, 40), "[solution.reduction]"),
    ],
)
def test_faults_about_a_request_are_found_in_the_recipe(fault: Fault, part: str) -> None:
    assert locate(FULL, fault) == line_of(FULL, part)


def test_faults_about_no_request_have_no_line() -> None:
    assert locate(FULL, UnknownBone("Left heel", "Hand.L")) is None
