"""Constraint, force, body and timing requests as named records (thesis 3.3).

Every record carries the artist's name for it, by which it is reported. Bones are named as in the
armature. Angles are in rad, lengths in m, forces in body weights, torques in N·m, world Z up.
"""

from dataclasses import dataclass, field
from enum import Enum

from .constants import STANDARD_GRAVITY
from .solver_options import SolverOptions

Vector = tuple[float, float, float]
Bound = tuple[float | None, float | None]  # lower, upper; None is free


class Moment(Enum):
    """Single instant of a phase. APEX: when the centre of mass is highest."""

    START = "start"
    MIDDLE = "middle"
    APEX = "apex"
    END = "end"


@dataclass(frozen=True)
class When:
    """Time domain of a request: the whole clip, or what is given.

    phase: such as "flight 1", or the name of a Hold. frames: scene frames of the recording, both
    ends included; one frame where they are equal. moment: one instant of the phase.
    """

    phase: str | None = None
    frames: tuple[float, float] | None = None
    moment: Moment | None = None


ALWAYS = When()


class PointAxes(Enum):
    """Axes of a point request's bounds and displacement."""

    WORLD = "world"
    TRAVEL = "travel"  # forward, left, up of the flight that ends (or else starts) there
    SURFACE = "surface"  # along, across and out of a surface with a normal of its own


@dataclass(frozen=True)
class Path:
    """Target trajectory: scene frames of the result, (T,), and places, T of (3,) m, world."""

    frames: tuple[float, ...]
    places: tuple[Vector, ...]


@dataclass(frozen=True)
class PointRequest:
    """Point constraint (thesis 3.3.2): a bone's point at, or within bounds of, a place.

    offset: (3,) m from the bone's head, in the bone's axes; None is the middle of the bone.
    place: world; None takes the place of the fit (per instant, or its mean where `environment`).
    relative: displaces the place, in `axes`. path: the place moves with an object instead.
    bounds: per axis of `axes`, about the place; None holds the point there exactly.
    normal: of the surface, for PointAxes.SURFACE and for what pushes back; None is that of the
    scene's face there, or else up. environment: the world pushes back with a force there; such a
    point may pull as well as push where it is a grip.
    """

    name: str
    bone: str
    when: When
    offset: Vector | None = None
    place: Vector | None = None
    relative: Vector = (0.0, 0.0, 0.0)
    path: Path | None = None
    axes: PointAxes = PointAxes.WORLD
    normal: Vector | None = None
    bounds: tuple[Bound, Bound, Bound] | None = None
    environment: bool = False
    grip: bool = False


@dataclass(frozen=True)
class Lift:
    """Removal of contacts of one phase (a hop on one leg).

    touching: bones, points or contacts as in a Pin; empty lifts all of the phase.
    """

    name: str
    phase: str
    touching: tuple[str, ...] = ()


@dataclass(frozen=True)
class AngleLimit:
    """Joint limit: bounds on the angle between the bone and the straight limb, rad.

    Positive the way the joint bends in the recording. Equal bounds fix the joint.
    """

    name: str
    bone: str
    lower: float | None
    upper: float | None
    when: When = ALWAYS


@dataclass(frozen=True)
class ConeLimit:
    """Cone limit of a joint: the bone stays in a cone about an axis (thesis 3.3.3: a . S R l).

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
    """Axial rotation limit: bounds on a bone's turn about itself from rest, to its parent, rad."""

    name: str
    bone: str
    lower: float | None
    upper: float | None
    when: When = ALWAYS


@dataclass(frozen=True)
class TorqueLimit:
    """Limit on the muscles' torque at joints (thesis 3.2.3, 6.2), on each component.

    What passive tissue gives (body/passive_joints.py) comes on top.

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
    """Source of a reference pose."""

    FIT = "fit"
    REST = "rest"


@dataclass(frozen=True)
class PoseRequest:
    """Pose constraint or preference: joints as at some frame of the recording (or at rest).

    bones: empty is the whole body. frame: of the recording, whose fit gives the pose; None the
    same frame. weight: None holds exactly; else the solutions only prefer it, by this much.
    slack: rad by which each angle may miss it where held. apart: bones whose joints are left out
    of it; some may have none.
    """

    name: str
    when: When
    bones: tuple[str, ...] = ()
    reference: Reference = Reference.FIT
    frame: float | None = None
    weight: float | None = None
    slack: float = 0.0
    apart: tuple[str, ...] = ()


@dataclass(frozen=True)
class OrientationRequest:
    """Orientation constraint on a bone, in the world.

    turn: rad about the world's vertical, against the fit's own orientation at each instant; tilt:
    rad after it about the travel's left axis, turned likewise (forwards positive). slack: rad, of
    the whole turn by which it may miss.
    """

    name: str
    bone: str
    when: When
    turn: float = 0.0
    tilt: float = 0.0
    slack: float = 0.0


class ConeShape(Enum):
    """Shape of a friction cone: second-order or linearised."""

    EXACT = "exact"
    PYRAMID = "pyramid"  # four planes inside the cone


@dataclass(frozen=True)
class ForceRequest:
    """Contact-force request: friction coefficient, peak and tracking weight, in `when`.

    friction: coefficient, for the whole of every contact that `when` meets; None leaves it as it
    is. peak: body weights, of the sum of all forces of the contacts named.
    match: how strongly all forces are kept like the fit's, times the usual cost weight.
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
    """Carried mass, rigidly joined to a bone as a small solid: kg, or a share of the body's mass.

    offset: (3,) m from the bone's head in the bone's axes; None is the bone's tail.
    """

    name: str
    bone: str
    mass: float | None = None
    share: float | None = None
    offset: Vector | None = None


@dataclass(frozen=True)
class LimbChange:
    """Scale factors on the length and the mass of bones; thickness stays."""

    name: str
    bones: tuple[str, ...]
    length: float = 1.0
    mass: float = 1.0


@dataclass(frozen=True)
class BodyChange:
    """Differences of body and gravity from the recording's.

    mass: total, kg, before what is carried; None keeps it. gravity: m/s².
    """

    mass: float | None = None
    gravity: float = STANDARD_GRAVITY
    added: tuple[AddedMass, ...] = ()
    limbs: tuple[LimbChange, ...] = ()


@dataclass(frozen=True)
class PhaseTiming:
    """Retiming of a phase: duration times `factor`, or `seconds` instead."""

    name: str
    phase: str
    factor: float | None = None
    seconds: float | None = None


@dataclass(frozen=True)
class Hold:
    """Held frame: `frame` is repeated for `seconds`, a phase called `name` (thesis 6.2).

    ends: the recording after it is left out, so that the motion ends with it.
    """

    name: str
    frame: float
    seconds: float
    ends: bool = False


@dataclass(frozen=True)
class Clear:
    """Clearance over an object of the scene: bones (empty is all) that are over it stay `by` m
    above it."""

    name: str
    thing: str
    by: float = 0.0
    bones: tuple[str, ...] = ()


class Through(Enum):
    """What the solid shapes of some bones may go through."""

    NOTHING = "nothing"
    EACH_OTHER = "each other"
    ALL = "all"  # limbs, floor and scene alike


@dataclass(frozen=True)
class Shape:
    """What the solid shapes and the joints of some bones are: hair, cloth, what a hand holds.

    thickness: scale factor on the shapes' thickness. human: whether the joints keep to human
    ranges, where others do.
    """

    name: str
    bones: tuple[str, ...]
    thickness: float = 1.0
    through: Through = Through.NOTHING
    human: bool = True


@dataclass(frozen=True)
class Requests:
    """All requests beside pins, in the order written."""

    points: tuple[PointRequest, ...] = ()
    lifts: tuple[Lift, ...] = ()
    angles: tuple[AngleLimit, ...] = ()
    cones: tuple[ConeLimit, ...] = ()
    twists: tuple[TwistLimit, ...] = ()
    torques: tuple[TorqueLimit, ...] = ()
    poses: tuple[PoseRequest, ...] = ()
    orientations: tuple[OrientationRequest, ...] = ()
    forces: tuple[ForceRequest, ...] = ()
    clears: tuple[Clear, ...] = ()
    shapes: tuple[Shape, ...] = ()
    body: BodyChange = field(default_factory=BodyChange)
    timings: tuple[PhaseTiming, ...] = ()
    holds: tuple[Hold, ...] = ()
    solution: SolverOptions = field(default_factory=SolverOptions)

    @property
    def names(self) -> tuple[str, ...]:
        """The artist's names of all requests."""
        kinds = (self.points, self.lifts, self.angles, self.cones, self.twists, self.torques)
        more = (self.poses, self.orientations, self.forces, self.body.added, self.body.limbs)
        every = (*kinds, *more, self.clears, self.shapes, self.timings, self.holds)
        return tuple(request.name for kind in every for request in kind)

    @property
    def preferred(self) -> tuple[PoseRequest, ...]:
        """Poses with a weight: cost terms instead of constraints."""
        return tuple(pose for pose in self.poses if pose.weight is not None)
