"""The report on an adaptation as records, and as JSON (report.json): data alone, without CasADi.

Fields are named as report.json's keys, units at their ends; bw is the body's weight. Frames are the
scene's. results/report.py measures them.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum
from typing import Any

from .problem import MassTable
from .reports.joints import JointChange, RecordedRange
from .requests import ReductionKind, Vector
from .row_kinds import RowKind, Violation
from .status import Durations, Status

Json = dict[str, Any]
OMIT_NONE = {"omit none": True}  # of a field whose key report.json lacks where there is no value


@dataclass(frozen=True)
class Origin:
    """Source file of a recording and how it was read; None where nothing had to be settled.

    unit_m: m per unit of length in the file. up: its axis that points up.
    """

    clip: str
    unit_m: float | None = None
    unit_guessed: bool = False
    up: str | None = None
    up_guessed: bool = False


@dataclass(frozen=True)
class RecordingSummary:
    """The recording's source, frames and duration."""

    clip: str
    action: str
    first_frame: float
    last_frame: float
    seconds: float
    frames_per_second: float
    unit_m: float | None
    unit_guessed: bool
    up_axis: str | None
    up_axis_guessed: bool


@dataclass(frozen=True)
class FigureSummary:
    """The adapted figure, with what it carries."""

    mass_kg: float
    mass_table: MassTable
    height_m: float
    gravity_m_s2: float
    bodies: int
    degrees_of_freedom: int
    floor_m: float


@dataclass(frozen=True)
class PinReport:
    """A pin as it was asked for; its offset in the axes that it was given in."""

    name: str
    phase: str
    points: tuple[str, ...]
    offset_world_m: Vector | None = field(metadata=OMIT_NONE)
    offset_forward_left_up_m: Vector | None = field(metadata=OMIT_NONE)
    place_m: Vector | None
    turn_deg: float


@dataclass(frozen=True)
class SolveReport:
    """One run of the optimiser."""

    name: str
    status: Status
    iterations: int
    violation_over_tolerance: float


@dataclass(frozen=True)
class ConstraintReport:
    """Worst violation of one request over its whole time, in its kind's `reported_unit`."""

    name: str
    kind: RowKind
    worst_violation: float
    worst_violation_frame: float
    met: bool


@dataclass(frozen=True)
class ContactReport:
    """One contact: its pin, friction, interval, place and drift.

    friction_cone: the cone's shape in words. worst_violation_mm: while pinned. loaded_slide_mm,
    loaded_under_mm, loaded_above_mm: worst along, under and above its surface while its force is
    above 5 % of the body's weight, over the whole contact.
    """

    name: str
    pin: str | None
    point: str
    bone: str
    friction_coefficient: float | None
    friction_cone: str
    start_s: float
    end_s: float
    start_frame: float
    end_frame: float
    fitted_place_m: Vector
    place_m: Vector
    worst_violation_mm: float
    worst_violation_frame: float
    loaded_slide_mm: float
    loaded_under_mm: float
    loaded_above_mm: float


@dataclass(frozen=True)
class MovingGroundReport:
    """A stance that rides on an object that moves, or that a take-off from one carries on.

    object, pin: what it stands on, and by which pin; None for one that is carried on. moved_m:
    world, its contacts' centre at its first instant, by the ground's motion alone.
    ground_speed_m_s: where it stands, at its start and end. kept_speed_share: of the ground's
    velocity at the take-off, what the centre of mass has on top of the fit's; None without one.
    """

    phase: str
    object: str | None
    pin: str | None
    moved_m: Vector
    ground_speed_m_s: tuple[float, float]
    kept_speed_share: float | None


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
    """Contact forces."""

    peaks: tuple[ForcePeak, ...]
    smallest_vertical_force_bw: float


@dataclass(frozen=True)
class ReductionReport:
    """The reduced figure (thesis 5), with the spectrum that its size is chosen by."""

    kind: ReductionKind
    degrees_of_freedom: int
    eigenvalues_rad2: tuple[float, ...]
    explained_share: tuple[float, ...]


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


@dataclass(frozen=True)
class FitQuality:
    """Distance of the fit from the recording, at the recording's frames.

    worst_frame: the one whose joint centres are furthest off, worst_frame_rms_cm of rms.
    """

    joint_centres_rms_cm: float
    pelvis_apex_difference_cm: float
    worst_frame_rms_cm: float
    worst_frame: float


class CertificateItem(Enum):
    """What a line of the certificate is about."""

    RESIDUAL_FORCE_RMS_SHARE = "residual force, rms, of peak force"
    RESIDUAL_FORCE_PEAK_SHARE = "residual force, peak, of peak force"
    RESIDUAL_MOMENT_RMS_SHARE = "residual moment, rms, of peak force x height"
    RESIDUAL_MOMENT_PEAK_SHARE = "residual moment, peak, of peak force x height"
    RESIDUAL_FORCE_RMS = "residual force, rms"
    RESIDUAL_FORCE_PEAK = "residual force, peak"
    RESIDUAL_MOMENT_RMS = "residual moment, rms"
    RESIDUAL_MOMENT_PEAK = "residual moment, peak"
    FRICTION = "friction coefficient used"
    PEAK_FORCE = "peak force"
    LOADING_RATE = "loading rate"
    HIP_TORQUE = "peak hip torque"
    KNEE_TORQUE = "peak knee torque"
    ANKLE_TORQUE = "peak ankle torque"
    SLIDE = "loaded point slides"
    UNDER = "loaded point under its surface"
    ABOVE = "loaded point above its surface"
    FIT_RMS = "fit from the recording, rms"
    FIT_WORST_FRAME = "fit from the recording, worst frame"


@dataclass(frozen=True)
class CertificateLine:
    """One figure of the certificate. where: a contact or a side. frame: None for a mean.

    holds: whether the value is at most the limit.
    """

    item: CertificateItem
    value: float
    unit: str
    limit: float
    holds: bool
    frame: float | None
    where: str


@dataclass(frozen=True)
class RecordedOverlap:
    """How deep the recording (its fit) has two solids in each other, and when; it may stay so."""

    name: str
    deepest_mm: float
    frame: float


@dataclass(frozen=True)
class MotionChange:
    """Distance of the adapted motion from the fit, at corresponding instants."""

    joint_centres_rms_cm: float
    joint_angles_rms_deg: float


@dataclass(frozen=True)
class DragSummary:
    """Change of the motion that follows a drag, against the fit.

    moved_cm: of the contact that is furthest from where it was recorded; deeper_cm, higher_cm: of
    the pelvis at its lowest and highest; peak_bw: the largest contact force.
    """

    moved_cm: float
    deeper_cm: float
    higher_cm: float
    peak_bw: float


@dataclass(frozen=True)
class RecordedFlight:
    """Of the recording itself: the pelvis's height above the floor."""

    apex_pelvis_height_m: float


@dataclass(frozen=True)
class FlightSummary:
    """The pelvis's heights above the floor before and in a flight, and the flight's length.

    crouch_pelvis_height_m: None where no stance precedes.
    """

    crouch_pelvis_height_m: float | None
    apex_pelvis_height_m: float
    flight_length_m: float


@dataclass(frozen=True)
class JumpReport:
    """One flight in the recording, the fit and the adapted motion."""

    flight: str
    take_off_s: float
    landing_s: float
    take_off_frame: float
    landing_frame: float
    recorded: RecordedFlight
    fit: FlightSummary
    adapted: FlightSummary
    crouch_deeper_cm: float | None
    apex_higher_cm: float


@dataclass(frozen=True)
class PhaseReport:
    """How long a phase of the recording took, and takes now."""

    phase: str
    recorded_s: float
    adapted_s: float


@dataclass(frozen=True)
class TimeMap:
    """Corners of the piecewise linear map of the recording's frames to the adapted motion's."""

    recorded_frame: tuple[float, ...]
    adapted_frame: tuple[float, ...]


@dataclass(frozen=True)
class StageReport:
    """Time that a stage of the pipeline took; iterations: of the optimiser, where it ran."""

    name: str
    seconds: float
    iterations: int | None = field(default=None, metadata=OMIT_NONE)


@dataclass(frozen=True)
class Report:
    """Everything about an adaptation.

    certificate: what a laboratory asks of a motion, line by line, with its limits.
    equations: every constraint, worst first. rows: constraint rows. torques: None where the problem
    does not involve them. recorded_overlaps: deepest first; none where nothing is solid.
    recorded_ranges: worst first; none where the figure is no human. joint_changes: the joints that
    changed most. stages: None where nobody timed them.
    """

    status: Status
    certificate: tuple[CertificateLine, ...]
    recording: RecordingSummary
    figure: FigureSummary
    pins: tuple[PinReport, ...]
    solves: tuple[SolveReport, ...]
    unknowns: int
    rows: int
    equations: tuple[Violation, ...]
    conditions: tuple[ConstraintReport, ...]
    contacts: tuple[ContactReport, ...]
    moving_ground: tuple[MovingGroundReport, ...]
    between_nodes: DenseResiduals
    forces: ForcesReport
    objective_end_over_start: float | None
    reduction: ReductionReport | None
    torques: TorquesReport | None
    torque_limits: tuple[TorqueUse, ...]
    fit_to_recording: FitQuality
    recorded_overlaps: tuple[RecordedOverlap, ...]
    recorded_ranges: tuple[RecordedRange, ...]
    change: MotionChange
    joint_changes: tuple[JointChange, ...]
    jumps: tuple[JumpReport, ...]
    durations: Durations
    phases: tuple[PhaseReport, ...]
    times: TimeMap
    stages: tuple[StageReport, ...] | None = field(default=None, metadata=OMIT_NONE)

    @property
    def given_up(self) -> tuple[ConstraintReport, ...]:
        """What the motion could not be guarded from: solids in each other, joints beyond ranges."""
        return tuple(c for c in self.conditions if c.kind.guards and not c.met)

    @property
    def overlaps(self) -> tuple[ConstraintReport, ...]:
        """The solids that could not be kept out of each other."""
        return tuple(c for c in self.given_up if c.kind is RowKind.SOLID)

    @property
    def failed(self) -> tuple[CertificateLine, ...]:
        """The certificate's lines that do not hold."""
        return tuple(line for line in self.certificate if not line.holds)


def as_json(report: Report) -> Json:
    """A report as report.json holds it; what is not finite is None."""
    return {key: _plain(value) for key, value in _items(report).items()}


def _items(record: object) -> Mapping[str, object]:
    """Keys and values of a record."""
    match record:
        case Violation(name, kind, amount):
            return {"name": name, "violation": amount, "unit": kind.reported_unit}
        case ConstraintReport():
            return {
                "name": record.name,
                "kind": record.kind.label,
                "worst_violation": record.worst_violation,
                "unit": record.kind.reported_unit,
                "worst_violation_frame": record.worst_violation_frame,
                "met": record.met,
            }
    assert is_dataclass(record)
    values = ((each, getattr(record, each.name)) for each in fields(record))
    return {f.name: v for f, v in values if v is not None or f.metadata != OMIT_NONE}


def _plain(value: object) -> object:
    match value:
        case Enum():
            return value.value
        case tuple():
            return [_plain(each) for each in value]
        case float():
            return float(value) if math.isfinite(value) else None
        case None | bool() | int() | str():
            return value
    return {key: _plain(each) for key, each in _items(value).items()}
