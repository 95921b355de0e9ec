"""The report on an adaptation as records, and as JSON (report.json): data alone, without CasADi.

Fields are named as report.json's keys, units at their ends; bw is the body's weight. Frames are the
scene's. results/report.py measures them.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import Enum
from typing import Any

from ..row_kinds import RowKind, Violation
from ..solver_options import ReductionKind
from ..status import Durations, Status
from .certificate import CertificateLine
from .constraints import (
    AcceptedReport,
    CarriedFlightReport,
    ConstraintReport,
    ContactReport,
    FitNeeds,
    LetGoReport,
    MovingGroundReport,
    PinReport,
    UnseenSupportReport,
)
from .dynamics import DenseResiduals, ForcesReport, TorquesReport, TorqueUse
from .joints import FastJoint, JointChange, RecordedRange
from .jumps import JumpReport, LiftedFlight, PhaseReport, TimeMap
from .keys import BlendReport, BodyMiss, KeysReport, MissedContact
from .loop import LoopReport
from .omission import OMIT_NONE
from .recording import FigureSummary, RecordingSummary

Json = dict[str, Any]


@dataclass(frozen=True)
class SolveReport:
    """One run of the optimiser."""

    name: str
    status: Status
    iterations: int
    violation_over_tolerance: float


@dataclass(frozen=True)
class ReductionReport:
    """The reduced figure (thesis 5), with the spectrum that its size is chosen by."""

    kind: ReductionKind
    degrees_of_freedom: int
    eigenvalues_rad2: tuple[float, ...]
    explained_share: tuple[float, ...]


FAR_JOINT = 15.0  # cm, of one joint off the recording in one frame; good fits have 4 to 12
FAR_TURNED = 45.0  # degrees, likewise; good fits have 15 to 43


@dataclass(frozen=True)
class FitQuality:
    """Distance of the fit from the recording, at the recording's frames.

    pelvis_apex_difference_cm: of the flight where it is most; None where the clip holds none from
    take-off to landing, whose apex may be beyond its ends. worst_frame: the one whose joint centres
    are furthest off, worst_frame_rms_cm of rms. worst_joint: the body whose joint is furthest off
    in any frame, "" where it is not told. most_turned: the body that is turned away furthest;
    turned_limb: likewise of all but toes, whose turns are hardly seen.
    """

    joint_centres_rms_cm: float
    pelvis_apex_difference_cm: float | None
    worst_frame_rms_cm: float
    worst_frame: float
    worst_joint: str = ""
    worst_joint_cm: float = 0.0
    worst_joint_frame: float = 0.0
    most_turned: str = ""
    most_turned_deg: float = 0.0
    most_turned_frame: float = 0.0
    turned_limb: str = ""
    turned_limb_deg: float = 0.0
    turned_limb_frame: float = 0.0

    @property
    def is_turned(self) -> bool:
        """Whether a limb points elsewhere."""
        return self.turned_limb_deg > FAR_TURNED

    @property
    def is_far_somewhere(self) -> bool:
        """Whether a joint, or a limb, is where the recording has none."""
        return self.worst_joint_cm > FAR_JOINT or self.is_turned


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
    changed most. stages: None where nobody timed them. keys: None where none were left out.
    unseen_support: where something unseen carries the body. carried_flights: the flights among
    it. let_go: contacts that the fit found
    no way to hold. accepted_contacts: those that it holds near enough to their places.
    missed_contacts: those that the written keys do not show where they were solved to be.
    missed_bodies: bones that the written keys of controls leave elsewhere than solved.
    blends: how the take goes over into the adapted frames and out of them, where it does.
    slide_on_way_back_m: by how much standing feet slide as the take goes back to where it was.
    lifted_flights: where nothing touches for longer as contacts were lifted. fast_joint: one that
    goes faster than a person's, or would.
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
    keys: KeysReport | None = field(default=None, metadata=OMIT_NONE)
    fast_joint: FastJoint | None = field(default=None, metadata=OMIT_NONE)
    loop: LoopReport | None = field(default=None, metadata=OMIT_NONE)
    unseen_support: tuple[UnseenSupportReport, ...] = ()
    let_go: tuple[LetGoReport, ...] = ()
    accepted_contacts: tuple[AcceptedReport, ...] = ()
    carried_flights: tuple[CarriedFlightReport, ...] = ()
    missed_contacts: tuple[MissedContact, ...] = ()
    missed_bodies: tuple[BodyMiss, ...] = ()
    blends: tuple[BlendReport, ...] = ()
    slide_on_way_back_m: float = 0.0
    lifted_flights: tuple[LiftedFlight, ...] = ()

    @property
    def needs(self) -> FitNeeds:
        """What the motion needs beside what the recording shows."""
        return FitNeeds(
            self.unseen_support, self.let_go, self.accepted_contacts, self.carried_flights
        )

    @property
    def given_up(self) -> tuple[ConstraintReport, ...]:
        """What the motion could not be guarded from: solids in each other, joints beyond ranges."""
        return tuple(c for c in self.conditions if c.kind.guards and not c.met)

    @property
    def fit_failed(self) -> bool:
        """Whether the recording itself was not to be held, before anything was asked of it."""
        last = self.solves[-1].name if self.solves else ""
        return self.status is not Status.SOLVED and last == "fit"

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
        case Violation(name, kind, amount, frame):
            return {
                "name": name,
                "violation": amount,
                "unit": kind.reported_unit,
                "frame": frame,
            }
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
