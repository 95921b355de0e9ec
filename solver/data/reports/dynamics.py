"""Records of the report on residuals, forces and torques."""

from dataclasses import dataclass, field

from .omission import OMIT_NONE


@dataclass(frozen=True)
class PhaseResidual:
    """Dynamics residual over all phases of one kind."""

    force_rms_bw: float
    force_max_bw: float
    moment_rms_bw_m: float
    moment_max_bw_m: float


@dataclass(frozen=True)
class DenseResiduals:
    """Dynamics residuals between the nodes; None for a kind of phase that does not occur."""

    rate_hz: float
    ground: PhaseResidual | None = field(default=None, metadata=OMIT_NONE)
    flight: PhaseResidual | None = field(default=None, metadata=OMIT_NONE)


@dataclass(frozen=True)
class ForcePeak:
    """Peak contact force of one stance, and the friction that its forces need."""

    phase: str
    peak_bw: float
    frame: float
    friction_coefficient_needed: float


@dataclass(frozen=True)
class ForcesReport:
    """Contact forces. recorded_peak_bw: the largest that the recording's fit has."""

    peaks: tuple[ForcePeak, ...]
    recorded_peak_bw: float
    smallest_vertical_force_bw: float


@dataclass(frozen=True)
class TorquePeak:
    """Largest torque component at the joint of one bone to its parent."""

    bone: str
    peak_nm: float


@dataclass(frozen=True)
class TorquesReport:
    """Peak joint torques, and the size and rms error of the splines that approximate them."""

    peaks_nm: tuple[TorquePeak, ...]
    spline_unknowns: int
    spline_error_rms_nm: float


@dataclass(frozen=True)
class TorqueUse:
    """Torques at the joint angles that a torque limit names: the muscles', and passive tissue's."""

    name: str
    muscles_peak_nm: float
    muscles_rms_nm: float
    passive_peak_nm: float
