"""What was measured of one case."""

from dataclasses import dataclass

from ..checks.joint_ranges import JointExcess
from ..checks.penetrations import Penetration
from .cases import Source


@dataclass(frozen=True)
class Physics:
    """What nothing explains by MuJoCo, rms: force in body weights, moment in body weights x m."""

    flight_force: float
    flight_moment: float
    ground_force: float
    ground_moment: float


@dataclass(frozen=True)
class CaseResult:
    """One case, solved with floor and limbs solid. failed: why there is none, else empty.

    penetrations: the deepest of each keeper. joint: beyond what the recording does and a person
    can. seconds: with floor and limbs solid.
    free_seconds: without, in the same process by turns.
    """

    name: str
    source: Source
    failed: str = ""
    solved: bool = False
    penetrations: tuple[Penetration, ...] = ()
    joint: JointExcess | None = None
    physics: Physics | None = None
    seconds: float = 0.0
    free_seconds: float = 0.0

    @property
    def ratio(self) -> float | None:
        """Time with solids over that without; None where there is none."""
        return self.seconds / self.free_seconds if self.free_seconds > 0.0 else None
