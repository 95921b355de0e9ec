"""Which solution is sought, and with which of its options (thesis 3.2, 4.3, 4.4, 5)."""

from dataclasses import dataclass
from enum import Enum

MIN_SPAN = 0.015  # s between knots; shorter ones say nothing more and fill all memory


class Dynamics(Enum):
    """Dynamics formulation: whose equations of motion are in the problem (thesis 3.2).

    AUTOMATIC: the root's, and those of the joints whose torques are limited or weighed.
    """

    AUTOMATIC = "automatic"
    REDUCED = "reduced"
    STANDARD = "standard"


class Method(Enum):
    """Solution method by its unknowns: implicit or explicit (thesis 4.3, 4.4)."""

    IMPLICIT = "implicit"  # (q, lambda)
    IMPLICIT_TORQUES = "implicit with torques"  # (q, tau, lambda)
    EXPLICIT = "explicit"


class ObjectiveKind(Enum):
    """Objective terms of the explicit solution (thesis 4.3)."""

    TORQUE_SMOOTHNESS = "torque smoothness"
    POWER = "power"
    TORQUE_OUTPUT = "torque output"
    MASS_DISPLACEMENT = "mass displacement"
    ANGLE_DISPLACEMENT = "angle displacement"
    ANGLE_SMOOTHNESS = "angle smoothness"
    TOTAL_CHANGE = "total change"
    CLOSENESS = "closeness"


class ReductionKind(Enum):
    """Model-reduction method for the joints other than the root's (thesis 5)."""

    PCA = "pca"
    VARIMAX = "varimax"
    QUARTIMAX = "quartimax"
    OBLIQUE = "oblique"
    ICA = "ica"
    MIRROR_LEGS = "mirror legs"
    MATRIX = "matrix"


@dataclass(frozen=True)
class Reduction:
    """Model reduction (thesis 5). dimensions: None chooses by `explained`, the share of variance.

    matrix: for MATRIX, one row per combined coordinate: {bone: (weights of its angles)}.
    """

    kind: ReductionKind
    dimensions: int | None = None
    explained: float = 0.999
    matrix: tuple[tuple[tuple[str, tuple[float, ...]], ...], ...] = ()


class HumanRanges(Enum):
    """Whether joints keep to human ranges, or to the recording's where those are wider.

    SOFT: as far as what is asked for lets them. HARD: what does not let them cannot be met.
    """

    OFF = "off"
    SOFT = "soft"
    HARD = "hard"

    def __bool__(self) -> bool:
        """Whether they do at all."""
        return self is not HumanRanges.OFF


class ShapeSource(Enum):
    """What the body's solid shapes are made from.

    MESH: from the skinned mesh, of bodies that have one; the others from their bones.
    """

    MESH = "mesh"
    BONES = "bones"


@dataclass(frozen=True)
class SolverOptions:
    """Solver options. objectives: (kind, weight) of the explicit solution, weights as shares.

    longest_span: s, between knots; torque_span: s, between knots of the torques' own splines;
    None chooses them automatically. keep_times: phases last as long as recorded where no
    PhaseTiming says otherwise; else those that a moved landing or take-off adjoins take the time
    that goes with it. solid: floor and limbs keep out of each other, as far as they do in the
    recording. shapes: what the body's shapes are made from. human: whether joints keep to human
    ranges; wider: rad, by which both ends of each of these are.
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
    keep_times: bool = False
    solid: bool = True
    shapes: ShapeSource = ShapeSource.MESH
    human: HumanRanges = HumanRanges.SOFT
    wider: float = 0.0
