"""Problems with requests of every kind, at random."""

import math

from hangtime.bridge.recipe_syntax.items import LEAST_LENGTH
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
    MIN_SPAN,
    Dynamics,
    HumanRanges,
    Method,
    ObjectiveKind,
    Reduction,
    ReductionKind,
    ShapeSource,
    SolverOptions,
)
from hypothesis import strategies as st

LETTERS = st.characters(exclude_categories=["Cs"], exclude_characters="\0")  # no recipe holds NUL
NAMES = st.text(LETTERS, min_size=1, max_size=8).filter(str.strip)
NUMBERS = st.floats(-1e6, 1e6)
POSITIVE = st.floats(1e-3, 1e3)
SPANS = st.floats(MIN_SPAN, 1e3)
NOT_NEGATIVE = st.floats(0.0, 1e3)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
DIRECTIONS = VECTORS.filter(lambda vector: math.hypot(*vector) > LEAST_LENGTH)
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
AXES = st.sampled_from(PointAxes)
# A normal is of a surface that places and bounds are told along, or that pushes back.
SURFACES = st.builds(dict, axes=st.just(PointAxes.SURFACE), normal=DIRECTIONS)
WALLS = st.builds(dict, axes=AXES, normal=DIRECTIONS, environment=st.just(value=True))
POINTS = st.builds(
    lambda place, grip, axes, **rest: PointRequest(**rest, **place, **(grip | axes)),
    place=PLACES,
    grip=GRIPS,
    axes=SURFACES | WALLS | st.builds(dict, axes=AXES),
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
    longest_span=st.none() | SPANS,
    torque_span=st.none() | SPANS,
    keep_times=st.booleans(),
    solid=st.booleans(),
    shapes=st.sampled_from(ShapeSource),
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
