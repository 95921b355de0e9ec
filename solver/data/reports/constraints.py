"""Records of the report on what was asked for: pins, contacts, requests."""

from dataclasses import dataclass, field

from ..requests import Vector
from ..row_kinds import RowKind
from .omission import OMIT_NONE

CARRIES = 0.05  # body weights; less is within the error of forces that are told from recordings


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
    step: str | None = field(default=None, metadata=OMIT_NONE)


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
class UnseenSupportReport:
    """Something that the recording does not show carries the body. At its largest: force_bw, body
    weights, at peak_frame; moment_bw_m about the pelvis, body weights x m. mean_bw: of the force.
    beside_hands_m: how far the weight is beside what touches, in the mean over when hands do, where
    that is most of it; else 0.
    """

    first_frame: float
    last_frame: float
    force_bw: float
    peak_frame: float
    moment_bw_m: float
    mean_bw: float
    beside_hands_m: float = 0.0


@dataclass(frozen=True)
class CarriedFlightReport:
    """A flight that was found, in which the fit has something unseen carry the body. acceleration:
    m/s², downwards, as recorded; off_mm: by how much the centre of mass leaves any free fall."""

    phase: str
    first_frame: float
    last_frame: float
    acceleration: float
    off_mm: float


@dataclass(frozen=True)
class LetGoReport:
    """A contact that was found, but that no valid motion near the recording holds beside others.

    off_mm: by how much its point missed its place.
    """

    name: str
    start_frame: float
    end_frame: float
    off_mm: float


@dataclass(frozen=True)
class AcceptedReport:
    """A contact that no motion holds exactly, but near enough. off_mm: at its worst. limit_mm: what
    counts as good enough."""

    name: str
    off_mm: float
    limit_mm: float


@dataclass(frozen=True)
class FitNeeds:
    """What a valid motion needs beside what the recording shows; see `Report`."""

    unseen_support: tuple[UnseenSupportReport, ...] = ()
    let_go: tuple[LetGoReport, ...] = ()
    accepted: tuple[AcceptedReport, ...] = ()
    carried_flights: tuple[CarriedFlightReport, ...] = ()
