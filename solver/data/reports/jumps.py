"""Records of the report on flights and durations."""

from dataclasses import dataclass


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
class LiftedFlight:
    """A flight that is longer for what was lifted off the floor, by these requests' names: how long
    it is, and would be with these contacts."""

    lifts: tuple[str, ...]
    first_frame: float
    last_frame: float
    with_contacts_s: float
    without_s: float


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
