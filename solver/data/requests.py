"""What the artist asks for beside moved contacts, as named records (thesis 3.3): pure data.

Every record carries the artist's name for it, by which it is reported. Bones are named as in the
armature. Angles are in rad, lengths in m, forces in body weights, torques in N·m, world Z up.
"""

from dataclasses import dataclass, field
from enum import Enum

Vector = tuple[float, float, float]
Bound = tuple[float | None, float | None]  # lower, upper; None is free


class Moment(Enum):
    """A single instant of a phase. APEX: when the centre of mass is highest."""

    START = "start"
    MIDDLE = "middle"
    APEX = "apex"
    END = "end"


@dataclass(frozen=True)
class When:
    """During what a request holds: the whole clip, or what is given.

    phase: such as "flight 1", or the name of a Hold. frames: scene frames of the recording, both
    ends included; one frame where they are equal. moment: one instant of the phase.
    """

    phase: str | None = None
    frames: tuple[float, float] | None = None
    moment: Moment | None = None


ALWAYS = When()


class PointAxes(Enum):
    """What directions a point's bounds and places are given in."""

    WORLD = "world"
    TRAVEL = "travel"  # forward, left, up of the flight that ends (or else starts) there
    SURFACE = "surface"  # along, across and out of a surface with a normal of its own


@dataclass(frozen=True)
class Path:
    """A place that moves: instants as scene frames, (T,), and places, T of (3,) m, world."""

    frames: tuple[float, ...]
    places: tuple[Vector, ...]


@dataclass(frozen=True)
class PointRequest:
    """A point of a bone is held at, or kept within bounds of, a place.

    offset: (3,) m from the bone's head, in the bone's axes; None is the middle of the bone.
    place: world; None takes the place of the fit (per instant, or its mean where `environment`).
    relative: displaces the place, in `axes`. path: the place moves with an object instead.
    bounds: per axis of `axes`, about the place; None holds the point there exactly.
    normal: of the surface, for PointAxes.SURFACE. environment: the world pushes back with a force
    there; such a point may pull as well as push where it is a grip.
    """

    name: str
    bone: str
    when: When
    offset: Vector | None = None
    place: Vector | None = None
    relative: Vector = (0.0, 0.0, 0.0)
    path: Path | None = None
    axes: PointAxes = PointAxes.WORLD
    normal: Vector = (0.0, 0.0, 1.0)
    bounds: tuple[Bound, Bound, Bound] | None = None
    environment: bool = False
    grip: bool = False


@dataclass(frozen=True)
class Lift:
    """Contacts of one phase that shall not touch any more (a hop on one leg).

    touching: bones, points or contacts as in a Pin; empty lifts all of the phase.
    """

    name: str
    phase: str
    touching: tuple[str, ...] = ()


@dataclass(frozen=True)
class AngleLimit:
    """Bounds on how far a joint is bent: the angle between the bone and the straight limb, rad.

    Positive the way the joint bends in the recording. Equal bounds fix the joint.
    """

    name: str
    bone: str
    lower: float | None
    upper: float | None
    when: When = ALWAYS


@dataclass(frozen=True)
class ConeLimit:
    """The bone stays in a cone about an axis (thesis 3.3.3: a . S R l).

    half_angle: rad. axis: in the parent's rest frame (world axes of the rest pose); None takes
    the bone's mean direction over `when` in the fit. stretch: how much wider the cone is along
    its two cross directions than half_angle, (sideways, forwards-backwards).
    """

    name: str
    bone: str
    half_angle: float
    axis: Vector | None = None
    stretch: tuple[float, float] = (1.0, 1.0)
    when: When = ALWAYS


@dataclass(frozen=True)
class TwistLimit:
    """Bounds on how far a bone is turned about itself against its parent, rad; rest is zero."""

    name: str
    bone: str
    lower: float | None
    upper: float | None
    when: When = ALWAYS


@dataclass(frozen=True)
class TorqueLimit:
    """A bound on the torque of a joint (thesis 3.3.4), the norm's components each.

    bones: whose joints to their parents. bound: N·m; or share: of the fit's own peak in `when`,
    bone by bone. One of the two is given; zero is limp. dof: only this angle of the joint (0, 1,
    2), None all. value: N·m instead of zero about which the bound lies.
    """

    name: str
    bones: tuple[str, ...]
    bound: float | None = None
    share: float | None = None
    value: float = 0.0
    dof: int | None = None
    when: When = ALWAYS


class Reference(Enum):
    """Where a pose is taken from."""

    FIT = "fit"
    REST = "rest"


@dataclass(frozen=True)
class PoseRequest:
    """Joints are posed as at some frame of the recording (or as at rest).

    bones: empty is the whole body. frame: of the recording, whose fit gives the pose; None the
    same frame. weight: None holds exactly; else the solutions only prefer it, by this much.
    slack: rad by which each angle may miss it where held.
    """

    name: str
    when: When
    bones: tuple[str, ...] = ()
    reference: Reference = Reference.FIT
    frame: float | None = None
    weight: float | None = None
    slack: float = 0.0


@dataclass(frozen=True)
class OrientationRequest:
    """A bone points a certain way in the world.

    turn: rad about the world's vertical, against the fit's own orientation at each instant; tilt:
    rad about the travel's left axis (forwards positive) after it. slack: rad by which it may miss.
    """

    name: str
    bone: str
    when: When
    turn: float = 0.0
    tilt: float = 0.0
    slack: float = 0.0


class ConeShape(Enum):
    """How a friction cone is bounded."""

    EXACT = "exact"
    PYRAMID = "pyramid"  # four planes inside the cone


@dataclass(frozen=True)
class ForceRequest:
    """What contact forces may be, of every contact or of those named, in `when`.

    friction: coefficient, for the whole of every contact that `when` meets; None leaves it as it
    is. peak: body weights, of the sum of all forces of the contacts named.
    match: how strongly all forces are kept like the fit's, times the usual price.
    touching: bones, points or contacts; empty is all.
    """

    name: str
    friction: float | None = None
    shape: ConeShape = ConeShape.EXACT
    peak: float | None = None
    match: float | None = None
    touching: tuple[str, ...] = ()
    when: When = ALWAYS


@dataclass(frozen=True)
class AddedMass:
    """A mass carried at a bone, as a small solid: kg, or a share of the body's mass.

    offset: (3,) m from the bone's head in the bone's axes; None is the bone's tail.
    """

    name: str
    bone: str
    mass: float | None = None
    share: float | None = None
    offset: Vector | None = None


@dataclass(frozen=True)
class LimbChange:
    """Bones made longer or shorter, heavier or lighter, by factors; thickness stays."""

    name: str
    bones: tuple[str, ...]
    length: float = 1.0
    mass: float = 1.0


@dataclass(frozen=True)
class BodyChange:
    """What of the body, or of the world it is in, differs from the recording's.

    mass: total, kg, before what is carried; None keeps it. gravity: m/s².
    """

    mass: float | None = None
    gravity: float = 9.81
    added: tuple[AddedMass, ...] = ()
    limbs: tuple[LimbChange, ...] = ()


@dataclass(frozen=True)
class PhaseTiming:
    """A phase takes longer or shorter: times `factor`, or `seconds` instead."""

    name: str
    phase: str
    factor: float | None = None
    seconds: float | None = None


@dataclass(frozen=True)
class Hold:
    """The frame `frame` is repeated for `seconds`, a phase of its own called `name` (thesis 6.2).

    ends: the recording after it is left out, so that the motion ends with it.
    """

    name: str
    frame: float
    seconds: float
    ends: bool = False


class Dynamics(Enum):
    """Whose equations of motion are in the problem (thesis 3.2).

    AUTOMATIC: the root's, and those of the joints whose torques are limited or weighed.
    """

    AUTOMATIC = "automatic"
    REDUCED = "reduced"
    STANDARD = "standard"


class Method(Enum):
    """Which solution (thesis 4.3, 4.4)."""

    IMPLICIT = "implicit"  # (q, lambda)
    IMPLICIT_TORQUES = "implicit with torques"  # (q, tau, lambda)
    EXPLICIT = "explicit"


class ObjectiveKind(Enum):
    """Objectives that the explicit solution may weigh (thesis 4.3)."""

    TORQUE_SMOOTHNESS = "torque smoothness"
    POWER = "power"
    TORQUE_OUTPUT = "torque output"
    MASS_DISPLACEMENT = "mass displacement"
    ANGLE_DISPLACEMENT = "angle displacement"
    ANGLE_SMOOTHNESS = "angle smoothness"
    TOTAL_CHANGE = "total change"
    CLOSENESS = "closeness"


class ReductionKind(Enum):
    """How the joints other than the root are tied together (thesis 5)."""

    PCA = "pca"
    VARIMAX = "varimax"
    QUARTIMAX = "quartimax"
    OBLIQUE = "oblique"
    ICA = "ica"
    MIRROR_LEGS = "mirror legs"
    MATRIX = "matrix"


@dataclass(frozen=True)
class Reduction:
    """A smaller figure. dimensions: None chooses by `explained`, the share of variance kept.

    matrix: for MATRIX, one row per combined coordinate: {bone: (weights of its angles)}.
    """

    kind: ReductionKind
    dimensions: int | None = None
    explained: float = 0.999
    matrix: tuple[tuple[tuple[str, tuple[float, ...]], ...], ...] = ()


@dataclass(frozen=True)
class SolverOptions:
    """How to solve. objectives: weights by kind, for the explicit solution; their shares of it.

    longest_span: s, between knots; torque_span: s, between knots of the torques' own splines;
    None chooses them automatically.
    """

    method: Method = Method.IMPLICIT
    dynamics: Dynamics = Dynamics.AUTOMATIC
    objectives: tuple[tuple[ObjectiveKind, float], ...] = (
        (ObjectiveKind.TORQUE_SMOOTHNESS, 1.0),
        (ObjectiveKind.CLOSENESS, 1.0),
    )
    reduction: Reduction | None = None
    longest_span: float | None = None
    torque_span: float | None = None


@dataclass(frozen=True)
class Requests:
    """Everything asked for beside pins, in the order it was written."""

    points: tuple[PointRequest, ...] = ()
    lifts: tuple[Lift, ...] = ()
    angles: tuple[AngleLimit, ...] = ()
    cones: tuple[ConeLimit, ...] = ()
    twists: tuple[TwistLimit, ...] = ()
    torques: tuple[TorqueLimit, ...] = ()
    poses: tuple[PoseRequest, ...] = ()
    orientations: tuple[OrientationRequest, ...] = ()
    forces: tuple[ForceRequest, ...] = ()
    body: BodyChange = field(default_factory=BodyChange)
    timings: tuple[PhaseTiming, ...] = ()
    holds: tuple[Hold, ...] = ()
    solution: SolverOptions = field(default_factory=SolverOptions)

    @property
    def names(self) -> tuple[str, ...]:
        """What the artist called them."""
        kinds = (self.points, self.lifts, self.angles, self.cones, self.twists, self.torques)
        more = (self.poses, self.orientations, self.forces, self.body.added, self.body.limbs)
        every = (*kinds, *more, self.timings, self.holds)
        return tuple(request.name for kind in every for request in kind)

    @property
    def preferred(self) -> tuple[PoseRequest, ...]:
        """The poses that are not held but only preferred."""
        return tuple(pose for pose in self.poses if pose.weight is not None)
