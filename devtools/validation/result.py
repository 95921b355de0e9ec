"""Everything that is measured of one trial, as records."""

from dataclasses import dataclass

from ...solver.data.requests import Vector
from .contacts import Event, EventKind, Friction, Pressure
from .forces import RmsError, Stance, Step
from .motions import MotionMeasures


@dataclass(frozen=True)
class SmoothedError:
    """Rms error at 15 Hz of the load that the recording tells, smoothed over `width` s: BW."""

    width: float
    error: Vector


@dataclass(frozen=True)
class Measured:
    """What was measured of a trial's forces. Pairs are ours, then the plates'.

    seconds: the fit's. compared: s, in which the forces are. foot_errors: at 15 Hz, of the left
    and the right foot. smoothed: of what the recording alone tells.
    """

    seconds: float
    compared: tuple[float, float]
    errors: tuple[RmsError, ...]
    foot_errors: tuple[Vector, ...]
    total_variation: tuple[float, float]
    steps: tuple[Step, Step]
    stances: tuple[Stance, ...]
    events: tuple[Event, ...]
    pressure: Pressure | None
    friction: tuple[Friction, Friction]
    smoothed: tuple[SmoothedError, ...]

    def error(self, cut_off: float = 15.0) -> RmsError:
        """The rms error at a cut-off, Hz."""
        return next(error for error in self.errors if error.cut_off == cut_off)

    def late(self, kind: EventKind, *, by_force: bool = False) -> list[float]:
        """How late those events are that ours has, ms."""
        mine = [e for e in self.events if e.kind is kind]
        late = [e.force_late_ms if by_force else e.late_ms for e in mine]
        return [each for each in late if each is not None]

    def mean_late(self, kind: EventKind) -> float | None:
        """None where ours has no such event."""
        late = self.late(kind)
        return sum(late) / len(late) if late else None

    @property
    def not_found(self) -> int:
        """Number of the plates' events that ours has not."""
        return sum(e.late_ms is None for e in self.events)


@dataclass(frozen=True)
class TrialResult:
    """One trial, or a recording without force plates, of which nothing but the motion is known.

    kind: of a trial, as "walk". refused: the sentence that says why nothing was measured. crashed:
    it is not one of ours, but a crash's or that of the time limit.
    """

    trial: str
    motion: MotionMeasures | None = None
    measured: Measured | None = None
    kind: str = ""
    refused: str | None = None
    crashed: bool = False
